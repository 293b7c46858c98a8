//! A board's flash, with two slots for clips in the part that the memory map reserves for them.

use embedded_storage::nor_flash::NorFlashErrorKind;

/// The driver that erases and writes a board's flash. Addresses are those at which the processor reads it.
pub trait Flash {
    /// The bytes that are erased at once.
    const ERASE_BYTES: usize;
    /// The bytes that are written at once.
    const WRITE_BYTES: usize;

    /// Prepares the flash, once, before it is read.
    fn start() {}

    /// Erases the sector at an address.
    ///
    /// # Safety
    /// The sector lies in a slot, and nothing borrows its bytes.
    #[allow(unsafe_code)]
    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind>;

    /// Writes whole words at an address.
    ///
    /// # Safety
    /// The words lie in a slot, and nothing borrows their bytes.
    #[allow(unsafe_code)]
    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind>;
}

/// The flash of a board that stores no clips.
#[derive(Clone, Copy, Debug)]
pub struct NoFlash;

#[allow(unsafe_code)]
impl Flash for NoFlash {
    const ERASE_BYTES: usize = 1;
    const WRITE_BYTES: usize = 1;

    unsafe fn erase(_: usize) -> Result<(), NorFlashErrorKind> {
        Err(NorFlashErrorKind::Other)
    }

    unsafe fn write(_: usize, _: &[u8]) -> Result<(), NorFlashErrorKind> {
        Err(NorFlashErrorKind::Other)
    }
}

#[cfg(feature = "update")]
pub(crate) use slots::store;

#[cfg(feature = "update")]
#[allow(unsafe_code)]
mod slots {
    use super::{Flash, NorFlashErrorKind};
    use core::marker::PhantomData;
    use core::sync::atomic::{AtomicBool, Ordering};
    use core::{ptr, slice};
    use embedded_storage::nor_flash::{self, ErrorType, NorFlash, ReadNorFlash};
    use pantin_store::{Slot, Store};

    /// A slot, whose bytes nothing else reads or writes.
    #[derive(Debug)]
    pub struct FlashSlot<F> {
        address: usize,
        len: usize,
        flash: PhantomData<F>,
    }

    /// Returns the store of both slots, which the memory map places between `_clips_start` and `_clips_end`, once.
    pub fn store<F: Flash>() -> Option<Store<FlashSlot<F>>> {
        unsafe extern "C" {
            static _clips_start: u8;
            static _clips_end: u8;
        }
        static TAKEN: AtomicBool = AtomicBool::new(false);
        // No interrupt handler calls this.
        if TAKEN.load(Ordering::Relaxed) {
            return None;
        }
        TAKEN.store(true, Ordering::Relaxed);
        F::start();
        let (start, end) = ((&raw const _clips_start).addr(), (&raw const _clips_end).addr());
        let len = (end - start) / 2;
        Some(Store::new([start, start + len].map(|address| FlashSlot { address, len, flash: PhantomData })))
    }

    impl<F> ErrorType for FlashSlot<F> {
        type Error = NorFlashErrorKind;
    }

    impl<F: Flash> ReadNorFlash for FlashSlot<F> {
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

    impl<F: Flash> NorFlash for FlashSlot<F> {
        const WRITE_SIZE: usize = F::WRITE_BYTES;
        const ERASE_SIZE: usize = F::ERASE_BYTES;

        fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
            nor_flash::check_erase(self, from, to)?;
            for sector in (from..to).step_by(F::ERASE_BYTES) {
                // Safety: a sector of this slot, as was checked; the slot is borrowed mutably.
                unsafe { F::erase(self.address + sector as usize)? };
            }
            Ok(())
        }

        fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
            nor_flash::check_write(self, offset, bytes.len())?;
            // Safety: words of this slot, as was checked; the slot is borrowed mutably.
            unsafe { F::write(self.address + offset as usize, bytes) }
        }
    }

    impl<F: Flash> Slot for FlashSlot<F> {
        fn bytes(&self) -> &[u8] {
            // Safety: flash that the memory map reserves for this slot. It changes only by `write` and `erase`, which borrow the slot mutably.
            unsafe { slice::from_raw_parts(ptr::with_exposed_provenance(self.address), self.len) }
        }
    }
}
