//! Two slots for clips in the flash that the memory map keeps for them.
#![allow(unsafe_code)]

use core::marker::PhantomData;
use core::sync::atomic::{AtomicBool, Ordering};
use core::{ptr, slice};
use embedded_storage::nor_flash::{self, ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use pantin_store::{Slot, Store};

/// What erases and writes a board's flash. Addresses are those at which the processor reads it.
pub trait Chip {
    /// Bytes that are erased at once.
    const SECTOR: usize;
    /// Bytes that are written at once.
    const WORD: usize;

    /// Erases the sector at an address.
    ///
    /// # Safety
    /// The sector is a slot's, whole, and nothing borrows its bytes.
    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind>;

    /// Writes whole words at an address.
    ///
    /// # Safety
    /// They lie in a slot, and nothing borrows its bytes.
    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind>;
}

/// A slot: nothing else reads or writes its flash.
#[derive(Debug)]
pub struct Area<C> {
    address: usize,
    len: usize,
    chip: PhantomData<C>,
}

/// The store of both slots, which the memory map has between `_clips_start` and `_clips_end`; once.
pub fn store<C: Chip>() -> Option<Store<Area<C>>> {
    unsafe extern "C" {
        static _clips_start: u8;
        static _clips_end: u8;
    }
    static TAKEN: AtomicBool = AtomicBool::new(false);
    // Nothing interrupts this that would call it.
    if TAKEN.load(Ordering::Relaxed) {
        return None;
    }
    TAKEN.store(true, Ordering::Relaxed);
    let (start, end) = ((&raw const _clips_start).addr(), (&raw const _clips_end).addr());
    let len = (end - start) / 2;
    Some(Store::new([start, start + len].map(|address| Area { address, len, chip: PhantomData })))
}

impl<C> ErrorType for Area<C> {
    type Error = NorFlashErrorKind;
}

impl<C: Chip> ReadNorFlash for Area<C> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        nor_flash::check_read(self, offset, bytes.len())?;
        bytes.iter_mut().zip(self.bytes().iter().skip(offset as usize)).for_each(|(to, from)| *to = *from);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.len
    }
}

impl<C: Chip> NorFlash for Area<C> {
    const WRITE_SIZE: usize = C::WORD;
    const ERASE_SIZE: usize = C::SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        nor_flash::check_erase(self, from, to)?;
        for sector in (from..to).step_by(C::SECTOR) {
            // Safety: a sector of this slot, as was checked, which is borrowed mutably.
            unsafe { C::erase(self.address + sector as usize)? };
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        nor_flash::check_write(self, offset, bytes.len())?;
        // Safety: words of this slot, as was checked, which is borrowed mutably.
        unsafe { C::write(self.address + offset as usize, bytes) }
    }
}

impl<C: Chip> Slot for Area<C> {
    fn bytes(&self) -> &[u8] {
        // Safety: flash that the memory map keeps for this slot alone: it changes by `write` and `erase` only, which borrow the slot mutably.
        unsafe { slice::from_raw_parts(ptr::with_exposed_provenance(self.address), self.len) }
    }
}
