//! One channel at the receiver: the state, which equals the sender's while the two are in sync, and the drawn value.

use crate::head::{ChannelKind, pace};
use crate::message::Message;

/// What the receiver knows about a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Sync {
    /// Nothing.
    #[default]
    Unknown,
    /// The channel has one value for the whole clip.
    Constant,
    /// The channel moves; its state is unknown.
    Lost,
    /// The channel moves; its state equals the sender's.
    Exact,
}

/// The receiver's memory for one channel of the pose: 36 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Channel {
    /// p, v, w and k in raw units.
    state: [i32; 4],
    /// The last change of the drawn value, in raw units.
    last_move: i32,
    /// p at the last drawn frame, if the state was exact there.
    last_exact: Option<i32>,
    /// The line frame, modulo 2^16, at which the next message is due.
    due: u16,
    /// The distance in channels to the leader that this channel follows; 0 if it follows none.
    back: u16,
    step: u8,
    pace: u8,
    sync: Sync,
    /// Whether the drawn value has reached the state once since the clip began.
    joined: bool,
}

impl Channel {
    /// Sets what kind of channel this is. Repeating the same kind changes nothing.
    pub(crate) fn set_kind(&mut self, kind: ChannelKind) {
        let sync = match kind {
            ChannelKind::Constant(p) => {
                self.state = [p, 0, 0, 0];
                Sync::Constant
            }
            ChannelKind::Moving { step, pace } => {
                (self.step, self.pace, self.back) = (step, pace, 0);
                Sync::Lost
            }
            ChannelKind::Follower(back) => {
                self.back = back.max(1);
                Sync::Lost
            }
        };
        if sync == Sync::Constant || self.sync != Sync::Exact {
            self.sync = sync;
        }
    }

    /// Forgets everything except the drawn value's speed.
    pub(crate) fn forget(&mut self) {
        *self = Channel { last_move: self.last_move, ..Channel::default() };
    }

    /// Returns whether the state equals the sender's.
    pub(crate) fn is_exact(&self) -> bool {
        matches!(self.sync, Sync::Constant | Sync::Exact)
    }

    /// Returns the distance to the leader, if the channel follows one.
    pub(crate) fn follows(&self) -> Option<usize> {
        (self.back > 0).then_some(usize::from(self.back))
    }

    /// Copies the leader's state.
    pub(crate) fn follow(&mut self, leader: &Channel) {
        (self.state, self.pace, self.sync) = (leader.state, leader.pace, leader.sync);
    }

    /// Returns whether the drawn value has reached the state once since the clip began: from then on it moves by at most its pace per frame.
    pub fn has_joined(&self) -> bool {
        self.joined
    }

    /// Returns p, v, w and k in raw units, or `None` if the state is not known exactly.
    pub fn state(&self) -> Option<[i32; 4]> {
        self.is_exact().then_some(self.state)
    }

    /// Applies a message of this frame. A segment without a refresh is used only if it was due at this frame.
    pub(crate) fn apply(&mut self, frame: u16, message: &Message) {
        let moves = matches!(self.sync, Sync::Lost | Sync::Exact) && self.back == 0;
        if moves && (message.refresh.is_some() || self.is_due(frame)) {
            self.state = message.apply(self.state, self.step);
            self.due = frame.wrapping_add(u16::from(message.run));
            self.sync = Sync::Exact;
        }
    }

    /// Returns whether a message must start at this frame.
    fn is_due(&self, frame: u16) -> bool {
        self.sync == Sync::Exact && self.due == frame && self.back == 0
    }

    /// Gives up the state if its message was due at this frame and did not arrive; returns whether it did so.
    pub(crate) fn check(&mut self, frame: u16) -> bool {
        let lost = self.is_due(frame);
        if lost {
            self.sync = Sync::Lost;
        }
        lost
    }

    /// Gives up the state because the clock has jumped.
    pub(crate) fn lose(&mut self) {
        if self.sync == Sync::Exact {
            self.sync = Sync::Lost;
        }
    }

    /// Advances the state by one frame: three additions.
    pub(crate) fn advance(&mut self) {
        let [p, v, w, k] = self.state;
        self.state = [p.wrapping_add(v), v.wrapping_add(w), w.wrapping_add(k), k];
    }

    /// Returns the value to draw after `drawn`; `went` says whether the clock advanced. The value moves by at most the pace, except when the figure first
    /// appears: then a channel that has not reached its state yet takes three quarters of the error at once.
    pub(crate) fn draw(&mut self, drawn: i32, went: bool) -> i32 {
        let exact = self.is_exact() && (went || self.sync == Sync::Constant);
        let p = if exact { Some(self.state[0]) } else { None };
        let before = core::mem::replace(&mut self.last_exact, p);
        self.last_move = match (p, before) {
            // The value comes to rest. A first approach by three quarters may have been faster than the pace.
            (None, _) if self.joined => (self.last_move / 2).clamp(-pace(self.pace), pace(self.pace)),
            (None, _) => self.last_move / 2,
            (Some(p), before) => {
                let moved = before.map_or(0, |before| p.wrapping_sub(before));
                let off = p.wrapping_sub(moved).wrapping_sub(drawn);
                let last_move = if self.joined { self.joining(moved, off) } else { moved.wrapping_add(off - off / 4) };
                self.joined |= drawn.wrapping_add(last_move) == p;
                last_move
            }
        };
        drawn.wrapping_add(self.last_move)
    }

    /// Returns the state's own movement plus a third of the error, at least an eighth of the pace, in total at most the pace.
    fn joining(&self, moved: i32, off: i32) -> i32 {
        let pace = pace(self.pace);
        let least = (pace >> 3).max(1) as u32;
        let size = off.unsigned_abs();
        let part = size.min((size / 3).max(least)).min(i32::MAX as u32) as i32;
        let part = if off < 0 { -part } else { part };
        moved.saturating_add(part).clamp(-pace, pace)
    }
}
