//! The processor's own timer. Its interrupt ends the processor's sleep.

use crate::ticks::{TickSource, counts};
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

/// The timer's counter has 24 bits.
const LONGEST: u32 = 1 << 24;

/// Timer periods since the start.
static PERIODS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    // Nothing else writes it.
    PERIODS.store(PERIODS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// The timer of a processor that runs at `CPU_HZ`.
pub struct SysTick<const CPU_HZ: u32> {
    timer: Option<SYST>,
    /// Timer periods in a tick: more than one where a tick is longer than the timer can count.
    periods: u32,
    /// Periods up to the last tick that was returned.
    counted: u32,
}

impl<const CPU_HZ: u32> SysTick<CPU_HZ> {
    /// Takes `cortex_m::Peripherals`. Only the first timer ticks, and none does if the program has taken these before.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        SysTick { timer: Peripherals::take().map(|peripherals| peripherals.SYST), periods: 1, counted: 0 }
    }

    #[inline(always)]
    fn passed(&self) -> u32 {
        PERIODS.load(Ordering::Relaxed).wrapping_sub(self.counted).checked_div(self.periods).unwrap_or(1)
    }
}

impl<const CPU_HZ: u32> TickSource for SysTick<CPU_HZ> {
    fn start(&mut self, period_ns: u32) {
        let clocks = counts::<CPU_HZ>(period_ns);
        self.periods = clocks.div_ceil(LONGEST);
        self.counted = PERIODS.load(Ordering::Relaxed);
        if let Some(timer) = &mut self.timer {
            timer.set_clock_source(SystClkSource::Core);
            timer.set_reload(clocks.checked_div(self.periods).unwrap_or(0).max(2) - 1);
            timer.clear_current();
            timer.enable_interrupt();
            timer.enable_counter();
        }
    }

    fn ticks(&mut self) -> u32 {
        let ticks = self.passed();
        self.counted = self.counted.wrapping_add(ticks * self.periods);
        ticks
    }

    fn wait(&mut self, mut idle: impl FnMut()) -> u32 {
        loop {
            idle();
            // An interrupt between the check and the sleep ends the sleep, and is handled after it.
            let ticks = cortex_m::interrupt::free(|_| {
                let ticks = self.passed();
                if ticks == 0 {
                    cortex_m::asm::wfi();
                }
                ticks
            });
            if ticks > 0 {
                self.counted = self.counted.wrapping_add(ticks * self.periods);
                return ticks;
            }
        }
    }
}
