//! Grids: the key times that channels share, with the interpolation between them.
//!
//! A grid is a word of its own, then its times, two to a word. The word holds the last key's index, the interpolation, whether the second half
//! of the times is the first one again, and where the grid before it is.

use super::layout::{MAX_KEY_FRAMES, interpolation};
use super::words;
use crate::channel::ChannelState;

/// A grid in memory: where its word is, and the word.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub(super) at: usize,
    word: u32,
}

/// Where a grid's parts are in its word.
const INTERPOLATION: u32 = 13;
const HALF: u32 = 15;
const BEFORE: u32 = 16;

impl Grid {
    /// The grid whose word is at a place.
    pub(super) fn at(states: &[ChannelState], at: usize) -> Grid {
        Grid { at, word: words::get(states, at) as u32 }
    }

    /// Writes the word of a grid.
    pub(super) fn put(states: &mut [ChannelState], at: usize, last: u32, interpolation: u8, half: bool, before: usize) -> Grid {
        let word = last | u32::from(interpolation) << INTERPOLATION | u32::from(half) << HALF | (before as u32) << BEFORE;
        words::set(states, at, word as i32);
        Grid { at, word }
    }

    /// Index of the last key.
    pub(super) fn last(&self) -> usize {
        (self.word & ((1 << INTERPOLATION) - 1)) as usize
    }

    pub(super) fn interpolation(&self) -> u8 {
        (self.word >> INTERPOLATION & 3) as u8
    }

    /// Whether the times of the second half are those of the first, half the frames later.
    pub(super) fn has_half(&self) -> bool {
        self.word >> HALF & 1 != 0
    }

    /// Where the grid before it is.
    pub(super) fn before(&self) -> usize {
        (self.word >> BEFORE) as usize
    }

    /// Whether its channels have a second difference at each key, for which equations are solved.
    pub(super) fn is_spline(&self) -> bool {
        self.interpolation() >= interpolation::NATURAL
    }

    /// Words of a channel's key.
    pub(super) fn stride(&self) -> usize {
        1 + usize::from(self.is_spline())
    }

    /// Words of a grid with this last key.
    pub(super) fn words(last: u32) -> usize {
        2 + (last / 2) as usize
    }

    /// The frame of a key.
    #[inline(never)]
    pub(super) fn time(&self, states: &[ChannelState], key: usize) -> u32 {
        let word = words::get(states, self.at + 1 + key / 2) as u32;
        if key.is_multiple_of(2) { word & 0xffff } else { word >> 16 }
    }

    #[inline(never)]
    pub(super) fn set_time(&self, states: &mut [ChannelState], key: usize, frame: u32) {
        let at = self.at + 1 + key / 2;
        let word = words::get(states, at) as u32;
        let word = if key.is_multiple_of(2) { word >> 16 << 16 | frame } else { word & 0xffff | frame << 16 };
        words::set(states, at, word as i32);
    }

    /// Frames from a key to the next, at least 1.
    #[inline(never)]
    pub(super) fn length(&self, states: &[ChannelState], key: usize) -> u32 {
        self.time(states, key + 1).saturating_sub(self.time(states, key)).max(1)
    }

    /// The last key of no later frame.
    #[inline(never)]
    pub(super) fn key_at(&self, states: &[ChannelState], frame: u32) -> usize {
        let (mut from, mut to) = (0, self.last() + 1);
        while from + 1 < to {
            let middle = (from + to) / 2;
            *(if self.time(states, middle) <= frame { &mut from } else { &mut to }) = middle;
        }
        from
    }
}

/// What is known of the clip before its channels are read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frames {
    pub(super) looped: bool,
    /// The frame of every grid's last key.
    pub(super) last: u32,
}

impl Frames {
    pub(super) fn new(frames: u32, looped: bool) -> Frames {
        Frames { looped, last: frames - u32::from(!looped) }
    }

    /// Whether there is half a cycle: in a loop with an even number of frames.
    pub(super) fn has_half(&self) -> bool {
        self.looped && self.last.is_multiple_of(2)
    }
}

const _: () = assert!(MAX_KEY_FRAMES < 1 << INTERPOLATION);
