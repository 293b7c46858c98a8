//! A Cortex-M: faults, stack guard, timer.

mod faults;
mod guard;
mod systick;

pub use guard::guard_stack;
pub use systick::SysTick;

// Linked for what it provides: the log's way out.
use defmt_semihosting as _;
