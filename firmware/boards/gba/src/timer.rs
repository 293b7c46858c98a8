//! Ticks at a clip's frame rate, in steps of the display's frames.

use crate::start::{blanks, sleep};
use board_common::TickSource;

/// The time of a display frame, taken as 1/60 s: it is 16.743 ms, so that clips play 0.5 % slower than they state, and those of 30, 60 and
/// 120 frames per second never skip one. Rounded up, so that two of them are a frame of 1/30 s.
const BLANK_NS: u32 = 16_666_668;

/// A timer that counts vertical blanks.
#[derive(Debug)]
pub struct BlankTimer {
    period_ns: u32,
    /// Time since the last tick.
    since_ns: u32,
    /// The count of blanks up to which time was added.
    counted: u32,
}

impl BlankTimer {
    pub const fn new() -> Self {
        BlankTimer { period_ns: BLANK_NS, since_ns: 0, counted: 0 }
    }
}

impl TickSource for BlankTimer {
    fn start(&mut self, period_ns: u32) {
        // From a blank on: a picture that was begun between two would be shown one later, and the next frame be skipped.
        let before = blanks();
        while blanks() == before {
            sleep();
        }
        *self = BlankTimer { period_ns: period_ns.max(1), since_ns: 0, counted: blanks() };
    }

    fn ticks(&mut self) -> u32 {
        let now = blanks();
        let passed = now.wrapping_sub(self.counted);
        self.counted = now;
        self.since_ns = self.since_ns.saturating_add(passed.saturating_mul(BLANK_NS));
        let ticks = self.since_ns / self.period_ns;
        self.since_ns -= ticks * self.period_ns;
        ticks
    }

    fn wait(&mut self, mut idle: impl FnMut()) -> u32 {
        let mut ticks = self.ticks();
        while ticks == 0 {
            idle();
            sleep();
            ticks = self.ticks();
        }
        ticks
    }
}
