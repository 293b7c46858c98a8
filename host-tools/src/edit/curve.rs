//! A channel's known curve as cubics in time, the form in which curves are cut and resampled.

use crate::keys::sample_pieces;
use crate::motion::{Keys, Piece};

/// Sampled cubics agree with the motion's own values within this part of the greatest value.
const SAME: f64 = 1e-9;

/// The cubics that `keys` stand for, if they give the channel's `values` at every frame.
///
/// Between two keys on frames, four frames determine the cubic. Where fewer lie there, what passes between the frames is not known:
/// such a channel has no cubics, and is sampled.
pub fn pieces(keys: &Keys, values: &[f64]) -> Option<Vec<Piece>> {
    let pieces: Vec<Piece> = match keys {
        Keys::Pieces(pieces) => pieces.clone(),
        Keys::OnFrames { keys, .. } if keys.len() < 2 => vec![Piece { p: values[0], ..Piece::default() }],
        Keys::OnFrames { keys, interpolation } => {
            let linear = *interpolation == crate::motion::Interpolation::Linear;
            keys.windows(2).map(|pair| between(pair[0].0, pair[1].0, values, linear)).collect::<Option<_>>()?
        }
    };
    let greatest = values.iter().fold(1e-300, |greatest: f64, value| greatest.max(value.abs()));
    let same = |(a, b): (&f64, f64)| (a - b).abs() <= SAME * greatest;
    values.iter().zip(sample_pieces(&pieces, values.len())).all(same).then_some(pieces)
}

/// The cubic through the frames `from..=to` by its differences.
fn between(from: usize, to: usize, values: &[f64], linear: bool) -> Option<Piece> {
    let start = from as f64;
    if linear {
        let c = (values[to] - values[from]) / (to - from) as f64;
        return Some(Piece { start, p: values[from], c, ..Piece::default() });
    }
    let &[a, b, c, d] = values.get(from..=(from + 3).min(to))? else { return None };
    let (first, second, third) = (b - a, c - 2.0 * b + a, d - 3.0 * c + 3.0 * b - a);
    // Newton's form of the cubic, as a polynomial in s.
    Some(Piece { start, p: a, c: first - second / 2.0 + third / 3.0, w: second - third, k: third })
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
    use crate::keys::sample;
    use crate::motion::Interpolation::{self, *};

    fn known(interpolation: Interpolation, cycle: bool) -> Option<Vec<Piece>> {
        let keys = vec![(0, 1.0), (5, 9.0), (9, -3.0), (20, 1.0)];
        let values = sample(&keys, interpolation, 21, cycle);
        pieces(&Keys::OnFrames { interpolation, keys }, &values)
    }

    #[test]
    fn frames_tell_the_cubics_of_open_and_closed_curves() {
        for interpolation in [Linear, CatmullRom, Natural, Discrete] {
            for cycle in [false, true] {
                assert_eq!(known(interpolation, cycle).unwrap().len(), 3, "{interpolation:?}");
            }
        }
    }

    #[test]
    fn what_frames_do_not_tell_is_not_known() {
        let keys = vec![(0, 1.0), (2, 9.0), (9, -3.0)];
        let values = sample(&keys, Natural, 10, false);
        assert_eq!(pieces(&Keys::OnFrames { interpolation: Natural, keys: keys.clone() }, &values), None);
        assert!(
            pieces(&Keys::OnFrames { interpolation: Linear, keys: keys.clone() }, &sample(&keys, Linear, 10, false)).is_some()
        );
    }

    #[test]
    fn a_finer_grid_passes_through_the_same_values() {
        let coarse = known(CatmullRom, false).unwrap();
        let fine = sample_pieces(&moved(&coarse, 0.0, 4.0), 81);
        let values = sample_pieces(&coarse, 21);
        assert!(values.iter().enumerate().all(|(frame, value)| (fine[4 * frame] - value).abs() < 1e-9));
    }
}
