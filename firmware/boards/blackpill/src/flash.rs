//! The flash's last two sectors. The program, which lies in the flash too, stands still while one is erased: two seconds, and at most four
//! (STM32F411 data sheet, 6.3.13, bytes at once), or written: a page in four milliseconds.
#![allow(unsafe_code)]

use board_common::Chip;
use board_common::nor_flash::{NorFlash, NorFlashError, NorFlashErrorKind};
use stm32f4xx_hal::flash::{FlashExt, UnlockedFlash};
use stm32f4xx_hal::pac::FLASH;

/// The flash.
pub struct Sectors;

/// Does something to what lies at an address, whose offset it gets.
fn unlocked(
    address: usize,
    act: impl FnOnce(UnlockedFlash, u32) -> Result<(), stm32f4xx_hal::flash::Error>,
) -> Result<(), NorFlashErrorKind> {
    // Safety: nothing else uses the controller.
    let mut flash = unsafe { FLASH::steal() };
    let offset = (address - flash.address()) as u32;
    let done = act(flash.unlocked(), offset);
    // Erased flash does not reach what the cache holds of it (RM0383, 3.4.2); only one that is off can be emptied.
    flash.acr().modify(|_, w| w.dcen().clear_bit());
    flash.acr().modify(|_, w| w.dcrst().set_bit());
    flash.acr().modify(|_, w| w.dcrst().clear_bit());
    flash.acr().modify(|_, w| w.dcen().set_bit());
    done.map_err(|error| error.kind())
}

impl Chip for Sectors {
    const SECTOR: usize = UnlockedFlash::ERASE_SIZE;
    const WORD: usize = UnlockedFlash::WRITE_SIZE;

    unsafe fn erase(address: usize) -> Result<(), NorFlashErrorKind> {
        unlocked(address, |mut flash, offset| NorFlash::erase(&mut flash, offset, offset + Self::SECTOR as u32))
    }

    unsafe fn write(address: usize, words: &[u8]) -> Result<(), NorFlashErrorKind> {
        unlocked(address, |mut flash, offset| NorFlash::write(&mut flash, offset, words))
    }
}
