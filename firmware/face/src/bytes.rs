//! A cursor over a model's bytes.

use crate::error::ModelError;

/// Reads fields from the front of a slice; numbers are little-endian.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    pub fn take(&mut self, len: usize) -> Result<&'a [u8], ModelError> {
        let (head, rest) = self.0.split_at_checked(len).ok_or(ModelError::Truncated)?;
        self.0 = rest;
        Ok(head)
    }

    pub fn u8(&mut self) -> Result<u8, ModelError> {
        self.array().map(|[byte]| byte)
    }

    pub fn u16(&mut self) -> Result<u16, ModelError> {
        self.array().map(u16::from_le_bytes)
    }

    pub fn i16(&mut self) -> Result<i16, ModelError> {
        self.array().map(i16::from_le_bytes)
    }

    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], ModelError> {
        let (head, rest) = self.0.split_first_chunk().ok_or(ModelError::Truncated)?;
        self.0 = rest;
        Ok(*head)
    }

    /// Reads the index of a vertex, two bytes where `wide`, else one, and a byte after it. For bytes that are checked already: an option takes far
    /// fewer instructions than a result.
    #[inline(always)]
    pub fn index_and_byte(&mut self, wide: bool) -> Option<(u16, u8)> {
        let (index, byte, rest) = match *self.0 {
            [index, byte, ref rest @ ..] if !wide => (u16::from(index), byte, rest),
            [low, high, byte, ref rest @ ..] => (u16::from_le_bytes([low, high]), byte, rest),
            _ => return None,
        };
        self.0 = rest;
        Some((index, byte))
    }

    /// Like [`Bytes::take`], for bytes that are checked already.
    #[inline(always)]
    pub fn next(&mut self, len: usize) -> Option<&'a [u8]> {
        let (head, rest) = self.0.split_at_checked(len)?;
        self.0 = rest;
        Some(head)
    }

    /// Reads the index of a vertex: two bytes where `wide`, else one.
    pub fn index(&mut self, wide: bool) -> Result<u16, ModelError> {
        if wide { self.u16() } else { self.u8().map(u16::from) }
    }
}

/// Walks indices of vertices: two bytes each where `wide`, else one.
#[inline(always)]
pub(crate) fn indices(bytes: &[u8], wide: bool) -> impl Iterator<Item = u16> + '_ {
    bytes.chunks_exact(1 << u32::from(wide)).map(|bytes| match *bytes {
        [index] => u16::from(index),
        [low, high] => u16::from_le_bytes([low, high]),
        _ => 0,
    })
}

/// Like [`indices`], with no choice for each of them where they take one byte.
#[inline(always)]
pub(crate) fn each_index(bytes: &[u8], wide: bool, mut visit: impl FnMut(u16)) {
    if wide {
        indices(bytes, true).for_each(visit);
    } else {
        bytes.iter().for_each(|&index| visit(u16::from(index)));
    }
}
