//! A Cortex-M: faults, stack guard, timer.

mod faults;
mod guard;
#[cfg(feature = "emulated-cortex-m")]
mod panics;
mod systick;

pub use guard::guard_stack;
pub use systick::SysTick;

// Linked for what it provides: the log's way out.
#[cfg(feature = "emulated-cortex-m")]
use defmt_semihosting as _;
