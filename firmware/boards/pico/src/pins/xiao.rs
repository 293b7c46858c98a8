//! The pins of Seeed's XIAO RP2040: D6 and D7, D4 and D5, the blue LED, and D1, D2, D3, D9 and D0 for buttons.

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
            ($pins.gpio6, $pins.gpio7, $parts.I2C1),
            // No display over SPI.
            (),
            // The board's own LED.
            $pins.gpio25,
            // Up, down, left, right and select.
            ($pins.gpio27, $pins.gpio28, $pins.gpio29, $pins.gpio4, $pins.gpio26),
        )
    };
}
pub(crate) use pins;
