//! A panic stays on the display for ten seconds; then the board starts anew.
#![allow(unsafe_code)]

use crate::board::Esp32C3;
use core::panic::PanicInfo;
use esp_hal::delay::Delay;
use esp_hal::peripherals::Peripherals;

/// How long it stays, in parts, and milliseconds of a part: shorter than the watchdog's patience.
const PARTS: u32 = 20;
const PART: u32 = 500;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    board_common::last_words(info, |page| {
        // Safety: whoever had the peripherals does not run any more.
        let mut board = Esp32C3::new(unsafe { Peripherals::steal() });
        board.tell(page, info);
        for _ in 0..PARTS {
            board.feed();
            Delay::new().delay_millis(PART);
        }
    });
    esp_hal::system::software_reset()
}
