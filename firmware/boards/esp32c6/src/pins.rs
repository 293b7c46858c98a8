// The pins, and how clips are stored: what differs from the ESP32-C3.

/// No clips are stored.
type Flash = board_common::NoFlash;

/// The pins, each used once.
macro_rules! pins {
    ($parts:ident) => {
        (
            // SDA and SCL.
            ($parts.GPIO6, $parts.GPIO7),
            // TX and RX.
            ($parts.GPIO16, $parts.GPIO17),
            // Up, down, left, right, and select, which is the board's own, BOOT.
            ($parts.GPIO0, $parts.GPIO1, $parts.GPIO2, $parts.GPIO3, $parts.GPIO9),
        )
    };
}
