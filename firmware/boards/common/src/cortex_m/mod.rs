//! A Cortex-M: faults, stack guard, timer.

mod faults;
mod guard;
mod systick;

pub use guard::guard_stack;
pub use systick::SysTick;
