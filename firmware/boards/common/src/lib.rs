//! What boards have in common.
#![no_std]

#[cfg(feature = "cortex-m")]
pub mod cortex_m;
mod end;
mod pace;
mod play;
mod register;

pub use end::{Code, exit};
pub use markers;
pub use pace::Pace;
pub use play::play;
#[cfg(feature = "update")]
pub use play::play_stored;
pub use register::Register;
