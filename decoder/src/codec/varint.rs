//! LEB128, how the format writes numbers: seven bits a byte, the least significant first, at most five bytes.

use crate::OpenError;

/// A number that arrives byte by byte.
#[derive(Clone, Copy, Debug, Default)]
pub struct Varint {
    /// What the bytes so far say. A number that does not fit 32 bits loses its highest bits.
    pub value: u32,
    shift: u8,
    pub(crate) too_large: bool,
}

impl Varint {
    /// Takes the next byte, and returns whether it was the last.
    #[inline(always)]
    pub fn push(&mut self, byte: u8) -> bool {
        // The fifth byte is the last, with four bits.
        self.too_large = self.shift == 28 && byte > 0xf;
        self.value |= u32::from(byte & 0x7f) << self.shift;
        self.shift += 7;
        byte & 0x80 == 0 || self.shift > 28
    }

    /// The number; [`OpenError::Malformed`] if it does not fit 32 bits.
    pub fn checked(&self) -> Result<u32, OpenError> {
        if self.too_large { Err(OpenError::Malformed) } else { Ok(self.value) }
    }
}

/// Reads a number from the start of bytes, and returns it with the number of bytes that it takes. Bits beyond 32 are left out. `None` if it
/// is cut short.
pub fn get(bytes: &[u8]) -> Option<(u32, usize)> {
    let mut varint = Varint::default();
    let last = bytes.iter().position(|&byte| varint.push(byte))?;
    Some((varint.value, last + 1))
}

/// Writes a number, a byte at a time.
pub fn put(mut value: u32, put: &mut dyn FnMut(u8)) {
    while value >= 0x80 {
        put(value as u8 | 0x80);
        value >>= 7;
    }
    put(value as u8);
}

/// Writes a signed number as 0, -1, 1, -2, ...
pub fn put_zigzag(value: i32, put_byte: &mut dyn FnMut(u8)) {
    put((value << 1 ^ value >> 31) as u32, put_byte);
}
