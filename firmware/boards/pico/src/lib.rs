//! Pantin on the Raspberry Pi Pico: what its programs share.
#![no_std]

mod board;
mod boot;
mod clocks;
mod display;
mod panic;

pub use board::Pico;
pub use clocks::{CLOCK, RATE, start};
pub use display::Lit;

#[cfg(feature = "defmt")]
use defmt_rtt as _;
