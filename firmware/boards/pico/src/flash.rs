//! The flash, written by functions of the chip's boot ROM (RP2040 data sheet, 2.8.3.1.3). While these run, the flash cannot be read: the code
//! that calls them lies in RAM, with interrupts off.
#![allow(unsafe_code)]

use board_common::nor_flash::NorFlashErrorKind;
use core::hint::black_box;
use core::{mem, ptr};
use rp2040_hal::rom_data::{connect_internal_flash, flash_exit_xip, flash_flush_cache, flash_range_erase, flash_range_program};

/// The address at which the processor reads the flash. The ROM counts from the flash's start.
const START: usize = 0x1000_0000;
/// The bytes of a block that the ROM may erase at once, and the flash's command for that.
const BLOCK: u32 = 1 << 16;
const BLOCK_ERASE: u8 = 0xd8;

/// The flash.
pub struct Flash;

type Page = [u8; 256];

/// The ROM's functions, looked up while the flash can be read.
struct Functions {
    connect: unsafe extern "C" fn(),
    exit: unsafe extern "C" fn(),
    erase: unsafe extern "C" fn(u32, usize, u32, u8),
    program: unsafe extern "C" fn(u32, *const u8, usize),
    flush: unsafe extern "C" fn(),
    /// The second stage of the boot, copied to RAM: it maps the flash into memory again.
    map: unsafe extern "C" fn(),
}

/// Erases a sector if `page` is null, or writes a page.
///
/// # Safety
/// Nothing else runs, page and functions lie in RAM or ROM, and no Rust value lies in what is erased or written.
#[unsafe(link_section = ".data.without_flash")]
#[inline(never)]
unsafe extern "C" fn without_flash(functions: &Functions, offset: u32, page: *const u8) {
    // Safety: by the contract above, in the order that the data sheet demands.
    unsafe {
        (functions.connect)();
        (functions.exit)();
        if page.is_null() {
            (functions.erase)(offset, <Flash as board_common::Flash>::ERASE_BYTES, BLOCK, BLOCK_ERASE);
        } else {
            (functions.program)(offset, page, size_of::<Page>());
        }
        (functions.flush)();
        (functions.map)();
    }
}

/// The same by a processor's address; this function itself may lie in flash.
///
/// # Safety
/// No Rust value lies in what is erased or written.
unsafe fn change(address: usize, page: *const u8) {
    #[repr(align(4))]
    struct Second([u8; 256]);
    let second = Second(crate::boot::BOOT2);
    // Safety: it is Thumb code, which is called at odd addresses; it is position-independent and returns to its caller (data sheet, 2.8.1.3).
    let map = unsafe { mem::transmute::<*const u8, unsafe extern "C" fn()>(black_box(second.0.as_ptr()).wrapping_add(1)) };
    let functions = Functions {
        connect: connect_internal_flash::ptr(),
        exit: flash_exit_xip::ptr(),
        erase: flash_range_erase::ptr(),
        program: flash_range_program::ptr(),
        flush: flash_flush_cache::ptr(),
        map,
    };
    // Safety: the second core sleeps, and no DMA is used; the caller guarantees the rest.
    cortex_m::interrupt::free(|_| unsafe { without_flash(&functions, (address - START) as u32, page) });
}

impl board_common::Flash for Flash {
    const ERASE_BYTES: usize = 4096;
    const WRITE_BYTES: usize = size_of::<Page>();

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        // Safety: the caller guarantees it.
        unsafe { change(address, ptr::null()) };
        Ok(())
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        for (page, at) in words.as_chunks().0.iter().zip((address..).step_by(Self::WRITE_BYTES)) {
            // A copy in RAM, wherever the words lie.
            let page: Page = *page;
            // Safety: the caller guarantees it.
            unsafe { change(at, page.as_ptr()) };
        }
        Ok(())
    }
}
