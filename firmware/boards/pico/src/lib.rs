//! Pantin on the Raspberry Pi Pico: what its programs share.
#![no_std]

mod board;
mod boot;
mod clocks;
mod display;
#[cfg(feature = "update")]
mod flash;
mod panic;
#[cfg(feature = "update")]
mod received;

pub use board::Pico;
pub use clocks::{RATE, start};
pub use display::Lit;
#[cfg(feature = "update")]
pub use flash::Rom;

#[cfg(feature = "defmt")]
use defmt_rtt as _;
