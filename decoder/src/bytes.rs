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

    /// LEB128: seven bits a byte, least significant first, at most five bytes.
    #[inline(never)]
    pub fn varint(&mut self) -> Result<u32, OpenError> {
        let (mut value, mut shift) = (0u32, 0);
        loop {
            let byte = self.byte()?;
            // The fifth byte is the last, with four bits.
            if shift == 28 && byte > 0xf {
                return Err(OpenError::Malformed);
            }
            value |= u32::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
            shift += 7;
        }
    }

    /// A varint that holds a signed number as 0, -1, 1, -2, ...
    pub fn zigzag(&mut self) -> Result<i32, OpenError> {
        let n = self.varint()?;
        Ok(((n >> 1) as i32) ^ -((n & 1) as i32))
    }

    /// A length in a varint, then that many bytes.
    pub fn name(&mut self) -> Result<&'a [u8], OpenError> {
        let len = self.varint()? as usize;
        self.take(len)
    }
}
