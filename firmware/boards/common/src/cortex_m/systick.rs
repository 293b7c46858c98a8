//! Ticks by the processor's own timer, which interrupts the wait for them.

use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

/// The timer counts 24 bits.
const LONGEST: u32 = 1 << 24;

/// Timer periods since the start.
static PERIODS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    // Nothing else writes it.
    PERIODS.store(PERIODS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// The timer of a processor that runs at so many kilohertz.
pub struct SysTick<const KILOHERTZ: u32> {
    timer: Option<SYST>,
    /// Timer periods in a tick: more than one where a tick is longer than the timer can count.
    periods: u32,
    /// Periods up to the last tick that was told of.
    told: u32,
}

impl<const KILOHERTZ: u32> SysTick<KILOHERTZ> {
    /// Clocks in 2^32 nanoseconds: rounded up, so that no tick of whole clocks loses one.
    const CLOCKS: u64 = ((KILOHERTZ as u64) << 32).div_ceil(1_000_000);

    /// Takes `cortex_m::Peripherals`: only the first of them ticks, and none where a program has taken these before.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        SysTick { timer: Peripherals::take().map(|peripherals| peripherals.SYST), periods: 1, told: 0 }
    }

    /// Ticks every `nanoseconds` from now on.
    pub fn start(&mut self, nanoseconds: u32) {
        // At most 2^32 where the processor runs at a gigahertz or less.
        let clocks = u32::try_from((u64::from(nanoseconds) * Self::CLOCKS) >> 32).unwrap_or(u32::MAX);
        self.periods = clocks.div_ceil(LONGEST).max(1);
        self.told = PERIODS.load(Ordering::Relaxed);
        if let Some(timer) = &mut self.timer {
            timer.set_clock_source(SystClkSource::Core);
            timer.set_reload(clocks.checked_div(self.periods).unwrap_or(0).max(2) - 1);
            timer.clear_current();
            timer.enable_interrupt();
            timer.enable_counter();
        }
    }

    /// Returns the ticks since the last call, without waiting.
    pub fn ticks(&mut self) -> u32 {
        let ticks = PERIODS.load(Ordering::Relaxed).wrapping_sub(self.told).checked_div(self.periods).unwrap_or(1);
        self.told = self.told.wrapping_add(ticks * self.periods);
        ticks
    }

    /// Waits for a tick and tells how many there were since the last call. Meanwhile `awake` is called a few times a second.
    pub fn wait(&mut self, mut awake: impl FnMut()) -> u32 {
        loop {
            awake();
            // An interrupt between the look and the sleep ends the sleep, and is taken after it.
            let ticks = cortex_m::interrupt::free(|_| {
                let ticks = PERIODS.load(Ordering::Relaxed).wrapping_sub(self.told).checked_div(self.periods).unwrap_or(1);
                if ticks == 0 {
                    cortex_m::asm::wfi();
                }
                ticks
            });
            if ticks > 0 {
                self.told = self.told.wrapping_add(ticks * self.periods);
                return ticks;
            }
        }
    }
}
