//! What boards have in common.
#![no_std]

mod buttons;
mod capacity;
#[cfg(feature = "cortex-m")]
pub mod cortex_m;
#[cfg(feature = "emulated")]
mod end;
#[cfg(feature = "update")]
mod inbox;
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
#[cfg(feature = "update")]
mod slots;

pub use buttons::Buttons;
pub use capacity::Capacity;
#[cfg(feature = "update")]
pub use embedded_storage::nor_flash;
#[cfg(feature = "emulated")]
pub use end::{Code, exit};
#[cfg(feature = "update")]
pub use inbox::Inbox;
#[cfg(not(feature = "emulated"))]
pub use last_words::last_words;
pub use markers;
pub use pace::Pace;
#[cfg(feature = "update")]
pub use perform::perform_stored;
pub use perform::{IN_STEP, perform};
#[cfg(feature = "emulated")]
pub use play::play;
#[cfg(all(feature = "emulated", feature = "update"))]
pub use play::play_stored;
pub use register::Register;
#[cfg(feature = "update")]
pub use slots::{Area, Chip, store};

// Linked for what it provides: the log's way out.
#[cfg(feature = "emulated-log")]
use defmt_semihosting as _;
