//! Ticks of a pace, from a 32-bit counter that runs on.

/// A pace. It must be asked before the counter has come round once.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Counts a microsecond.
    rate: u32,
    /// Counts a tick.
    period: u32,
    /// Where the last tick was that was told of.
    last: u32,
}

impl Pace {
    /// By a counter of so many counts a microsecond.
    pub const fn new(rate: u32) -> Self {
        Pace { rate, period: u32::MAX, last: 0 }
    }

    /// Ticks every `nanoseconds` from now on. A tick is at least a count, and at most 2^32 of them.
    pub fn start(&mut self, nanoseconds: u32, now: u32) {
        let (whole, part) = (nanoseconds / 1000, nanoseconds % 1000);
        self.period = whole.saturating_mul(self.rate).saturating_add(part * self.rate / 1000).max(1);
        self.last = now;
    }

    /// Returns the ticks since the last call, without waiting.
    pub fn ticks(&mut self, now: u32) -> u32 {
        let elapsed = now.wrapping_sub(self.last);
        if elapsed < self.period {
            return 0;
        }
        let ticks = elapsed / self.period;
        self.last = self.last.wrapping_add(ticks * self.period);
        ticks
    }
}
