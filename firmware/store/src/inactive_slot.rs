//! The slot that does not play, to which the next clip is written.

use crate::BLOCK_BYTES;
use crate::header::{ClipInfo, Header, crc_32};
use crate::message::Refusal;
use crate::slot::{self, Slot};

/// The slot that does not play. Once [`seal`](InactiveSlot::seal) has succeeded, its clip is the newest of the store.
#[derive(Debug)]
pub struct InactiveSlot<'a, S> {
    slot: &'a mut S,
    /// The sequence number for the next header.
    sequence: u32,
}

impl<'a, S: Slot> InactiveSlot<'a, S> {
    pub(crate) fn new(slot: &'a mut S, sequence: u32) -> Self {
        InactiveSlot { slot, sequence }
    }

    /// Returns the size in bytes of the longest clip that fits.
    pub fn capacity(&self) -> u32 {
        u32::try_from(self.slot.bytes().len().saturating_sub(BLOCK_BYTES)).unwrap_or(u32::MAX)
    }

    /// Returns [`Refusal::TooLong`] if the clip does not fit. Changes nothing in the flash.
    pub fn begin(&self, info: &ClipInfo) -> Result<(), Refusal> {
        let capacity = self.capacity();
        if info.length > capacity { Err(Refusal::TooLong { capacity }) } else { Ok(()) }
    }

    /// Writes bytes of the clip: at most [`BLOCK_BYTES`], from an `offset` into the clip that is a multiple of it, in ascending order. A sector is
    /// erased when its first block is written; the first write also erases the header, and from then on the slot holds no clip.
    ///
    /// Returns [`Refusal::Flash`] if the flash fails.
    pub fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Refusal> {
        let sector = S::ERASE_SIZE as u32;
        if offset == 0 {
            // The header goes first: it must not outlive a byte of its clip.
            self.slot.erase(0, sector).or(Err(Refusal::Flash))?;
        }
        let at = offset.checked_add(BLOCK_BYTES as u32).ok_or(Refusal::Flash)?;
        if at % sector == 0 {
            self.slot.erase(at, at.saturating_add(sector)).or(Err(Refusal::Flash))?;
        }
        self.write_words(at, bytes)
    }

    /// Writes `bytes`, and fills the last word with ones.
    fn write_words(&mut self, at: u32, bytes: &[u8]) -> Result<(), Refusal> {
        let mut block = [0xff; BLOCK_BYTES];
        let len = bytes.len().next_multiple_of(S::WRITE_SIZE);
        let block = block.get_mut(..len).ok_or(Refusal::Flash)?;
        block.iter_mut().zip(bytes).for_each(|(place, &byte)| *place = byte);
        self.slot.write(at, block).or(Err(Refusal::Flash))
    }

    /// Returns the clip as it is in the flash. Returns [`Refusal::BadCrc`] if its bytes are not those of `info`, and [`Refusal::Clip`] if the decoder
    /// cannot open it.
    pub fn check(&self, info: &ClipInfo) -> Result<&[u8], Refusal> {
        let bytes = slot::clip(self.slot.bytes(), info.length).ok_or(Refusal::BadCrc)?;
        if crc_32(bytes) != info.crc {
            return Err(Refusal::BadCrc);
        }
        slot::check(bytes).map(|()| bytes).map_err(Refusal::Clip)
    }

    /// Checks the clip and writes its header: the clip is the newest from the moment that the header's last word is written.
    ///
    /// Returns the errors of [`check`](InactiveSlot::check), or [`Refusal::Flash`] if the header cannot be read back.
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
