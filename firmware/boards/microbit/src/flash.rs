//! The flash, written by its controller (nRF51 Series Reference Manual, NVMC).
#![allow(unsafe_code)]

use crate::registers::nvmc;
use board_common::Register;
use board_common::nor_flash::NorFlashErrorKind;

/// The controller's modes.
const READ: u32 = 0;
const WRITE: u32 = 1;
const ERASE: u32 = 2;

/// The flash.
pub struct Flash;

/// Runs one operation in a mode, and waits until it is done.
fn in_mode(mode: u32, operation: impl FnOnce()) {
    nvmc::CONFIG.write(mode);
    operation();
    while nvmc::READY.read() & 1 == 0 {}
    nvmc::CONFIG.write(READ);
}

impl board_common::Flash for Flash {
    const ERASE_BYTES: usize = 1024;
    const WRITE_BYTES: usize = 4;

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        in_mode(ERASE, || nvmc::ERASE_PAGE.write(address as u32));
        Ok(())
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        for (word, at) in words.as_chunks().0.iter().zip((address..).step_by(Self::WRITE_BYTES)) {
            // Safety: by the trait's contract this is a word of a slot that nothing borrows.
            let place = unsafe { Register::<u32>::at(at) };
            in_mode(WRITE, || place.write(u32::from_le_bytes(*word)));
        }
        Ok(())
    }
}
