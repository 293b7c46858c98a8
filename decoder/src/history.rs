//! Steps taken back exactly, from memory that the caller lends.

use crate::channel::ChannelState;
use crate::entropy::Cursor;
use crate::play_state::{Channels, PlayState};

/// What reading one segment changed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Undo {
    w: i32,
    k: i32,
    cursor: Cursor,
    frame: u32,
    channel: u16,
    mode: u8,
    prev_sign: i8,
}

/// A ring of the last segments read.
#[derive(Debug)]
pub(crate) struct History<'m> {
    ring: &'m mut [Undo],
    /// Where the next record goes.
    end: usize,
    len: usize,
    /// The frame that the newest records led to, and the earliest that they lead back to.
    frame: u32,
    floor: u32,
    /// Most frames that it led back since it was last found wanting.
    span: u32,
}

/// Minimum number of frames that are replayed when the history is exhausted.
const REFILL: u32 = 16;

impl<'m> History<'m> {
    pub(crate) fn new(ring: &'m mut [Undo]) -> History<'m> {
        History { ring, end: 0, len: 0, frame: 0, floor: 0, span: 0 }
    }

    /// Records of the step from `frame` follow. What does not lead to `frame` is forgotten.
    pub(crate) fn begin(&mut self, frame: u32) {
        if self.frame != frame {
            (self.len, self.floor) = (0, frame);
        }
        self.frame = frame + 1;
        self.span = self.span.max(frame.saturating_sub(self.floor));
    }

    /// Returns the number of frames to replay when the history is exhausted: twice its largest recent span, so that at most that
    /// span is replayed in vain.
    pub(crate) fn refill(&mut self) -> u32 {
        let frames = (2 * self.span).max(REFILL);
        self.span = 0;
        if self.ring.is_empty() { 0 } else { frames }
    }

    /// Keeps what a segment's reading will change.
    pub(crate) fn push(&mut self, frame: u32, channel: u16, cursor: Cursor, state: &ChannelState) {
        let full = self.len == self.ring.len();
        let Some(place) = self.ring.get_mut(self.end) else {
            self.floor = frame + 1;
            return;
        };
        if full {
            self.floor = place.frame + 1;
        } else {
            self.len += 1;
        }
        *place = Undo { w: state.w, k: state.k, cursor, frame, channel, mode: state.mode, prev_sign: state.prev_sign };
        self.end = if self.end + 1 == self.ring.len() { 0 } else { self.end + 1 };
    }

    /// Takes the last step back; false if what is kept does not lead there.
    pub(crate) fn step_back(&mut self, position: &mut PlayState, channels: &mut Channels<'_>) -> bool {
        if self.frame != position.frame || self.floor >= position.frame {
            return false;
        }
        position.retreat(channels);
        self.frame = position.frame;
        while self.len > 0 {
            let before = if self.end == 0 { self.ring.len() } else { self.end } - 1;
            let Some(undo) = self.ring.get(before).filter(|undo| undo.frame == position.frame) else { break };
            if let Some(state) = channels.states.get_mut(usize::from(undo.channel)) {
                (state.w, state.k, state.prev_sign, state.mode) = (undo.w, undo.k, undo.prev_sign, undo.mode);
                // It was read when it was due.
                state.due = undo.frame as u8;
            }
            position.cursor = undo.cursor;
            self.end = before;
            self.len -= 1;
        }
        true
    }
}
