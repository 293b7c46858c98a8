//! Panics: the display shows the message.

use crate::display::{Lcd, Screen};
use crate::start::{blanks, sleep};
use board_common::panic_screen;
use core::panic::PanicInfo;
use embedded_hal::delay::DelayNs;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    // What was drawn of a picture is cleared before the message is written.
    let screen = Screen::start();
    panic_screen::<Lcd, _>(info, || (screen, || {}), Blanks);
    loop {
        sleep();
    }
}

/// Waits by the display's frames, 16.7 ms each.
struct Blanks;

impl DelayNs for Blanks {
    fn delay_ns(&mut self, ns: u32) {
        let (begun, frames) = (blanks(), ns / 16_742_706 + 1);
        while blanks().wrapping_sub(begun) < frames {
            sleep();
        }
    }
}
