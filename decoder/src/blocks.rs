//! The motion's bytes: blocks with a CRC each, read as if the CRCs were not there.

use crate::bytes::{Varint, unzigzag};
use crate::layout::{BLOCK_BYTES, CRC_BYTES};
use crate::{OpenError, crc};

/// A whole block and its CRC.
pub(crate) const STRIDE: usize = BLOCK_BYTES + CRC_BYTES;

/// The part of a motion that is at hand.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// Blocks with their CRCs, checked.
    pub(crate) bytes: &'a [u8],
    /// Where `bytes` starts, counted from the motion's first byte; a multiple of [`STRIDE`].
    pub(crate) base: u32,
}

impl Input<'_> {
    /// The position after the last payload byte. Where a block's payload ends, this is the first byte of the next block.
    pub(crate) fn end(&self) -> u32 {
        let end = self.base.wrapping_add(self.bytes.len() as u32);
        if end as usize % STRIDE == BLOCK_BYTES { end.wrapping_add(CRC_BYTES as u32) } else { end }
    }

    /// The byte at `position`, which moves on to the next that is no CRC's; zero past the end.
    #[inline]
    pub(crate) fn byte(&self, position: &mut u32) -> u8 {
        let byte = self.bytes.get(position.wrapping_sub(self.base) as usize).copied().unwrap_or(0);
        *position = position.wrapping_add(1);
        // STRIDE is 256: the low byte of a position is its place in the block.
        if *position as usize % STRIDE == BLOCK_BYTES {
            *position = position.wrapping_add(CRC_BYTES as u32);
        }
        byte
    }
}

/// Reads fields of bytes, which may cross from one block into the next.
pub(crate) struct Reader<'i, 'a> {
    pub(crate) input: &'i Input<'a>,
    pub(crate) position: u32,
}

impl Reader<'_, '_> {
    pub(crate) fn byte(&mut self) -> u8 {
        self.input.byte(&mut self.position)
    }

    pub(crate) fn u32(&mut self) -> u32 {
        u32::from_le_bytes([self.byte(), self.byte(), self.byte(), self.byte()])
    }

    /// A [`Varint`]; bits that do not fit are lost.
    #[inline(never)]
    pub(crate) fn varint(&mut self) -> u32 {
        let mut varint = Varint::default();
        while !varint.push(self.byte()) {}
        varint.value
    }

    pub(crate) fn zigzag(&mut self) -> i32 {
        unzigzag(self.varint())
    }
}

/// Whether a block's CRC is right. `seed` is what it continues: [`crc::INITIAL`] but for a motion's or an index's first block.
pub(crate) fn is_intact(block: &[u8], seed: u16) -> bool {
    block.split_last_chunk::<CRC_BYTES>().is_some_and(|(body, stored)| crc::update(seed, body) == u16::from_le_bytes(*stored))
}

/// Checks the CRC of every block, and returns all but the last CRC, and that. `crc` is that of what must not change unseen before them.
#[inline(never)]
pub(crate) fn check(bytes: &[u8], mut crc: u16) -> Result<(&[u8], u16), OpenError> {
    for block in bytes.chunks(STRIDE) {
        if block.len() < CRC_BYTES {
            return Err(OpenError::Truncated);
        }
        if !is_intact(block, crc) {
            return Err(OpenError::BadCrc);
        }
        crc = crc::INITIAL;
    }
    // What a decoder reads past the end is zeros, not the last CRC.
    let (bytes, last) = bytes.split_last_chunk::<CRC_BYTES>().ok_or(OpenError::Malformed)?;
    Ok((bytes, u16::from_le_bytes(*last)))
}
