//! The pins of Pimoroni's Pico Display Pack: an ST7789 of 240x135 pixels and four buttons. Its schematic has the numbers.

/// Data/command and reset of a display over SPI.
#[cfg(feature = "spi")]
pub use crate::rp_hal::gpio::bank0::{Gpio16 as Data, Gpio20 as Reset};
/// The controller of the I2C bus.
#[cfg(not(feature = "spi"))]
pub use crate::rp_hal::pac::I2C0 as I2cPort;

/// The pins, each used once.
macro_rules! pins {
    ($parts:ident, $pins:ident) => {
        (
            // TX and RX.
            ($pins.gpio0, $pins.gpio1),
            // SDA, SCL, and their bus.
            ($pins.gpio4, $pins.gpio5, $parts.I2C0),
            // Chip select, clock, data, data/command, and in place of a reset pin the light: after the pulse of a reset it stays on.
            ($pins.gpio17, $pins.gpio18, $pins.gpio19, $pins.gpio16, $pins.gpio20),
            // The board's own LED.
            $pins.gpio25,
            // X is up, Y is down, B is right, A is select. Left is a free pin.
            ($pins.gpio14, $pins.gpio15, $pins.gpio10, $pins.gpio13, $pins.gpio12),
        )
    };
}
pub(crate) use pins;
