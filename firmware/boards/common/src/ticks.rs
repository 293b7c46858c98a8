//! Timers that tick at a clip's frame rate.

/// A timer.
pub trait TickSource {
    /// Starts the timer with a period in nanoseconds, or changes its period. Ticks count from now on.
    fn start(&mut self, period_ns: u32);

    /// Returns the number of ticks since the last call, without waiting.
    fn ticks(&mut self) -> u32;

    /// Waits until the timer has ticked and returns the number of ticks since the last call: at least 1. Meanwhile it calls `idle` at least
    /// a few times a second.
    fn wait(&mut self, idle: impl FnMut()) -> u32;
}

/// Returns the counts of a counter of `HZ` in a time: at least 1, and at most 2^32 - 1.
#[inline(always)]
pub(crate) fn counts<const HZ: u32>(nanoseconds: u32) -> u32 {
    // In 2^32 ns, rounded up, so that a period of a whole number of counts loses none. At most 2^32: the product fits in 64 bits.
    let counts = const {
        assert!(HZ <= 1_000_000_000, "a counter of at most 1 GHz");
        ((HZ as u64) << 32).div_ceil(1_000_000_000)
    };
    ((u64::from(nanoseconds) * counts) >> 32).clamp(1, u64::from(u32::MAX)) as u32
}

/// A timer over a free-running 32-bit counter of `HZ`, which `N` reads. It must be asked for ticks before the counter wraps around twice.
/// Between ticks it calls `S`, which makes the processor sleep.
#[derive(Debug)]
pub struct TickTimer<const HZ: u32, N, S> {
    now: N,
    sleep: S,
    /// Counts in a tick.
    period: u32,
    /// The counter at the last tick that was returned.
    last: u32,
}

impl<const HZ: u32, N: FnMut() -> u32, S: FnMut()> TickTimer<HZ, N, S> {
    /// Makes a timer over a counter that `now` reads. `sleep` returns after a time that is short beside a tick, for instance at an interrupt
    /// every millisecond, since a tick is late by at most this time; `|| {}` does not sleep.
    pub const fn new(now: N, sleep: S) -> Self {
        TickTimer { now, sleep, period: u32::MAX, last: 0 }
    }
}

impl<const HZ: u32, N: FnMut() -> u32, S: FnMut()> TickSource for TickTimer<HZ, N, S> {
    #[inline(always)]
    fn start(&mut self, period_ns: u32) {
        self.period = counts::<HZ>(period_ns);
        self.last = (self.now)();
    }

    #[inline(always)]
    fn ticks(&mut self) -> u32 {
        let elapsed = (self.now)().wrapping_sub(self.last);
        if elapsed < self.period {
            return 0;
        }
        let ticks = elapsed / self.period;
        self.last = self.last.wrapping_add(ticks * self.period);
        ticks
    }

    #[inline(always)]
    fn wait(&mut self, mut idle: impl FnMut()) -> u32 {
        loop {
            idle();
            match self.ticks() {
                0 => (self.sleep)(),
                ticks => return ticks,
            }
        }
    }
}
