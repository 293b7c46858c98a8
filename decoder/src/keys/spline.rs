//! The solver: the second differences of a spline's keys, in integers.
//!
//! With l and r the frames before and after a key, and s the slopes of the chords there, the second differences w of three keys in a row keep
//! `reach(l) w' + (hold(l) + hold(r)) w + reach(r) w'' = 6 (s_r - s_l)`: [`weights`] says how, in 2^-16. Elimination from the first key to the last
//! leaves two numbers a key that depend on the grid alone, a pivot and a factor. A loop has one equation more: its first key is solved for last, by how
//! the other keys depend on it.

use super::channels::Keys;
use super::grid::Grid;
use super::layout::interpolation;
use super::numbers::{Scale, divide, scaled};
use super::words;
use crate::channel::ChannelState;

/// 1 in factors and dependences: 2^-30.
const ONE: i32 = 1 << 30;

/// Numbers of a grid in words behind the keys: pivots, factors, and how much each key depends on the first.
#[derive(Clone, Copy)]
pub(super) struct Solver {
    pub(super) grid: Grid,
    /// Where the words are, and how many keys they are for.
    pub(super) scratch: [usize; 2],
    pub(super) looped: bool,
}

/// What a sweep solves for.
#[derive(Clone, Copy)]
enum Unknown<'k> {
    /// The dependences on the first key, which is 1.
    Dependence,
    /// A channel's second differences, the first key's being 0.
    Second(&'k Keys, Scale),
}

impl Solver {
    /// Where a key's pivot (0), factor (1) or dependence (2) is.
    fn at(&self, which: usize, key: usize) -> usize {
        let [at, keys] = self.scratch;
        at + which * keys + key
    }

    /// Weights of a neighbour at the other end of a span, and of a key itself, in 2^-16: of the discrete spline they differ by a frame's part.
    #[inline(never)]
    fn weights(&self, length: u32) -> (i32, u32) {
        let part = if self.grid.interpolation() == interpolation::DISCRETE { divide(1 << 16, length) as u32 } else { 0 };
        (((length << 16) - part) as i32, (length << 17) + part)
    }

    /// Works the numbers out.
    #[inline(never)]
    pub(super) fn prepare(&self, states: &mut [ChannelState]) -> Option<()> {
        let last = self.grid.last();
        let mut factor = 0;
        let (mut reach, mut hold) = self.weights(self.grid.length(states, 0));
        let first = hold;
        for key in 1..last {
            let (right, held) = self.weights(self.grid.length(states, key));
            // At most 2^32 less 2^20: two spans have at most as many frames as a loop twice.
            let pivot = (hold + held).wrapping_sub(scaled(reach, factor) as u32);
            factor = divide(i64::from(right) << 30, pivot) as i32;
            words::set(states, self.at(0, key), pivot as i32);
            words::set(states, self.at(1, key), factor);
            (reach, hold) = (right, held);
        }
        if self.looped {
            let pulled = self.sweep(states, Unknown::Dependence)?;
            let pivot = (hold + first).wrapping_add(super::numbers::shift_rounded(pulled, 30) as u32);
            words::set(states, self.at(0, 0), pivot as i32);
        }
        Some(())
    }

    /// Eliminates from the first inner key to the last, and substitutes back. Returns what the neighbours of the first key of a loop pull it by, less
    /// its bend.
    #[inline(never)]
    fn sweep(&self, states: &mut [ChannelState], unknown: Unknown<'_>) -> Option<i64> {
        let (at, stride, end) = match unknown {
            Unknown::Dependence => (self.at(2, 0), 1, ONE),
            Unknown::Second(keys, _) => (keys.at + 1, 2, 0),
        };
        let last = self.grid.last();
        let raw = |states: &[ChannelState], key| match unknown {
            Unknown::Dependence => 0,
            Unknown::Second(keys, scale) => scale.raw(keys.value(states, key)),
        };
        // Where the last chord ended, and the last span's length and reach: grids of equal spans need one division for it.
        let (mut ended, mut span) = (raw(states, 0), (0, 0));
        let mut chord = |states: &[ChannelState], key| {
            let length = self.grid.length(states, key);
            if length != span.0 {
                span = (length, self.weights(length).0);
            }
            let from = core::mem::replace(&mut ended, raw(states, key + 1));
            (divide((ended - from) << 8, length), span.1)
        };
        words::set(states, at, end);
        words::set(states, at + last * stride, end);
        let mut value = end;
        let (first, first_reach) = chord(states, 0);
        let (mut before, mut reach) = (first, first_reach);
        for key in 1..last {
            let (after, next_reach) = chord(states, key);
            let pull = i64::from(reach) * i64::from(value);
            value = i32::try_from(divide(bend(before, after) - pull, words::get(states, self.at(0, key)) as u32)).ok()?;
            words::set(states, at + key * stride, value);
            (before, reach) = (after, next_reach);
        }
        let last_value = last - 1;
        value = end;
        for key in (1..last).rev() {
            let own = words::get(states, at + key * stride);
            let next = i64::from(own) - scaled(words::get(states, self.at(1, key)), value);
            value = i32::try_from(next).ok()?;
            words::set(states, at + key * stride, value);
        }
        // One key after the first, and one before the last: the end itself where there is no other.
        let of_last = i64::from(reach) * i64::from(words::get(states, at + last_value * stride));
        Some(i64::from(first_reach) * i64::from(value) + of_last - bend(before, first))
    }

    /// Solves for a channel's second differences; `None` if one does not fit 32 bits.
    #[inline(never)]
    pub(super) fn solve(&self, states: &mut [ChannelState], keys: &Keys, scale: Scale) -> Option<()> {
        let pulled = self.sweep(states, Unknown::Second(keys, scale))?;
        if self.looped {
            let first = i32::try_from(divide(-pulled, words::get(states, self.at(0, 0)) as u32)).ok()?;
            for key in 0..=self.grid.last() {
                let at = keys.at + 1 + 2 * key;
                let value = i64::from(words::get(states, at)) + scaled(words::get(states, self.at(2, key)), first);
                words::set(states, at, i32::try_from(value).ok()?);
            }
        }
        Some(())
    }
}

/// Six times the change of a slope, in 2^-16: below 2^61.
fn bend(before: i64, after: i64) -> i64 {
    (6 * (after - before)) << 8
}

/// The slope of a chord in raw units a frame, in 2^-8: below 2^49.
#[inline(never)]
pub(super) fn slope(states: &[ChannelState], keys: &Keys, scale: Scale, key: usize) -> i64 {
    divide(rise(states, keys, scale, key) << 8, keys.grid.length(states, key))
}

/// How far a chord rises, in raw units.
#[inline(never)]
pub(super) fn rise(states: &[ChannelState], keys: &Keys, scale: Scale, key: usize) -> i64 {
    scale.raw(keys.value(states, key + 1)) - scale.raw(keys.value(states, key))
}
