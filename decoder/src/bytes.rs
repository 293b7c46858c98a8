//! A cursor over checked bytes: variable-length integers and names.

use crate::OpenError;

/// Reads fields from the front of a slice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    pub fn byte(&mut self) -> Result<u8, OpenError> {
        let (&first, rest) = self.0.split_first().ok_or(OpenError::Truncated)?;
        self.0 = rest;
        Ok(first)
    }

    pub fn take(&mut self, len: usize) -> Result<&'a [u8], OpenError> {
        let (head, rest) = self.0.split_at_checked(len).ok_or(OpenError::Truncated)?;
        self.0 = rest;
        Ok(head)
    }

    /// A [`Varint`].
    #[inline(never)]
    pub fn varint(&mut self) -> Result<u32, OpenError> {
        let mut varint = Varint::default();
        while !varint.push(self.byte()?) {}
        varint.checked()
    }

    /// A varint that holds a signed number as 0, -1, 1, -2, ...
    pub fn zigzag(&mut self) -> Result<i32, OpenError> {
        Ok(unzigzag(self.varint()?))
    }

    /// A length in a varint, then that many bytes.
    pub fn name(&mut self) -> Result<&'a [u8], OpenError> {
        let len = self.varint()? as usize;
        self.take(len)
    }
}

/// 0, 1, 2, 3, ... as 0, -1, 1, -2, ...
pub(crate) const fn unzigzag(n: u32) -> i32 {
    (n >> 1) as i32 ^ -((n & 1) as i32)
}

/// A number that arrives byte by byte. LEB128: seven bits a byte, least significant first, at most five bytes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Varint {
    /// What has arrived; bits that do not fit are lost.
    pub value: u32,
    shift: u8,
    too_large: bool,
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

    /// The number, if it fits 32 bits.
    pub fn checked(&self) -> Result<u32, OpenError> {
        if self.too_large { Err(OpenError::Malformed) } else { Ok(self.value) }
    }
}
