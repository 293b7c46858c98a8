//! The motion's bytes: blocks with a CRC each, read as if the CRCs were not there.

use crate::layout::{BLOCK_BYTES, CRC_BYTES};
use crate::{OpenError, crc};

/// A whole block and its CRC.
pub(crate) const STRIDE: usize = BLOCK_BYTES + CRC_BYTES;

/// The part of a motion that is at hand: checked blocks with their CRCs. Positions count from its first byte, which is a block's first.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a>(pub(crate) &'a [u8]);

impl Input<'_> {
    /// The byte at `position`, which moves on to the next that is no CRC's; zero past the end.
    #[inline(always)]
    pub(crate) fn byte(&self, position: &mut u32) -> u8 {
        let byte = self.0.get(*position as usize).copied().unwrap_or(0);
        *position = behind_crc(position.wrapping_add(1));
        byte
    }
}

/// A position, or that of the next block if a CRC stands there.
#[inline(always)]
pub(crate) fn behind_crc(position: u32) -> u32 {
    // STRIDE is 256: the low byte of a position is its place in the block.
    if position as usize % STRIDE == BLOCK_BYTES { position.wrapping_add(CRC_BYTES as u32) } else { position }
}

/// Whether a block's CRC is right. `seed` is what it continues: [`crc::INITIAL`] but for a motion's or an index's first block.
#[inline(never)]
pub(crate) fn is_intact(block: &[u8], seed: u16) -> bool {
    block.split_last_chunk::<CRC_BYTES>().is_some_and(|(body, stored)| crc::update(seed, body) == u16::from_le_bytes(*stored))
}

/// Checks the CRC of every block; `seed` is what that of the first continues.
#[inline(never)]
pub(crate) fn check(bytes: &[u8], mut seed: u16) -> Result<(), OpenError> {
    for block in bytes.chunks(STRIDE) {
        if !is_intact(block, seed) {
            return Err(if block.len() < CRC_BYTES { OpenError::Truncated } else { OpenError::BadCrc });
        }
        seed = crc::INITIAL;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_without_room_for_its_crc_is_truncated() {
        assert_eq!(check(&[], crc::INITIAL), Ok(()));
        assert_eq!(check(&[1], crc::INITIAL), Err(OpenError::Truncated));
        assert_eq!(check(&[1, 2], crc::INITIAL), Err(OpenError::BadCrc));
        assert_eq!(check(&[1, 2, 3], crc::INITIAL), Err(OpenError::BadCrc));
    }
}
