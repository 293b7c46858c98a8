//! What turns a clip into packets and says when each has to leave.

mod announce;
mod live;
mod pack;
mod refresh;
mod schedule;
mod source;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod train;
mod writer;

pub use live::{Live, LiveChannel, LiveTiming};
pub use schedule::{ByteCounts, LineSettings, Schedule, TimedPacket};
pub use source::{Source, SourceError};

use pantin_link::Head;

/// Sends clips one after the other over a line.
#[derive(Clone, Debug)]
pub struct Sender {
    session: u16,
    clip: u8,
    sequence: u8,
}

/// The line's frame at which a clip begins: frames before it are those of its look-ahead.
pub const BEGIN: u32 = 1 << 8;

impl Sender {
    /// `session` should be drawn by chance.
    pub fn new(session: u16) -> Sender {
        Sender { session, clip: 0, sequence: 0 }
    }

    /// The packets of the next clip, `rounds` times around, or for ever. The line begins to carry them its look-ahead before the clip's first frame.
    /// [`Sender::end_clip`] has to be told what came of it.
    pub fn clip<'s>(&mut self, source: &'s Source, line: LineSettings, rounds: Option<u32>) -> Schedule<'s> {
        let head = Head { session: self.session, clip: self.clip, begin: BEGIN, ..source.head };
        self.clip = self.clip.wrapping_add(1);
        let start = -f64::from(line.ahead) * f64::from(head.frame_time_ns) / 1e9;
        Schedule::new(source, head, line, rounds, self.sequence, start)
    }

    /// Motion that is made while it is sent: `making` is what `source` was made with. Nothing comes after it.
    pub fn live<'s>(self, source: &'s Source, line: LineSettings, timing: LiveTiming, making: &[LiveChannel]) -> Live<'s> {
        let head = Head { session: self.session, clip: self.clip, begin: BEGIN, ..source.head };
        Live::new(source, head, (line, timing), making, self.sequence)
    }

    /// Goes on after a clip.
    pub fn end_clip(&mut self, schedule: &Schedule<'_>) {
        self.sequence = schedule.sequence();
    }
}

impl LineSettings {
    /// The line with the shortest cycle that carries the clip, from `self.cycle` up: in time and within the share. None if none does.
    pub fn fitted(self, source: &Source) -> Option<LineSettings> {
        let with = |cycle: u32| LineSettings { cycle, ..self };
        let (mut low, mut high) = (self.cycle, LONGEST_CYCLE);
        if !schedule::fits(source, with(high)) {
            return None;
        }
        while low < high {
            let middle = (low + high) / 2;
            if schedule::fits(source, with(middle)) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        Some(with(high))
    }
}

/// Frames of the longest cycle.
pub const LONGEST_CYCLE: u32 = 120;
