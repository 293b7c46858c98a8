//! Pantin on the Raspberry Pi Pico: what its programs share.
#![no_std]

pub mod board;
mod boot;
pub mod clocks;
pub mod flash;
#[cfg(not(feature = "spi"))]
mod i2c;
mod panic;
#[cfg_attr(feature = "pins-display-pack", path = "pins/display_pack.rs")]
#[cfg_attr(feature = "pins-feather", path = "pins/feather.rs")]
#[cfg_attr(feature = "pins-xiao", path = "pins/xiao.rs")]
mod pins;
mod refusal;
#[cfg(feature = "spi")]
mod spi_display;
#[cfg(feature = "buffered")]
mod uart_rx;
#[cfg(feature = "usb")]
mod usb;

pub use refusal::refuse;
use rp2040_hal as rp_hal;

/// The clock of the processor and the peripherals.
pub const CPU_HZ: u32 = 125_000_000;
/// The clock of a display over SPI is a quarter of it, which jumper wires carry. With the feature `fast` it is half of it, 62.5 MHz, the displays' limit.
#[cfg(feature = "spi")]
const SPI_DIVIDER: u32 = if cfg!(feature = "fast") { 2 } else { 4 };
/// The PC's name for the board.
#[cfg(feature = "usb")]
const PRODUCT: &str = "Pantin on the Raspberry Pi Pico";

/// Peripherals that have other names on the RP2350.
#[cfg(feature = "usb")]
mod chip {
    pub use rp2040_hal::pac::{RESETS, TIMER, USBCTRL_DPRAM as USB_DPRAM, USBCTRL_REGS as USB};

    /// Starts the counter of microseconds.
    pub fn start_timer(resets: &mut RESETS) {
        resets.reset().modify(|_, w| w.timer().clear_bit());
    }
}
