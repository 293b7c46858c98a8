//! A panic: the display shows it for 10 s before the watchdog resets the board.
#![allow(unsafe_code)]

use crate::rp_hal::pac::Peripherals;
use crate::{board, clocks::CPU_HZ};
use board_common::{cortex_m::ClockDelay, panic_screen};
use core::panic::PanicInfo;

#[panic_handler]
#[allow(clippy::empty_loop)]
fn panic(info: &PanicInfo) -> ! {
    // Safety: the code that had the peripherals does not run any more, and the set-up resets them.
    panic_screen(info, || board::new(unsafe { Peripherals::steal() }), ClockDelay::<CPU_HZ>);
    loop {}
}
