//! Where a player is, and its ways on: the additions, the segments that are due, and hops over many frames.

use crate::blocks::Input;
use crate::channel::ChannelState;
use crate::entropy::Cursor;
use crate::history::History;
use crate::layout::MAX_STEP;
use crate::segment::{self, Segments};

/// All of a player's state but the channels and the pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PlayState {
    pub(crate) cursor: Cursor,
    pub(crate) frame: u32,
    /// Channels below have read what they need for the step from this frame.
    pub(crate) next: u16,
}

/// The moving channels and the pose, while a frame is made.
pub(crate) struct Channels<'p> {
    pub(crate) states: &'p mut [ChannelState],
    pub(crate) pose: &'p mut [i32],
}

/// A segment at frame f first changes the position at f + 2: none starts at the last frames.
const LAST_FRAMES: u32 = 2;

/// Whether segments may start at a frame.
pub(crate) fn reads(frame: u32, frames: u32) -> bool {
    frame + LAST_FRAMES < frames
}

/// Lists of channels by the frame at which their segments end, modulo [`LISTS`]: a seek looks at no channel before its segment ends, but at
/// those of segments of 96 frames once, after 32. An entry is the number of the last channel of its list, from 1, and each channel has that of
/// the one before; 0 is none. More lists would take more stack.
type Calendar = [u16; LISTS];

const LISTS: usize = 64;

/// The list of a frame.
fn list(calendar: &mut Calendar, frame: u8) -> &mut u16 {
    &mut calendar[usize::from(frame) % LISTS]
}

/// Puts a channel into a list whose last one is a later channel.
#[inline(never)]
fn put_before(states: &mut [ChannelState], mut later: u16, number: u16) {
    while let Some(state) = numbered(states, later) {
        let before = state.next;
        if before < number {
            state.next = number;
            if let Some(state) = numbered(states, number) {
                state.next = before;
            }
            return;
        }
        later = before;
    }
}

/// The channel of a number from 1.
fn numbered(states: &mut [ChannelState], number: u16) -> Option<&mut ChannelState> {
    states.get_mut(usize::from(number).wrapping_sub(1))
}

/// Makes the channels that follow what their leaders are: all of them stand at the same frame.
#[inline(never)]
pub(crate) fn follow(channels: &mut Channels<'_>) {
    let mut index = 0usize;
    while let Some((before, [state, ..])) = channels.states.split_at_mut_checked(index) {
        // None for one that does not follow, and for one that follows what is not there, as no well-formed one does.
        let leader = before.get(index.wrapping_sub(usize::from(state.step.saturating_sub(MAX_STEP))));
        if let Some(leader) = leader {
            state.v = leader.v;
            (state.w, state.k, state.mode, state.due) = (leader.w, leader.k, leader.mode, leader.due);
            let p = channels.pose.get(usize::from(leader.slot)).copied();
            if let (Some(p), Some(value)) = (p, channels.pose.get_mut(usize::from(state.slot))) {
                *value = p;
            }
        }
        index += 1;
    }
}

/// [`segment::read`] of a state to which another motion was added. Not in line: the loop of the additions keeps its registers.
#[inline(never)]
fn read_added(state: &mut ChannelState, segments: &mut Segments<'_>, added: &mut dyn FnMut(usize) -> [i32; 2]) {
    let [w, k] = added(state.slot());
    (state.w, state.k) = (state.w.wrapping_sub(w), state.k.wrapping_sub(k));
    segment::read(state, segments);
    (state.w, state.k) = (state.w.wrapping_add(w), state.k.wrapping_add(k));
}

impl PlayState {
    /// Reads the segments that start at this frame, in the order of channels, and keeps in `history` what undoes it. False if
    /// the input ran dry: call again when it holds more.
    #[inline(never)]
    pub(crate) fn read_due(
        &mut self,
        channels: &mut Channels<'_>,
        input: &Input<'_>,
        dry_at: u32,
        mut history: Option<&mut History<'_>>,
    ) -> bool {
        let now = self.frame as u8;
        let states = channels.states.get_mut(usize::from(self.next)..).unwrap_or(&mut []);
        let mut segments = Segments::at(self.cursor, input);
        for state in states {
            if state.due == now {
                if segments.symbols.at.position > dry_at {
                    self.cursor = segments.symbols.at;
                    return false;
                }
                if let Some(history) = &mut history {
                    history.push(self.frame, self.next, segments.symbols.at, state);
                }
                segment::read(state, &mut segments);
            }
            self.next += 1;
        }
        self.cursor = segments.symbols.at;
        follow(channels);
        true
    }

    /// One frame on, if it is not the last and its segments begin at `dry_at` at the latest; keeps in `history` what undoes it.
    /// Otherwise false, and some of the segments are perhaps read.
    pub(crate) fn try_step(
        &mut self,
        channels: &mut Channels<'_>,
        input: &Input<'_>,
        frames: u32,
        dry_at: u32,
        history: Option<&mut History<'_>>,
    ) -> bool {
        if self.frame + 1 >= frames || reads(self.frame, frames) && !self.read_due(channels, input, dry_at, history) {
            return false;
        }
        self.advance(channels);
        true
    }

    /// The three additions, for every channel.
    #[inline]
    pub(crate) fn advance(&mut self, channels: &mut Channels<'_>) {
        for state in channels.states.iter_mut() {
            state.add(channels.pose);
        }
        self.frame += 1;
        self.next = 0;
    }

    /// The three additions taken back, last first.
    pub(crate) fn retreat(&mut self, channels: &mut Channels<'_>) {
        for state in channels.states.iter_mut() {
            state.w = state.w.wrapping_sub(state.k);
            state.v = state.v.wrapping_sub(state.w);
            if let Some(p) = channels.pose.get_mut(usize::from(state.slot)) {
                *p = p.wrapping_sub(state.v);
            }
        }
        self.frame -= 1;
    }

    /// One frame on, with its segments: what `read_due` and `advance` do, in one loop.
    pub(crate) fn step(&mut self, channels: &mut Channels<'_>, input: &Input<'_>, frames: u32) {
        self.step_reading(channels, input, frames, segment::read);
    }

    /// [`PlayState::step`] of states to which other motions were added: `added` returns the acceleration and slope of a state's.
    #[inline(never)]
    pub(crate) fn step_added(
        &mut self,
        channels: &mut Channels<'_>,
        input: &Input<'_>,
        frames: u32,
        added: &mut dyn FnMut(usize) -> [i32; 2],
    ) {
        self.step_reading(channels, input, frames, |state, segments| read_added(state, segments, added));
    }

    #[inline(always)]
    fn step_reading(
        &mut self,
        channels: &mut Channels<'_>,
        input: &Input<'_>,
        frames: u32,
        mut read: impl FnMut(&mut ChannelState, &mut Segments<'_>),
    ) {
        // No channel is due at the frame before: to the last frame, none reads a segment.
        let now = self.frame.wrapping_sub(u32::from(!reads(self.frame, frames))) as u8;
        let mut segments = Segments::at(self.cursor, input);
        for state in channels.states.iter_mut() {
            if state.due == now {
                read(state, &mut segments);
            }
            state.add(channels.pose);
        }
        if segments.followers {
            follow(channels);
        }
        self.cursor = segments.symbols.at;
        self.frame += 1;
    }

    /// Goes to a later frame by hops over segments.
    #[inline(never)]
    pub(crate) fn run_to(&mut self, channels: &mut Channels<'_>, input: &Input<'_>, frames: u32, target: u32) {
        self.hop_all(channels, true);
        let mut calendar: Calendar = [0; LISTS];
        for (number, state) in (1..).zip(channels.states.iter_mut()) {
            state.next = core::mem::replace(list(&mut calendar, state.due), number);
        }
        let mut segments = Segments::at(self.cursor, input);
        let end = target.min(frames.saturating_sub(LAST_FRAMES));
        for frame in self.frame..end {
            let now = frame as u8;
            let mut last = core::mem::take(list(&mut calendar, now));
            // From the last to the first: turned around, for segments are read in the order of the channels.
            let mut first = 0;
            while let Some(state) = numbered(channels.states, last) {
                (first, last, state.next) = (last, state.next, first);
            }
            while let Some(state) = numbered(channels.states, first) {
                if state.due == now {
                    // It stands at the start of its last segment.
                    if let Some(p) = channels.pose.get_mut(usize::from(state.slot)) {
                        state.hop(p, i32::from(state.segment_frames()));
                    }
                    segment::read(state, &mut segments);
                }
                let number = core::mem::replace(&mut first, state.next);
                let last = list(&mut calendar, state.due);
                if *last < number {
                    state.next = core::mem::replace(last, number);
                } else {
                    put_before(channels.states, *last, number);
                }
            }
        }
        self.frame = target;
        self.cursor = segments.symbols.at;
        self.next = 0;
        self.hop_all(channels, false);
        // What was made of them on the way is of no account.
        follow(channels);
    }

    /// Moves every channel between this frame and the start of its segment: `back` to the start, else from it.
    fn hop_all(&self, channels: &mut Channels<'_>, back: bool) {
        for state in channels.states.iter_mut() {
            if let Some(p) = channels.pose.get_mut(usize::from(state.slot)) {
                // -96 to 2: none starts at the last two frames, and a channel that has had none is due at frame 0.
                let past = i32::from((self.frame as u8).wrapping_sub(state.due) as i8);
                let run = i32::from(state.segment_frames()) + past;
                if run != 0 {
                    state.hop(p, if back { -run } else { run });
                }
                state.next = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entropy::LOW;

    #[test]
    fn a_segment_is_read_where_it_is_sure_to_be_whole() {
        for (dry_at, read) in [(9, false), (10, true), (11, true)] {
            let (mut states, mut pose) = ([ChannelState::NEW], [0]);
            let mut channels = Channels { states: &mut states, pose: &mut pose };
            let mut position = PlayState { cursor: Cursor::at(10, LOW), frame: 0, next: 0 };
            assert_eq!(position.read_due(&mut channels, &Input(&[0; 64]), dry_at, None), read, "{dry_at}");
            assert_eq!((position.next, states[0] == ChannelState::NEW), (u16::from(read), !read), "{dry_at}");
        }
    }

    #[test]
    fn frames_share_a_list_where_they_are_a_whole_number_of_lists_apart() {
        let mut calendar: Calendar = [0; LISTS];
        for frame in 0..=255 {
            *list(&mut calendar, frame) += 1;
        }
        assert_eq!(calendar, [4; LISTS]);
        *list(&mut calendar, 65) = 7;
        assert_eq!((calendar[1], *list(&mut calendar, 129)), (7, 7));
    }
}
