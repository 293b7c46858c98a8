//! A cursor over a model's bytes.

use crate::model::Error;

/// Reads fields from the front of a slice; numbers are little-endian.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    pub fn take(&mut self, len: usize) -> Result<&'a [u8], Error> {
        let (head, rest) = self.0.split_at_checked(len).ok_or(Error::Truncated)?;
        self.0 = rest;
        Ok(head)
    }

    pub fn byte(&mut self) -> Result<u8, Error> {
        self.array().map(|[byte]| byte)
    }

    pub fn short(&mut self) -> Result<u16, Error> {
        self.array().map(u16::from_le_bytes)
    }

    pub fn number(&mut self) -> Result<i16, Error> {
        self.array().map(i16::from_le_bytes)
    }

    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let (head, rest) = self.0.split_first_chunk().ok_or(Error::Truncated)?;
        self.0 = rest;
        Ok(*head)
    }

    /// A vertex's index, of one byte or two.
    pub fn index(&mut self, wide: bool) -> Result<u16, Error> {
        if wide { self.short() } else { self.byte().map(u16::from) }
    }
}

/// Indices of vertices, each of one byte or two.
#[inline(always)]
pub(crate) fn indices(bytes: &[u8], wide: bool) -> impl Iterator<Item = u16> + '_ {
    bytes.chunks_exact(1 << u32::from(wide)).map(|bytes| match *bytes {
        [index] => u16::from(index),
        [low, high] => u16::from_le_bytes([low, high]),
        _ => 0,
    })
}
