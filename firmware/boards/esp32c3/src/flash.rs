//! The flash, written by the chip's boot ROM (`esp-storage`). The slots are mapped into memory after everything that programs are linked to.
#![allow(unsafe_code)]

use board_common::nor_flash::{NorFlash, NorFlashError, NorFlashErrorKind};
use core::ptr;
use esp_hal::peripherals::FLASH;
use esp_storage::{FlashStorage, FlashStorageError};

/// The slots' offset in the flash, as in `pantin_store::region`; the address at which the processor reads them, as in `build.rs`; and their
/// bytes.
const OFFSET: usize = 0x003e_0000;
const MAPPED: usize = 0x3c40_0000;
const BYTES: usize = 128 << 10;

/// The mapping's table. The entry of each page of memory is the number of a page of the flash (ESP-IDF, hal/esp32c3/mmu_ll.h).
const TABLE: usize = 0x600c_5000;
const PAGE: usize = 64 << 10;
const ENTRIES: usize = 128;

unsafe extern "C" {
    /// A function of the boot ROM that drops the cached bytes of a range.
    fn Cache_Invalidate_Addr(address: u32, len: u32);
    /// Turns the cache off. Returns whether it loads ahead, for the other function.
    fn Cache_Suspend_ICache() -> u32;
    fn Cache_Resume_ICache(autoload: u32);
}

/// The flash.
pub struct Flash;

fn invalidate(address: usize, len: usize) {
    // Safety: it changes nothing but the cache, whose bytes are those of the flash.
    unsafe { Cache_Invalidate_Addr(address as u32, len as u32) };
}

/// Maps the slots into memory.
///
/// The table must not change while the cache uses it. Without the cache the flash cannot be read: this function lies in RAM, calls only the
/// boot ROM, and runs with interrupts off.
#[esp_hal::ram]
fn map() {
    // Safety: registers of the chip. The second stage of the boot maps none of these pages.
    unsafe {
        let autoload = Cache_Suspend_ICache();
        let mut page = 0;
        while page < BYTES / PAGE {
            let entry = (MAPPED / PAGE + page) % ENTRIES;
            ptr::with_exposed_provenance_mut::<u32>(TABLE + 4 * entry).write_volatile((OFFSET / PAGE + page) as u32);
            page += 1;
        }
        Cache_Invalidate_Addr(MAPPED as u32, BYTES as u32);
        Cache_Resume_ICache(autoload);
    }
}

/// Runs an operation on the flash, with the offset of an address in it.
fn change(
    address: usize,
    len: usize,
    operation: impl FnOnce(FlashStorage, u32) -> Result<(), FlashStorageError>,
) -> Result<(), NorFlashErrorKind> {
    // Safety: nothing else uses the controller.
    let flash = FlashStorage::new(unsafe { FLASH::steal() });
    let result = operation(flash, (address - MAPPED + OFFSET) as u32);
    invalidate(address, len);
    result.map_err(|error| error.kind())
}

impl board_common::Flash for Flash {
    const ERASE_BYTES: usize = FlashStorage::ERASE_SIZE;
    const WRITE_BYTES: usize = FlashStorage::WRITE_SIZE;

    /// Maps the slots into memory. Not inlined: a test runs it alone.
    #[inline(never)]
    fn start() {
        critical_section::with(|_| map());
    }

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        let bytes = Self::ERASE_BYTES;
        change(address, bytes, |mut flash, offset| NorFlash::erase(&mut flash, offset, offset + bytes as u32))
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        change(address, words.len(), |mut flash, offset| NorFlash::write(&mut flash, offset, words))
    }
}
