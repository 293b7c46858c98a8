//! The pins of Adafruit's Feather RP2040: its STEMMA QT (Qwiic) connector, the LED D13, and D24, D25, D5, D6 and D9 for buttons.

/// The controller of the I2C bus.
#[cfg(not(feature = "spi"))]
pub use crate::rp_hal::pac::I2C1 as I2cPort;

/// The pins, each used once.
macro_rules! pins {
    ($parts:ident, $pins:ident) => {
        (
            // TX and RX.
            ($pins.gpio0, $pins.gpio1),
            // SDA, SCL, and their bus.
            ($pins.gpio2, $pins.gpio3, $parts.I2C1),
            // No display over SPI.
            (),
            // The board's own LED.
            $pins.gpio13,
            // Up, down, left, right and select.
            ($pins.gpio24, $pins.gpio25, $pins.gpio7, $pins.gpio8, $pins.gpio9),
        )
    };
}
pub(crate) use pins;
