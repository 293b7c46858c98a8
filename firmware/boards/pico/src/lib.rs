//! Pantin on the Raspberry Pi Pico: what its programs share.
#![no_std]

pub mod board;
mod boot;
pub mod clocks;
pub mod flash;
#[cfg(not(feature = "spi"))]
mod i2c;
mod panic;
#[cfg(feature = "spi")]
mod spi_display;
#[cfg(feature = "buffered")]
mod uart_rx;
#[cfg(feature = "usb")]
mod usb;
