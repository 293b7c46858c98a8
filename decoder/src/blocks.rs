//! The motion's bytes: blocks with a CRC each, read as if the CRCs were not there.

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
    /// The byte at `position`, which moves on to the next that is no CRC's; zero past the end.
    #[inline]
    pub(crate) fn byte(&self, position: &mut u32) -> u8 {
        let byte = self.bytes.get(position.wrapping_sub(self.base) as usize).copied().unwrap_or(0);
        *position += 1;
        // STRIDE is 256: the low byte of a position is its place in the block.
        if *position as usize % STRIDE == BLOCK_BYTES {
            *position += CRC_BYTES as u32;
        }
        byte
    }
}

/// Checks the CRC of every block. `seed` is the CRC of what stands before the motion and must not change unseen.
pub(crate) fn check(bytes: &[u8], seed: u16) -> Result<(), OpenError> {
    let mut crc = seed;
    for block in bytes.chunks(STRIDE) {
        let (body, stored) = block.split_last_chunk::<CRC_BYTES>().ok_or(OpenError::Truncated)?;
        if crc::update(crc, body) != u16::from_le_bytes(*stored) {
            return Err(OpenError::BadCrc);
        }
        crc = crc::INITIAL;
    }
    Ok(())
}
