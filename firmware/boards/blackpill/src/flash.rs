//! The flash. The program lies in it too, and stands still while a sector is erased (2 s, at most 4 s: STM32F411 data sheet, 6.3.13, byte
//! accesses) or a page written (4 ms).
#![allow(unsafe_code)]

use board_common::nor_flash::{NorFlash, NorFlashError, NorFlashErrorKind};
use stm32f4xx_hal::flash::{FlashExt, UnlockedFlash};
use stm32f4xx_hal::pac::FLASH;

/// The flash.
pub struct Flash;

/// Runs an operation on the unlocked flash, with the offset of an address in it.
fn unlocked(
    address: usize,
    operation: impl FnOnce(UnlockedFlash, u32) -> Result<(), stm32f4xx_hal::flash::Error>,
) -> Result<(), NorFlashErrorKind> {
    // Safety: nothing else uses the controller.
    let mut flash = unsafe { FLASH::steal() };
    let offset = (address - flash.address()) as u32;
    let result = operation(flash.unlocked(), offset);
    // The data cache keeps bytes from before the erasure (RM0383, 3.4.2). It can be emptied only while it is off.
    flash.acr().modify(|_, w| w.dcen().clear_bit());
    flash.acr().modify(|_, w| w.dcrst().set_bit());
    flash.acr().modify(|_, w| w.dcrst().clear_bit());
    flash.acr().modify(|_, w| w.dcen().set_bit());
    result.map_err(|error| error.kind())
}

impl board_common::Flash for Flash {
    const ERASE_BYTES: usize = UnlockedFlash::ERASE_SIZE;
    const WRITE_BYTES: usize = UnlockedFlash::WRITE_SIZE;

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        unlocked(address, |mut flash, offset| NorFlash::erase(&mut flash, offset, offset + Self::ERASE_BYTES as u32))
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        unlocked(address, |mut flash, offset| NorFlash::write(&mut flash, offset, words))
    }
}
