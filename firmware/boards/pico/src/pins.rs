//! The pins of a board without another board on it. A feature `pins-...` puts another table in the place of this one.

/// Data/command and reset of a display over SPI.
#[cfg(feature = "spi")]
pub use crate::rp_hal::gpio::bank0::{Gpio20 as Data, Gpio21 as Reset};
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
            // Chip select, clock, data, data/command and reset of a display over SPI.
            ($pins.gpio17, $pins.gpio18, $pins.gpio19, $pins.gpio20, $pins.gpio21),
            // The board's own LED.
            $pins.gpio25,
            // Up, down, left, right and select.
            ($pins.gpio10, $pins.gpio11, $pins.gpio12, $pins.gpio13, $pins.gpio14),
        )
    };
}
pub(crate) use pins;
