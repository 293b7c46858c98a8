//! Constants of the format (MODEL.md).

/// The only version of the format.
pub const VERSION: u8 = 1;
/// Flag: indices of vertices take two bytes.
pub const WIDE: u8 = 1;
/// Maximum number of shapes of a model.
pub const SHAPES: usize = 48;
/// Stands for no shape.
pub const NO_SHAPE: u8 = 0xff;
/// Length of an entry of the name table in bytes.
pub const NAME_LEN: usize = 7;
