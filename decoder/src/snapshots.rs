//! Whole states at evenly spaced frames, in memory that the caller lends.

use crate::channel::ChannelState;
use crate::play_state::{Channels, PlayState};

/// What a snapshot holds beside channels: where it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct SnapshotPos(PlayState);

/// Snapshot i is of frame (i + 1) 2^shift; frame 0 needs none.
#[derive(Debug)]
pub(crate) struct Snapshots<'m> {
    marks: &'m mut [SnapshotPos],
    states: &'m mut [ChannelState],
    values: &'m mut [i32],
    moving: usize,
    shift: u32,
}

impl<'m> Snapshots<'m> {
    /// As many as fit the memory, at the closest spacing that serves all `frames`.
    pub(crate) fn new(
        marks: &'m mut [SnapshotPos],
        states: &'m mut [ChannelState],
        values: &'m mut [i32],
        moving: usize,
        frames: u32,
    ) -> Snapshots<'m> {
        let room = states.len().min(values.len());
        let mut count = 0;
        while count < marks.len() && (count + 1) * moving <= room {
            count += 1;
        }
        let marks = marks.get_mut(..count).unwrap_or(&mut []);
        marks.fill(SnapshotPos::default());
        let mut shift = 0;
        while shift < 31 && (frames >> shift) as usize > count {
            shift += 1;
        }
        Snapshots { marks, states, values, moving, shift }
    }

    /// The next frame after `frame` that a snapshot may be kept of.
    pub(crate) fn next_after(&self, frame: u32) -> u32 {
        if self.marks.is_empty() { u32::MAX } else { ((frame >> self.shift) + 1) << self.shift }
    }

    /// Keeps this frame if it is one of the evenly spaced.
    pub(crate) fn keep(&mut self, position: &PlayState, channels: &Channels<'_>) {
        let frame = position.frame;
        let index = (frame >> self.shift).wrapping_sub(1) as usize;
        if (frame >> self.shift) << self.shift != frame {
            return;
        }
        let Some(mark) = self.marks.get_mut(index).filter(|mark| mark.0.frame != frame) else { return };
        *mark = SnapshotPos(*position);
        let at = index * self.moving;
        let kept = self.states.iter_mut().zip(self.values.iter_mut()).skip(at);
        for (state, (kept, value)) in channels.states.iter().zip(kept) {
            kept.become_as(state);
            *value = channels.pose.get(usize::from(state.slot)).copied().unwrap_or(0);
        }
    }

    /// The last snapshot that is of no later frame than `target`: its index and frame.
    pub(crate) fn nearest(&self, target: u32) -> Option<(usize, u32)> {
        let until = ((target >> self.shift) as usize).min(self.marks.len());
        let index = (0..until).rev().find(|&index| self.marks.get(index).is_some_and(|mark| mark.0.frame != 0))?;
        Some((index, self.marks.get(index)?.0.frame))
    }

    /// Goes to where snapshot `index` was taken.
    pub(crate) fn restore(&self, index: usize, position: &mut PlayState, channels: &mut Channels<'_>) {
        let Some(mark) = self.marks.get(index) else { return };
        *position = mark.0;
        let kept = self.states.iter().zip(self.values.iter()).skip(index * self.moving);
        for (state, (kept, value)) in channels.states.iter_mut().zip(kept) {
            state.become_as(kept);
            if let Some(p) = channels.pose.get_mut(usize::from(state.slot)) {
                *p = *value;
            }
        }
    }
}
