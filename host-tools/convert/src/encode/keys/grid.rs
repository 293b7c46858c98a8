//! Grids: the key times that channels share.

use super::coder::Coder;
use pantin::codec::keys::{context, gap_bits};

/// Key times, and the interpolation between them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    /// One of [`pantin::codec::keys::interpolation`].
    pub interpolation: u8,
    /// Frames of the keys.
    pub times: Vec<u32>,
    /// Whether the second half is the first one, half the frames later.
    pub half: bool,
}

/// Half the frames of a loop, if it has such.
pub fn half_cycle(frames: u32, looped: bool) -> Option<u32> {
    (looped && frames.is_multiple_of(2)).then_some(frames / 2)
}

impl Grid {
    /// Makes the grid of these times. `frames` is the number of frames of the clip.
    pub fn new(interpolation: u8, times: &[u32], frames: u32, looped: bool) -> Grid {
        let inner = times.len() - 1;
        let repeats = |half: u32| {
            inner >= 2
                && inner.is_multiple_of(2)
                && times[..inner / 2].iter().zip(&times[inner / 2..inner]).all(|(a, b)| a + half == *b)
        };
        Grid { interpolation, times: times.to_vec(), half: half_cycle(frames, looped).is_some_and(repeats) }
    }

    /// The last key's index.
    pub fn last(&self) -> usize {
        self.times.len() - 1
    }

    /// Whether it has a second difference at each key.
    pub fn is_spline(&self) -> bool {
        self.interpolation >= pantin::codec::keys::interpolation::NATURAL
    }

    /// The words that it takes in a player's memory.
    pub fn words(&self) -> usize {
        1 + self.times.len().div_ceil(2)
    }

    /// Its bits behind the interpolation.
    pub fn put(&self, coder: &mut Coder, frames: u32, looped: bool) {
        let ends = self.times.len() == 2;
        coder.bit(context::ENDS + usize::from(self.interpolation), ends);
        if ends {
            return;
        }
        let mut end = self.times[self.last()];
        let mut inner = &self.times[1..self.last()];
        if let Some(half) = half_cycle(frames, looped) {
            coder.bit(context::HALF, self.half);
            if self.half {
                (end, inner) = (half, &self.times[1..self.last() / 2]);
            }
        }
        coder.gamma(context::COUNT, inner.len() as u32);
        let mut before = 0;
        for (index, &time) in inner.iter().enumerate() {
            let after = (inner.len() - 1 - index) as u32;
            let left = end - before - after - 1;
            let raw = gap_bits(left, after);
            let gap = time - before - 1;
            coder.unary(context::GAP + if raw == 0 { 0 } else { context::LONG }, gap >> raw, (left - 1) >> raw);
            coder.raw(gap & ((1 << raw) - 1), raw);
            before = time;
        }
    }
}
