// The pins, and how clips are stored: what differs from the ESP32-C6.

#[path = "flash.rs"]
mod flash;

use flash::Flash;

/// The pins of boards with all pins, and of the one with an OLED of 72x40 pixels, each used once.
#[cfg(not(feature = "pins-xiao"))]
macro_rules! pins {
    ($parts:ident) => {
        (
            // SDA and SCL.
            ($parts.GPIO5, $parts.GPIO6),
            // TX and RX.
            ($parts.GPIO21, $parts.GPIO20),
            // Up, down, left, right, and select, which is the board's own, BOOT.
            ($parts.GPIO0, $parts.GPIO1, $parts.GPIO3, $parts.GPIO4, $parts.GPIO9),
        )
    };
}
/// Those of Seeed's XIAO ESP32C3.
#[cfg(feature = "pins-xiao")]
macro_rules! pins {
    ($parts:ident) => {
        (
            // SDA and SCL: D4 and D5.
            ($parts.GPIO6, $parts.GPIO7),
            // TX and RX: D6 and D7.
            ($parts.GPIO21, $parts.GPIO20),
            // Up, down, left and right: D1, D2, D3 and D10. Select is the board's own, BOOT.
            ($parts.GPIO3, $parts.GPIO4, $parts.GPIO5, $parts.GPIO10, $parts.GPIO9),
        )
    };
}
