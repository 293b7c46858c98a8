//! The flash that holds one clip.

use crate::BLOCK_BYTES;
use embedded_storage::nor_flash::NorFlash;
use pantin::{Clip, OpenError};

/// Flash for one clip, which the processor reads as memory. Offsets count from its start.
///
/// Two slots are two values, even if one controller writes both: a clip that plays from one slot stays borrowed while the other slot is written.
pub trait Slot: NorFlash {
    /// Returns the current contents: whole sectors.
    fn bytes(&self) -> &[u8];
}

/// Refuses flash at compile time whose words or sectors do not fit the blocks.
pub(crate) const fn fits<S: Slot>() {
    assert!(BLOCK_BYTES.is_multiple_of(S::WRITE_SIZE), "a block must be complete words of the flash");
    assert!(S::ERASE_SIZE.is_multiple_of(BLOCK_BYTES), "a sector of the flash must be complete blocks");
}

/// Returns the clip in a slot's bytes, or `None` if `length` exceeds the slot.
pub(crate) fn clip(slot: &[u8], length: u32) -> Option<&[u8]> {
    slot.get(BLOCK_BYTES..)?.get(..length as usize)
}

/// Checks that the decoder can open a file: a clip with its rig, or with the feature `bank` a bank and all of its clips.
pub(crate) fn check(file: &[u8]) -> Result<(), OpenError> {
    #[cfg(feature = "bank")]
    if let Ok(bank) = pantin::Bank::new_checked(file) {
        return bank.entries().try_for_each(|entry| bank.open(&entry).map(drop));
    }
    Clip::new_checked(file).map(drop)
}
