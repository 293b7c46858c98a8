//! What a name drives.

/// The side or sides of a shape that a weight moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target(u8);

impl Target {
    /// Sides of the shape with index `shape`, 0 to 63: `[stored (left), mirrored (right)]`.
    pub fn new(shape: u8, sides: [bool; 2]) -> Target {
        Target(shape & 0x3f | u8::from(sides[0]) << 6 | u8::from(sides[1]) << 7)
    }

    /// A target as a model stores it.
    pub(crate) fn of_byte(byte: u8) -> Target {
        Target(byte)
    }

    /// Index of the shape.
    #[inline(always)]
    pub fn shape(self) -> usize {
        usize::from(self.0 & 0x3f)
    }

    /// Whether it includes the shape as stored (its left side), and its mirror image (its right side).
    #[inline(always)]
    pub fn sides(self) -> [bool; 2] {
        [self.0 & 0x40 != 0, self.0 & 0x80 != 0]
    }
}
