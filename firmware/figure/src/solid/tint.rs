//! What parts are made of. `crate::ink` has how each kind of display shows it.

/// How two colours alone show a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// All pixels dark; hair also gets a bright rim.
    Dark,
    /// All pixels bright.
    Bright,
    /// Every other pixel bright, as on a chessboard.
    Checkered,
}

impl Pattern {
    /// The pattern of a number; bright for one without a pattern.
    pub(super) fn of(number: u8) -> Pattern {
        match number {
            0 => Pattern::Dark,
            2 => Pattern::Checkered,
            _ => Pattern::Bright,
        }
    }
}

/// A material, for every kind of display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tint {
    /// Red, green and blue.
    pub rgb: [u8; 3],
    /// Brightness from 0 to 15. Displays of four greys have 0, 5, 10 and 15.
    pub grey: u8,
    /// On displays of two colours.
    pub pattern: Pattern,
}

/// How bright a material is: 256 is its own colour.
pub type Light = u16;

/// Brightness of shaded sides: 0.62 of that of lit ones.
pub(super) const SHADE: u32 = 159;
