//! The flash's last 512 KiB, written by the functions of the chip's boot ROM (RP2040 data sheet, 2.8.3.1.3). While they run the flash is
//! no memory: what calls them lies in RAM, and nothing interrupts it.
#![allow(unsafe_code)]

use board_common::Chip;
use board_common::nor_flash::NorFlashErrorKind;
use core::hint::black_box;
use core::{mem, ptr};
use rp2040_hal::rom_data::{connect_internal_flash, flash_exit_xip, flash_flush_cache, flash_range_erase, flash_range_program};

/// Where the processor reads the flash; the ROM counts from its start.
const FLASH: usize = 0x1000_0000;
/// Blocks that the ROM may erase at once, and the flash's command for that.
const BLOCK: u32 = 1 << 16;
const BLOCK_ERASE: u8 = 0xd8;

/// The flash.
pub struct Rom;

type Page = [u8; 256];

/// The functions, which are looked up while the flash can be read.
struct Functions {
    connect: unsafe extern "C" fn(),
    exit: unsafe extern "C" fn(),
    erase: unsafe extern "C" fn(u32, usize, u32, u8),
    program: unsafe extern "C" fn(u32, *const u8, usize),
    flush: unsafe extern "C" fn(),
    /// The second stage of the boot, in RAM: it has the flash mapped into memory as fast as at the start.
    map: unsafe extern "C" fn(),
}

/// Erases a sector, or writes a page where there is one.
///
/// # Safety
/// Nothing else runs, page and functions lie in RAM or ROM, and what is erased or written is no Rust value's.
#[unsafe(link_section = ".data.without_flash")]
#[inline(never)]
unsafe extern "C" fn without_flash(functions: &Functions, offset: u32, page: *const u8) {
    // Safety: as is promised, in the order in which the data sheet has them.
    unsafe {
        (functions.connect)();
        (functions.exit)();
        if page.is_null() {
            (functions.erase)(offset, Rom::SECTOR, BLOCK, BLOCK_ERASE);
        } else {
            (functions.program)(offset, page, size_of::<Page>());
        }
        (functions.flush)();
        (functions.map)();
    }
}

/// The same, at an address, where the program may be.
///
/// # Safety
/// What is erased or written is no Rust value's.
unsafe fn change(address: usize, page: *const u8) {
    #[repr(align(4))]
    struct Second([u8; 256]);
    let second = Second(crate::boot::BOOT2);
    // Safety: it is code of Thumb, which is called at odd addresses, can lie anywhere and returns to who calls it (data sheet, 2.8.1.3).
    let map = unsafe { mem::transmute::<*const u8, unsafe extern "C" fn()>(black_box(second.0.as_ptr()).wrapping_add(1)) };
    let functions = Functions {
        connect: connect_internal_flash::ptr(),
        exit: flash_exit_xip::ptr(),
        erase: flash_range_erase::ptr(),
        program: flash_range_program::ptr(),
        flush: flash_flush_cache::ptr(),
        map,
    };
    // Safety: the second core sleeps, and no DMA is used; the rest is as promised.
    cortex_m::interrupt::free(|_| unsafe { without_flash(&functions, (address - FLASH) as u32, page) });
}

impl Chip for Rom {
    const SECTOR: usize = 4096;
    const WORD: usize = size_of::<Page>();

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        // Safety: promised.
        unsafe { change(address, ptr::null()) };
        Ok(())
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        for (page, at) in words.as_chunks().0.iter().zip((address..).step_by(Self::WORD)) {
            // Wherever it came from, it lies on the stack now.
            let page: Page = *page;
            // Safety: promised.
            unsafe { change(at, page.as_ptr()) };
        }
        Ok(())
    }
}
