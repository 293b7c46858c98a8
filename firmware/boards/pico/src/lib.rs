//! Pantin on the Raspberry Pi Pico: what its programs share.
#![no_std]

pub mod board;
mod boot;
pub mod clocks;
pub mod flash;
#[cfg(not(feature = "st7789"))]
mod i2c;
mod panic;
#[cfg(feature = "st7789")]
mod st7789;
#[cfg(feature = "update")]
mod uart_rx;
