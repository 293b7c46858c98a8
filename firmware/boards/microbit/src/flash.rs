//! The flash's last pages, written by its controller (nRF51 Series Reference Manual, NVMC).
#![allow(unsafe_code)]

use crate::registers::nvmc;
use board_common::nor_flash::NorFlashErrorKind;
use board_common::{Chip, Register};

/// What the controller allows.
const READ: u32 = 0;
const WRITE: u32 = 1;
const ERASE: u32 = 2;

/// The controller.
pub struct Nvmc;

/// Lets the controller do one thing until that is done.
fn allow(what: u32, act: impl FnOnce()) {
    nvmc::CONFIG.write(what);
    act();
    while nvmc::READY.read() & 1 == 0 {}
    nvmc::CONFIG.write(READ);
}

impl Chip for Nvmc {
    const SECTOR: usize = 1024;
    const WORD: usize = 4;

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        allow(ERASE, || nvmc::ERASE_PAGE.write(address as u32));
        Ok(())
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        for (word, at) in words.as_chunks().0.iter().zip((address..).step_by(Self::WORD)) {
            // Safety: a word of a slot, as is promised: flash that is no Rust value's while nothing borrows it.
            let place = unsafe { Register::<u32>::at(at) };
            allow(WRITE, || place.write(u32::from_le_bytes(*word)));
        }
        Ok(())
    }
}
