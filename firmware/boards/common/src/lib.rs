//! What boards have in common.
#![no_std]

mod buttons;
#[cfg(feature = "cortex-m")]
pub mod cortex_m;
#[cfg(feature = "emulated")]
mod end;
// The emulated boards' panics end the emulator; one of them has no atomic memory access.
#[cfg(not(feature = "emulated"))]
mod last_words;
mod pace;
#[cfg(feature = "emulated-log")]
mod panics;
mod perform;
#[cfg(feature = "emulated")]
mod play;
mod register;
mod room;

pub use buttons::Buttons;
#[cfg(feature = "emulated")]
pub use end::{Code, exit};
#[cfg(not(feature = "emulated"))]
pub use last_words::last_words;
pub use markers;
pub use pace::Pace;
pub use perform::{IN_STEP, perform};
#[cfg(feature = "emulated")]
pub use play::play;
#[cfg(all(feature = "emulated", feature = "update"))]
pub use play::play_stored;
pub use register::Register;
pub use room::fitted;

// Linked for what it provides: the log's way out.
#[cfg(feature = "emulated-log")]
use defmt_semihosting as _;
