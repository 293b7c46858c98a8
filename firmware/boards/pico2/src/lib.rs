//! Pantin on the Raspberry Pi Pico 2. Pins and peripherals are those of the Pico, and so are most of its modules.
#![no_std]

#[path = "../../pico/src/board.rs"]
pub mod board;
mod boot;
#[path = "../../pico/src/clocks.rs"]
pub mod clocks;
#[cfg(not(feature = "spi"))]
#[path = "../../pico/src/i2c.rs"]
mod i2c;
#[path = "../../pico/src/panic.rs"]
mod panic;
#[cfg_attr(not(feature = "pins-display-pack"), path = "../../pico/src/pins.rs")]
#[cfg_attr(feature = "pins-display-pack", path = "../../pico/src/pins/display_pack.rs")]
mod pins;
#[cfg(feature = "spi")]
#[path = "../../pico/src/spi_display.rs"]
mod spi_display;
#[cfg(feature = "buffered")]
#[path = "../../pico/src/uart_rx.rs"]
mod uart_rx;
#[cfg(feature = "usb")]
#[path = "../../pico/src/usb.rs"]
mod usb;

use rp235x_hal as rp_hal;

/// The clock of the processor and the peripherals.
pub const CPU_HZ: u32 = 150_000_000;
/// The clock of a display over SPI is a quarter of it: half of it, 75 MHz, is above the displays' limit.
#[cfg(feature = "spi")]
const SPI_DIVIDER: u32 = 4;
/// The PC's name for the board.
#[cfg(feature = "usb")]
const PRODUCT: &str = "Pantin on the Raspberry Pi Pico 2";

/// Peripherals that have other names on the RP2040.
#[cfg(feature = "usb")]
mod chip {
    pub use rp235x_hal::pac::{RESETS, TIMER0 as TIMER, USB, USB_DPRAM};

    /// Starts the counter of microseconds.
    pub fn start_timer(resets: &mut RESETS) {
        resets.reset().modify(|_, w| w.timer0().clear_bit());
    }
}
