//! A stretch of frames.

use super::curve;
use crate::error::{Error, Setting, require};
use crate::events;
use crate::motion::{Keys, Motion, Piece};
use anyhow::Result;

/// Frames `from` to `to`, both included; without them from the first and to the last.
///
/// Curves through keys stay curves. A part of a loop is no loop.
pub fn cut(motion: &Motion, from: Option<usize>, to: Option<usize>) -> Result<Motion> {
    let last = motion.frames - 1;
    let (from, to) = (from.unwrap_or(0), to.unwrap_or(last));
    require!(to <= last, Error::value(Setting::To, to, format!("the last frame is {last}")));
    require!(from <= to, Error::value(Setting::From, from, format!("it is after frame {to}, the last one kept")));
    if (from, to) == (0, last) {
        return Ok(motion.clone());
    }
    let values: Vec<Vec<f64>> = motion.values.iter().map(|values| values[from..=to].to_vec()).collect();
    let keys = motion.keys.iter().zip(&motion.values).map(|(keys, values)| {
        let pieces = curve::pieces(keys.as_ref()?, values)?;
        Some(Keys::Pieces(stretch(&pieces, from as f64, to as f64)))
    });
    let events = events::cut(&motion.events, from, to);
    Ok(Motion { rig: motion.rig.clone(), frames: to - from + 1, keys: keys.collect(), values, looped: false, events, ..*motion })
}

/// The pieces of times `from` to `to`, counted from `from`. One that begins before `from` begins there.
fn stretch(pieces: &[Piece], from: f64, to: f64) -> Vec<Piece> {
    let begun = pieces.iter().rposition(|piece| piece.start <= from);
    let first = begun.map(|index| {
        let piece = &pieces[index];
        let s = from - piece.start;
        Piece { start: 0.0, p: piece.at(s), c: piece.c + s * (piece.w + s * piece.k / 2.0), w: piece.w + s * piece.k, k: piece.k }
    });
    let after = &pieces[begun.map_or(0, |index| index + 1)..];
    let rest = after.iter().filter(|piece| piece.start < to).map(|piece| Piece { start: piece.start - from, ..*piece });
    first.into_iter().chain(rest).collect()
}
