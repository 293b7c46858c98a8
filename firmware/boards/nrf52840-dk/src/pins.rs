//! The pins of the nRF52840 DK. A feature `pins-...` puts another table in the place of this one.

/// The pins, each used once.
macro_rules! pins {
    ($p0:ident, $p1:ident) => {
        (
            // TX and RX.
            ($p0.p0_06, $p0.p0_08),
            // The board's Button 1 and Button 2.
            ($p0.p0_11, $p0.p0_12),
            // SCL and SDA.
            ($p0.p0_27, $p0.p0_26),
            // The board's LED 1.
            $p0.p0_13,
        )
    };
}
pub(crate) use pins;
