//! The pins of Seeed's XIAO nRF52840, with or without "Sense".

/// The pins, each used once.
macro_rules! pins {
    ($p0:ident, $p1:ident) => {
        (
            // TX and RX: D6 and D7.
            ($p1.p1_11, $p1.p1_12),
            // Buttons: D0 and D1.
            ($p0.p0_02, $p0.p0_03),
            // SCL and SDA: D5 and D4.
            ($p0.p0_05, $p0.p0_04),
            // The board's red LED.
            $p0.p0_26,
        )
    };
}
pub(crate) use pins;
