//! 128 KiB of flash, written by the chip's boot ROM (`esp-storage`), and mapped into memory behind all that programs are linked to.
#![allow(unsafe_code)]

use board_common::nor_flash::{NorFlash, NorFlashError, NorFlashErrorKind};
use board_common::{Chip, Register};
use esp_hal::peripherals::FLASH;
use esp_storage::{FlashStorage, FlashStorageError};

/// Where the slots lie in the flash, as `pantin_store::region` says; where the processor reads them, as `build.rs` says; and their bytes.
const START: usize = 0x003e_0000;
const MAPPED: usize = 0x3c40_0000;
const LEN: usize = 128 << 10;

/// The table of the mapping, with an entry for each page of memory: the number of the flash's page (ESP-IDF, hal/esp32c3/mmu_ll.h).
const TABLE: usize = 0x600c_5000;
const PAGE: usize = 64 << 10;
const ENTRIES: usize = 128;

unsafe extern "C" {
    /// The boot ROM's: what the cache holds of so many bytes is read anew.
    fn Cache_Invalidate_Addr(address: u32, len: u32);
}

/// The flash.
pub struct Rom;

/// Maps the slots into memory: once, before they are read.
pub fn map() {
    for page in 0..LEN / PAGE {
        let entry = (MAPPED / PAGE + page) % ENTRIES;
        // Safety: a register of the chip; of the pages that the second stage of the boot has mapped none is this one.
        unsafe { Register::<u32>::at(TABLE + 4 * entry) }.write((START / PAGE + page) as u32);
    }
    forget(MAPPED, LEN);
}

fn forget(address: usize, len: usize) {
    // Safety: it changes nothing but the cache, which holds no more than what is in the flash.
    unsafe { Cache_Invalidate_Addr(address as u32, len as u32) };
}

/// Does something to what lies at an address, whose offset in the flash it gets.
fn change(
    address: usize,
    len: usize,
    act: impl FnOnce(FlashStorage, u32) -> Result<(), FlashStorageError>,
) -> Result<(), NorFlashErrorKind> {
    // Safety: nothing else uses the controller.
    let flash = FlashStorage::new(unsafe { FLASH::steal() });
    let done = act(flash, (address - MAPPED + START) as u32);
    forget(address, len);
    done.map_err(|error| error.kind())
}

impl Chip for Rom {
    const SECTOR: usize = FlashStorage::ERASE_SIZE;
    const WORD: usize = FlashStorage::WRITE_SIZE;

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        change(address, Self::SECTOR, |mut flash, offset| NorFlash::erase(&mut flash, offset, offset + Self::SECTOR as u32))
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        change(address, words.len(), |mut flash, offset| NorFlash::write(&mut flash, offset, words))
    }
}
