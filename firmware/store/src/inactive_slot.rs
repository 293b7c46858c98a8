//! The slot that does not play: where the next clip comes.

use crate::BLOCK_BYTES;
use crate::header::{ClipInfo, Header, crc_32};
use crate::message::Refusal;
use crate::slot::{self, Slot};
use pantin::Clip;

/// The slot that does not play. Once [`seal`](InactiveSlot::seal) went well, its clip is the newest of the store.
#[derive(Debug)]
pub struct InactiveSlot<'a, S> {
    slot: &'a mut S,
    sequence: u32,
}

impl<'a, S: Slot> InactiveSlot<'a, S> {
    pub(crate) fn new(slot: &'a mut S, sequence: u32) -> Self {
        InactiveSlot { slot, sequence }
    }

    /// Most bytes of a clip.
    pub fn capacity(&self) -> u32 {
        u32::try_from(self.slot.bytes().len().saturating_sub(BLOCK_BYTES)).unwrap_or(u32::MAX)
    }

    /// Makes ready for a clip: from now on the slot holds none.
    pub fn begin(&mut self, info: &ClipInfo) -> Result<(), Refusal> {
        if info.length > self.capacity() {
            return Err(Refusal::TooLong { capacity: self.capacity() });
        }
        // The header's sector first: none of the old clip's bytes may go before it.
        self.slot.erase(0, S::ERASE_SIZE as u32).or(Err(Refusal::Flash))
    }

    /// Writes bytes of the clip: up to [`BLOCK_BYTES`] from an offset into the clip that is a multiple of it, in order. A sector is erased
    /// when the first of its blocks is written.
    pub fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Refusal> {
        let at = offset.checked_add(BLOCK_BYTES as u32).ok_or(Refusal::Flash)?;
        if at % S::ERASE_SIZE as u32 == 0 {
            self.slot.erase(at, at.saturating_add(S::ERASE_SIZE as u32)).or(Err(Refusal::Flash))?;
        }
        self.write_words(at, bytes)
    }

    /// Writes complete words, the last filled up as if erased.
    fn write_words(&mut self, at: u32, bytes: &[u8]) -> Result<(), Refusal> {
        let mut block = [0xff; BLOCK_BYTES];
        let len = bytes.len().next_multiple_of(S::WRITE_SIZE);
        let block = block.get_mut(..len).ok_or(Refusal::Flash)?;
        block.iter_mut().zip(bytes).for_each(|(place, &byte)| *place = byte);
        self.slot.write(at, block).or(Err(Refusal::Flash))
    }

    /// The clip as it stands in the flash, if it is what was claimed and can be opened.
    pub fn check(&self, info: &ClipInfo) -> Result<&[u8], Refusal> {
        let bytes = slot::clip(self.slot.bytes(), info.length).ok_or(Refusal::BadCrc)?;
        if crc_32(bytes) != info.crc {
            return Err(Refusal::BadCrc);
        }
        Clip::new_checked(bytes).map(|_| bytes).map_err(Refusal::Clip)
    }

    /// Checks the clip and writes its header: it is the newest from the moment that the header's last word is written.
    pub fn seal(&mut self, info: &ClipInfo) -> Result<(), Refusal> {
        self.check(info)?;
        let header = Header { info: *info, sequence: self.sequence };
        self.write_words(0, &header.bytes())?;
        match Header::read(self.slot.bytes()) {
            Some(written) if written == header => Ok(()),
            _ => Err(Refusal::Flash),
        }
    }
}
