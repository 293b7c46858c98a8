//! A channel's known curve as cubics in time, the form in which curves are cut and resampled.

use crate::keys::sample_pieces;
use crate::motion::{Keys, Piece};

/// Sampled cubics agree with the motion's own values within this part of the greatest value.
const SAME: f64 = 1e-9;

/// The cubics that `keys` stand for, if they give the channel's `values` at every frame.
pub fn pieces(keys: &Keys, values: &[f64]) -> Option<Vec<Piece>> {
    let pieces: Vec<Piece> = match keys {
        Keys::OnFrames { pieces, .. } if pieces.is_empty() => vec![Piece { p: values[0], ..Piece::default() }],
        Keys::OnFrames { pieces, .. } | Keys::Pieces(pieces) => pieces.clone(),
    };
    let greatest = values.iter().fold(1e-300, |greatest: f64, value| greatest.max(value.abs()));
    let same = |(a, b): (&f64, f64)| (a - b).abs() <= SAME * greatest;
    values.iter().zip(sample_pieces(&pieces, values.len())).all(same).then_some(pieces)
}

/// The same curve `frames` later (earlier if negative) and on a grid of `factor` times as many frames.
pub fn moved(pieces: &[Piece], frames: f64, factor: f64) -> Vec<Piece> {
    let one = |piece: &Piece| Piece {
        start: (piece.start + frames) * factor,
        p: piece.p,
        c: piece.c / factor,
        w: piece.w / factor.powi(2),
        k: piece.k / factor.powi(3),
    };
    pieces.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::{cubics, sample};
    use crate::motion::Interpolation::{self, *};

    const KEYS: [(usize, f64); 5] = [(0, 1.0), (2, 9.0), (9, -3.0), (10, 4.0), (20, 1.0)];

    fn known(interpolation: Interpolation, cycle: bool) -> Option<Vec<Piece>> {
        let (values, pieces) = (sample(&KEYS, interpolation, 21, cycle), cubics(&KEYS, interpolation, cycle));
        super::pieces(&Keys::OnFrames { interpolation, keys: KEYS.into(), pieces }, &values)
    }

    #[test]
    fn cubics_that_are_not_the_motions_are_not_known() {
        for interpolation in [Linear, CatmullRom, Natural, Discrete] {
            for cycle in [false, true] {
                assert_eq!(known(interpolation, cycle).unwrap().len(), 4, "{interpolation:?}");
            }
        }
        let keys = Keys::OnFrames { interpolation: Linear, keys: KEYS.into(), pieces: cubics(&KEYS, Linear, false) };
        assert_eq!(pieces(&keys, &sample(&KEYS, Natural, 21, false)), None);
    }

    #[test]
    fn a_finer_grid_passes_through_the_same_values() {
        let coarse = known(CatmullRom, false).unwrap();
        let fine = sample_pieces(&moved(&coarse, 0.0, 4.0), 81);
        let values = sample_pieces(&coarse, 21);
        assert!(values.iter().enumerate().all(|(frame, value)| (fine[4 * frame] - value).abs() < 1e-9));
    }
}
