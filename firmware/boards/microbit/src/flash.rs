//! The flash's last pages as two slots for clips, written by its controller (nRF51 Series Reference Manual, NVMC).
#![allow(unsafe_code)]

use crate::registers::nvmc;
use board_common::Register;
use core::sync::atomic::{AtomicBool, Ordering};
use core::{ptr, slice};
use embedded_storage::nor_flash::{self, ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use pantin_store::Slot;

/// What the controller allows.
const READ: u32 = 0;
const WRITE: u32 = 1;
const ERASE: u32 = 2;

/// A slot: nothing else reads or writes its flash.
pub struct Pages {
    address: usize,
    len: usize,
}

/// Both slots, as the memory map has them; once.
pub fn slots() -> Option<[Pages; 2]> {
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
    Some([Pages { address: start, len }, Pages { address: start + len, len }])
}

/// Lets the controller do one thing until that is done.
fn allow(what: u32, act: impl FnOnce()) {
    nvmc::CONFIG.write(what);
    act();
    while nvmc::READY.read() & 1 == 0 {}
    nvmc::CONFIG.write(READ);
}

impl ErrorType for Pages {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for Pages {
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

impl NorFlash for Pages {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = 1024;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        nor_flash::check_erase(self, from, to)?;
        for page in (from..to).step_by(Self::ERASE_SIZE) {
            allow(ERASE, || nvmc::ERASE_PAGE.write(self.address as u32 + page));
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        nor_flash::check_write(self, offset, bytes.len())?;
        for (word, at) in bytes.as_chunks().0.iter().zip((self.address + offset as usize..).step_by(Self::WRITE_SIZE)) {
            // Safety: a word of this slot, as was checked: flash that is no Rust value's while the slot is borrowed mutably.
            let place = unsafe { Register::<u32>::at(at) };
            allow(WRITE, || place.write(u32::from_le_bytes(*word)));
        }
        Ok(())
    }
}

impl Slot for Pages {
    fn bytes(&self) -> &[u8] {
        // Safety: flash that the memory map keeps for this slot alone: it changes by `write` and `erase` only, which borrow the slot mutably.
        unsafe { slice::from_raw_parts(ptr::with_exposed_provenance(self.address), self.len) }
    }
}
