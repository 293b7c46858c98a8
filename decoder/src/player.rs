//! Plays a clip: step, seek to any frame, step back. Bit for bit the same poses by every route.

use crate::blocks::Input;
use crate::channel::{ChannelState, NIL, Opening};
use crate::clip::{Clip, channel_kinds};
use crate::entropy::Symbols;
use crate::layout::START_MODE;
use crate::{TooSmall, segment};

/// Channels wait for their next segment in this many lists, by the frame at which it is due.
pub(crate) const LISTS: usize = 32;

/// Where the player is: all of its state but the channels and the pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Position {
    pub(crate) symbols: Symbols,
    pub(crate) frame: u32,
    /// First channel of each list.
    lists: [u16; LISTS],
    /// First of the channels whose segment starts at this frame and is still to be read.
    pending: u16,
    /// Whether the lists of this frame were searched for due channels.
    collected: bool,
}

/// The moving channels and the pose, while a frame is made.
pub(crate) struct Channels<'p> {
    pub(crate) states: &'p mut [ChannelState],
    pub(crate) pose: &'p mut [i32],
}

impl Position {
    /// Reads how every channel starts. `states` gets one element a moving channel.
    pub(crate) fn open(clip: &Clip<'_>, states: &mut [ChannelState], pose: &mut [i32]) -> Result<(Position, usize), TooSmall> {
        let input = clip.input();
        let mut position = Position {
            symbols: Symbols::start(&input, clip.head().symbols),
            frame: 0,
            lists: [NIL; LISTS],
            pending: NIL,
            collected: true,
        };
        let shift = i32::from(clip.rig().length_exponent()) - i32::from(clip.length_exponent());
        let mut opening = Opening::default();
        let mut moving = 0u16;
        for (slot, (kind, rest)) in channel_kinds(&clip.rig()).enumerate() {
            let (p, start) = opening.read(&mut position.symbols, &input, kind);
            let value = pose.get_mut(slot).ok_or(TooSmall { needed: clip.rig().channels() })?;
            *value = p.unwrap_or(shifted(rest, shift));
            let Some((v, step)) = start else { continue };
            let state = states.get_mut(usize::from(moving)).ok_or_else(|| TooSmall { needed: clip.moving() })?;
            *state = ChannelState { v, slot: slot as u16, step, ..ChannelState::default() };
            state.set_mode(START_MODE);
            state.set_next(position.pending);
            position.pending = moving;
            moving += 1;
        }
        Ok((position, usize::from(moving)))
    }

    /// Moves the channels that are due at this frame into `pending`, in the order of their list.
    fn collect(&mut self, states: &mut [ChannelState]) {
        let Some(head) = self.lists.get_mut(self.frame as usize % LISTS) else { return };
        let now = self.frame as u8;
        let (mut at, mut kept, mut taken) = (*head, NIL, NIL);
        *head = NIL;
        while let Some(state) = states.get(usize::from(at)) {
            let next = state.next();
            let last = if state.due == now { &mut taken } else { &mut kept };
            let before = *last;
            *last = at;
            let first = if state.due == now { &mut self.pending } else { &mut *head };
            if before == NIL {
                *first = at;
            } else if let Some(state) = states.get_mut(usize::from(before)) {
                state.set_next(at);
            }
            at = next;
        }
        for end in [kept, taken] {
            if let Some(state) = states.get_mut(usize::from(end)) {
                state.set_next(NIL);
            }
        }
        self.collected = true;
    }

    /// Reads the segments that start at this frame. With `hop`, channels stand at the start of their last segment and are
    /// first brought to its end. False if the input ran dry: call again when it holds more.
    pub(crate) fn read_due(
        &mut self,
        channels: &mut Channels<'_>,
        input: &Input<'_>,
        frames: u32,
        dry_at: u32,
        hop: bool,
    ) -> bool {
        // A segment at frame f first changes the position at f + 2: none starts later than this.
        if self.frame + 2 >= frames {
            return true;
        }
        if !self.collected {
            self.collect(channels.states);
        }
        while let Some(state) = channels.states.get_mut(usize::from(self.pending)) {
            if self.symbols.position > dry_at {
                return false;
            }
            if hop && let Some(p) = channels.pose.get_mut(usize::from(state.slot)) {
                state.hop(p, i32::from(state.length()));
            }
            let length = segment::read(state, &mut self.symbols, input);
            state.due = (self.frame as u8).wrapping_add(length);
            let index = self.pending;
            self.pending = state.next();
            if let Some(head) = self.lists.get_mut(usize::from(state.due) % LISTS) {
                state.set_next(*head);
                *head = index;
            }
        }
        true
    }

    /// The three additions, for every channel.
    #[inline]
    pub(crate) fn advance(&mut self, channels: &mut Channels<'_>) {
        for state in channels.states.iter_mut() {
            if let Some(p) = channels.pose.get_mut(usize::from(state.slot)) {
                *p = p.wrapping_add(state.v);
            }
            state.v = state.v.wrapping_add(state.w);
            state.w = state.w.wrapping_add(state.k);
        }
        self.frame += 1;
        self.collected = false;
    }

    /// Moves every channel between this frame and the start of its segment: `back` to the start, else from it.
    fn hop_all(&self, channels: &mut Channels<'_>, back: bool) {
        for state in channels.states.iter_mut() {
            if let Some(p) = channels.pose.get_mut(usize::from(state.slot)) {
                // Past the last segment's end (no segment starts at the last two frames) it is negative; so it is for a channel
                // of a clip of two frames, which has none.
                let left = i32::from(state.due.wrapping_sub(self.frame as u8) as i8);
                let run = i32::from(state.length()) - left;
                state.hop(p, if back { -run } else { run });
            }
        }
    }
}

/// A rest offset in the clip's unit, rounded down.
fn shifted(rest: i32, shift: i32) -> i32 {
    if shift >= 0 { rest.wrapping_shl(shift as u32) } else { rest >> shift.unsigned_abs().min(31) }
}

/// Plays a [`Clip`] in memory of the caller's: a [`ChannelState`] for each of the clip's moving channels, and a pose of
/// one raw value for each of the rig's channels.
#[derive(Debug)]
pub struct Player<'a, 'm> {
    clip: Clip<'a>,
    states: &'m mut [ChannelState],
    pose: &'m mut [i32],
    position: Position,
}

impl<'a, 'm> Player<'a, 'm> {
    /// Starts at frame 0. `states` needs [`Clip::moving`] elements, `pose` needs [`crate::Rig::channels`].
    pub fn new(clip: Clip<'a>, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Self, TooSmall> {
        let (position, moving) = Position::open(&clip, states, pose)?;
        let states = states.get_mut(..moving).ok_or(TooSmall { needed: moving })?;
        Ok(Player { clip, states, pose, position })
    }

    /// The clip that plays.
    pub fn clip(&self) -> &Clip<'a> {
        &self.clip
    }

    /// The frame that the pose shows.
    pub fn frame(&self) -> u32 {
        self.position.frame
    }

    /// One raw value a channel of the rig: see [`crate::units`].
    pub fn pose(&self) -> &[i32] {
        self.pose
    }

    /// Goes on by one frame; from the last frame to frame 0.
    pub fn step(&mut self) {
        let frames = self.clip.frames();
        if self.position.frame + 1 >= frames {
            self.rewind();
            return;
        }
        let mut channels = Channels { states: &mut *self.states, pose: &mut *self.pose };
        self.position.read_due(&mut channels, &self.clip.input(), frames, u32::MAX, false);
        self.position.advance(&mut channels);
    }

    /// Goes back to frame 0.
    pub fn rewind(&mut self) {
        // The memory sufficed when the player was made, and no other clip can have come in since.
        if let Ok((position, _)) = Position::open(&self.clip, self.states, self.pose) {
            self.position = position;
        }
    }

    /// Goes to `frame`, or to the last one if there are fewer. Forward it costs a hop a segment on the way; backward it
    /// starts from frame 0.
    pub fn seek(&mut self, frame: u32) {
        let frames = self.clip.frames();
        let target = frame.min(frames - 1);
        if target < self.position.frame {
            self.rewind();
        }
        let mut channels = Channels { states: &mut *self.states, pose: &mut *self.pose };
        self.position.hop_all(&mut channels, true);
        while self.position.frame < target {
            self.position.read_due(&mut channels, &self.clip.input(), frames, u32::MAX, true);
            self.position.frame += 1;
            self.position.collected = false;
        }
        self.position.hop_all(&mut channels, false);
    }
}
