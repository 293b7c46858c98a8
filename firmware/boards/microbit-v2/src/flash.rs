//! The flash's last pages, written by the chip's controller. The program, which lies in the flash too, stands still meanwhile: 90 ms a page that is
//! erased, and 41 µs a word (nRF52833 Product Specification, 6.1.4).
#![allow(unsafe_code)]

use board_common::Chip;
use board_common::nor_flash::{NorFlash, NorFlashError, NorFlashErrorKind};
use core::{ptr, slice};
use nrf52833_hal::nvmc::Nvmc;
use nrf52833_hal::pac::{NVMC, Peripherals};

/// The controller.
pub struct Pages;

type Controller = Nvmc<NVMC>;

/// Does something to the pages in which so many bytes lie, whose offset there it gets.
///
/// # Safety
/// They are a slot's, and nothing borrows its bytes.
unsafe fn within<E: NorFlashError>(
    address: usize,
    len: usize,
    act: impl FnOnce(&mut Controller, u32) -> Result<(), E>,
) -> Result<(), NorFlashErrorKind> {
    let offset = address % Pages::SECTOR;
    let pages = (offset + len).next_multiple_of(Pages::SECTOR);
    // Safety: promised; and nothing else uses the controller.
    let mut controller = unsafe {
        let bytes = slice::from_raw_parts_mut(ptr::with_exposed_provenance_mut(address - offset), pages);
        Nvmc::new(Peripherals::steal().NVMC, bytes)
    };
    act(&mut controller, offset as u32).map_err(|error| error.kind())
}

impl Chip for Pages {
    const SECTOR: usize = Controller::ERASE_SIZE;
    const WORD: usize = Controller::WRITE_SIZE;

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        // Safety: promised.
        unsafe { within(address, Self::SECTOR, |controller, offset| controller.erase(offset, offset + Self::SECTOR as u32)) }
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        // Safety: promised.
        unsafe { within(address, words.len(), |controller, offset| controller.write(offset, words)) }
    }
}
