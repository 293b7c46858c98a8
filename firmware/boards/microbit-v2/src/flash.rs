//! The flash, written by the chip's controller. The program lies in it too, and stands still while a page is erased (90 ms) or a word
//! written (41 µs; nRF52833 Product Specification, 6.1.4).
#![allow(unsafe_code)]

use crate::nrf_hal::nvmc::Nvmc;
use crate::nrf_hal::pac::{NVMC, Peripherals};
use board_common::nor_flash::{NorFlash, NorFlashError, NorFlashErrorKind};
use core::{ptr, slice};

/// The flash.
pub struct Flash;

type Controller = Nvmc<NVMC>;

/// Runs an operation on the pages of `len` bytes at an address, with the offset of that address in them.
///
/// # Safety
/// The pages are a slot's, and nothing borrows their bytes.
unsafe fn in_pages<E: NorFlashError>(
    address: usize,
    len: usize,
    operation: impl FnOnce(&mut Controller, u32) -> Result<(), E>,
) -> Result<(), NorFlashErrorKind> {
    let offset = address % Controller::ERASE_SIZE;
    let pages = (offset + len).next_multiple_of(Controller::ERASE_SIZE);
    // Safety: the caller guarantees it; and nothing else uses the controller.
    let mut controller = unsafe {
        let bytes = slice::from_raw_parts_mut(ptr::with_exposed_provenance_mut(address - offset), pages);
        Nvmc::new(Peripherals::steal().NVMC, bytes)
    };
    operation(&mut controller, offset as u32).map_err(|error| error.kind())
}

impl board_common::Flash for Flash {
    const ERASE_BYTES: usize = Controller::ERASE_SIZE;
    const WRITE_BYTES: usize = Controller::WRITE_SIZE;

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        let bytes = Self::ERASE_BYTES;
        // Safety: the caller guarantees it.
        unsafe { in_pages(address, bytes, |controller, offset| controller.erase(offset, offset + bytes as u32)) }
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        // Safety: the caller guarantees it.
        unsafe { in_pages(address, words.len(), |controller, offset| controller.write(offset, words)) }
    }
}
