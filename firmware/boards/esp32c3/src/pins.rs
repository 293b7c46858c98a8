// The pins, and how clips are stored: what differs from the ESP32-C6.

#[path = "flash.rs"]
mod flash;

use flash::Flash;

/// The pins, each used once.
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
