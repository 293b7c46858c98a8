//! A Cortex-M: faults, stack guard, timer.

mod faults;
mod guard;
#[cfg(not(feature = "emulated"))]
pub(crate) mod kept;
mod systick;

pub use guard::guard_stack;
pub use systick::SysTick;

use embedded_hal::delay::DelayNs;

/// A delay that counts clocks of a processor of `CPU_HZ`, a whole number of MHz. Interrupts may be off.
#[derive(Clone, Copy, Debug)]
pub struct ClockDelay<const CPU_HZ: u32>;

impl<const CPU_HZ: u32> DelayNs for ClockDelay<CPU_HZ> {
    fn delay_ns(&mut self, nanoseconds: u32) {
        cortex_m::asm::delay(nanoseconds.div_ceil(1000) * (CPU_HZ / 1_000_000));
    }
}
