//! The panic handler: the display shows the panic for 10 s, then the board resets.
#![allow(unsafe_code)]

use crate::board;
use core::panic::PanicInfo;
use esp_hal::{delay::Delay, peripherals::Peripherals, system::software_reset};

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    // Safety: the code that had the peripherals does not run any more.
    board_common::panic_screen(info, || board::new(unsafe { Peripherals::steal() }), Delay::new());
    software_reset()
}
