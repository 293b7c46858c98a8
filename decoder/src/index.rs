//! Snapshots in the file (`--index`): after the motion, in blocks of their own. A decoder may leave them out.

use crate::blocks::Input;
use crate::bytes::Reader;
use crate::channel::ChannelState;
use crate::codec::varint::{self, put_zigzag};
use crate::entropy::{Cursor, STATE_BYTES};
use crate::layout::{START_MODE, segment_type};
use crate::play_state::{Channels, PlayState};

/// Where a snapshot stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    pub(crate) frame: u32,
    position: u32,
}

/// The last snapshot of no later frame than `target`.
#[inline(never)]
pub(crate) fn nearest(input: &Input<'_>, target: u32) -> Option<Entry> {
    let mut reader = Reader::of_blocks(input, 0);
    let spacing = reader.varint();
    let count = reader.varint();
    let mut entry = Entry { frame: 0, position: 0 };
    for _ in 0..count {
        let frame = entry.frame.checked_add(spacing)?;
        // An index that ends before its list does would read zeros for long.
        if frame > target || spacing == 0 || reader.overrun() {
            break;
        }
        entry = Entry { frame, position: entry.position.wrapping_add(reader.varint()) };
    }
    (entry.frame > 0).then_some(entry)
}

/// Goes to where the snapshot was taken. Every channel has its slot and step from its start.
#[inline(never)]
pub(crate) fn restore(input: &Input<'_>, entry: Entry, position: &mut PlayState, channels: &mut Channels<'_>) {
    let mut reader = Reader::of_blocks(input, entry.position);
    let at = reader.varint();
    let state = reader.state();
    *position = PlayState { cursor: Cursor::at(at, state), frame: entry.frame, next: 0 };
    for state in channels.states.iter_mut() {
        let mode = reader.byte();
        state.mode = (mode & START_MODE).min(START_MODE - 1);
        state.prev_sign = (mode >> 6).min(2) as i8 - 1;
        state.due = (entry.frame as u8).wrapping_add(reader.byte());
        let p = reader.zigzag();
        state.v = reader.zigzag();
        state.w = reader.zigzag();
        state.k = if has_slope(state.mode) { reader.zigzag() } else { 0 };
        if let Some(value) = channels.pose.get_mut(usize::from(state.slot)) {
            *value = p;
        }
    }
}

/// Writes what [`restore`] reads.
pub(crate) fn write(position: &PlayState, states: &[ChannelState], pose: &[i32], put: &mut dyn FnMut(u8)) {
    varint::put(position.cursor.position, put);
    let state = position.cursor.state();
    (0..STATE_BYTES).rev().for_each(|byte| put((state >> (8 * byte)) as u8));
    for state in states {
        put(state.mode | ((state.prev_sign + 1) as u8) << 6);
        put(state.due.wrapping_sub(position.frame as u8));
        let p = pose.get(usize::from(state.slot)).copied().unwrap_or(0);
        [p, state.v, state.w].into_iter().for_each(|value| put_zigzag(value, put));
        if has_slope(state.mode) {
            put_zigzag(state.k, put);
        }
    }
}

fn has_slope(mode: u8) -> bool {
    mode >> 4 != segment_type::W
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_snapshot_is_the_last_of_no_later_frame() {
        // Two snapshots, 10 frames apart, at 5 and 12.
        let input = Input(&[10, 2, 5, 7]);
        let at = |target| nearest(&input, target).map(|entry| (entry.frame, entry.position));
        assert_eq!([0, 9, 10, 19, 20, 1000].map(at), [None, None, Some((10, 5)), Some((10, 5)), Some((20, 12)), Some((20, 12))]);
        assert_eq!(nearest(&Input(&[10, 0]), 100), None);
    }

    #[test]
    fn a_snapshot_never_leads_back_before_the_first_segment() {
        // A position, a state, then a channel: its mode and sign, frames to its next segment, p, v, w and k.
        let input = Input(&[9, 1, 2, 3, 0xff, 4, 2, 4, 6, 8]);
        let (mut states, mut pose) = ([ChannelState::NEW], [0]);
        let mut position = PlayState::default();
        let mut channels = Channels { states: &mut states, pose: &mut pose };
        restore(&input, Entry { frame: 300, position: 0 }, &mut position, &mut channels);
        assert_eq!((position.frame, position.cursor), (300, Cursor::at(9, 0x01_0203)));
        let state = ChannelState { v: 2, w: 3, k: 4, due: 48, mode: START_MODE - 1, prev_sign: 1, ..ChannelState::NEW };
        assert_eq!((states, pose), ([state], [1]));
    }
}
