//! Flash that holds a clip.

use crate::BLOCK_BYTES;
use embedded_storage::nor_flash::NorFlash;

/// Flash for one clip, which the processor reads as memory. Offsets count from its beginning.
///
/// Two slots are two values, even where one controller writes both: so a clip that plays from one is borrowed, and cannot be
/// written over, while the other is written.
pub trait Slot: NorFlash {
    /// All its bytes, complete sectors, as they are now.
    fn bytes(&self) -> &[u8];
}

/// Refuses at compile time flash that blocks do not fit.
pub(crate) const fn fits<S: Slot>() {
    assert!(BLOCK_BYTES.is_multiple_of(S::WRITE_SIZE), "a block must be complete words of the flash");
    assert!(S::ERASE_SIZE.is_multiple_of(BLOCK_BYTES), "a sector of the flash must be complete blocks");
}

/// A clip's bytes in a slot's: none if they are not all there.
pub(crate) fn clip(slot: &[u8], length: u32) -> Option<&[u8]> {
    slot.get(BLOCK_BYTES..)?.get(..length as usize)
}
