//! A channel at the receiver: the state that the sender's equals while both are in step, and the value that is drawn.

use crate::head::{ChannelKind, pace};
use crate::message::Message;

/// What is known of a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Sync {
    /// Nothing yet.
    #[default]
    Unknown,
    /// That it has one value.
    Constant,
    /// That it moves, but not where it is.
    Lost,
    /// Its state.
    Exact,
}

/// A channel of the pose: 36 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Channel {
    /// p, v, w, k.
    state: [i32; 4],
    /// What the drawn value moved by last.
    last_move: i32,
    /// p when it was drawn last, for one that was exact then.
    last_exact: Option<i32>,
    /// The frame at which the next message is due.
    due: u16,
    /// How many channels before it stands the one that it follows; 0 if it leads.
    back: u16,
    step: u8,
    pace: u8,
    sync: Sync,
    /// Whether the drawn value has once been the state.
    joined: bool,
}

impl Channel {
    /// Takes what the channel is. ScheduledMessage again it changes nothing.
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

    /// Forgets all but what is drawn.
    pub(crate) fn forget(&mut self) {
        *self = Channel { last_move: self.last_move, ..Channel::default() };
    }

    /// Whether it is all that the sender has of it.
    pub(crate) fn is_exact(&self) -> bool {
        matches!(self.sync, Sync::Constant | Sync::Exact)
    }

    /// How many channels before it the one stands that it follows.
    pub(crate) fn follows(&self) -> Option<usize> {
        (self.back > 0).then_some(usize::from(self.back))
    }

    /// Becomes as the channel that it follows.
    pub(crate) fn follow(&mut self, leader: &Channel) {
        (self.state, self.pace, self.sync) = (leader.state, leader.pace, leader.sync);
    }

    /// Returns whether the drawn value has reached the state once since the clip began: from then on it moves by at most its pace per frame.
    pub fn has_joined(&self) -> bool {
        self.joined
    }

    /// p, v, w and k, where they are known.
    pub fn state(&self) -> Option<[i32; 4]> {
        self.is_exact().then_some(self.state)
    }

    /// Takes a message of this frame. A segment alone is of use where the one before it ends.
    pub(crate) fn apply(&mut self, frame: u16, message: &Message) {
        let moves = matches!(self.sync, Sync::Lost | Sync::Exact) && self.back == 0;
        if moves && (message.refresh.is_some() || self.is_due(frame)) {
            self.state = message.apply(self.state, self.step);
            self.due = frame.wrapping_add(u16::from(message.run));
            self.sync = Sync::Exact;
        }
    }

    /// Whether a segment has to begin at this frame.
    fn is_due(&self, frame: u16) -> bool {
        self.sync == Sync::Exact && self.due == frame && self.back == 0
    }

    /// Loses the state if none began at this frame; whether it did.
    pub(crate) fn check(&mut self, frame: u16) -> bool {
        let lost = self.is_due(frame);
        if lost {
            self.sync = Sync::Lost;
        }
        lost
    }

    /// Loses the state: time has jumped.
    pub(crate) fn lose(&mut self) {
        if self.sync == Sync::Exact {
            self.sync = Sync::Lost;
        }
    }

    /// The three additions.
    pub(crate) fn advance(&mut self) {
        let [p, v, w, k] = self.state;
        self.state = [p.wrapping_add(v), v.wrapping_add(w), w.wrapping_add(k), k];
    }

    /// The value to draw after `drawn`; `went` is whether time went on. It never moves by more than the pace, but where the figure first
    /// appears: a channel that has not joined its state yet goes three quarters of the way.
    pub(crate) fn draw(&mut self, drawn: i32, went: bool) -> i32 {
        let exact = self.is_exact() && (went || self.sync == Sync::Constant);
        let p = if exact { Some(self.state[0]) } else { None };
        let before = core::mem::replace(&mut self.last_exact, p);
        self.last_move = match (p, before) {
            // It comes to rest; what came by three quarters may have been faster.
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

    /// As the state has moved, and a third of the way to it; at least an eighth of the pace, so that it arrives; at most the pace in all.
    fn joining(&self, moved: i32, off: i32) -> i32 {
        let pace = pace(self.pace);
        let least = (pace >> 3).max(1) as u32;
        let size = off.unsigned_abs();
        let part = size.min((size / 3).max(least)).min(i32::MAX as u32) as i32;
        let part = if off < 0 { -part } else { part };
        moved.saturating_add(part).clamp(-pace, pace)
    }
}
