//! What ends a program: a panic, which the display shows for 10 s before the watchdog resets the board, or a refusal, which it shows without end.
#![allow(unsafe_code)]

use crate::rp_hal::pac::Peripherals;
use crate::{board, clocks::CPU_HZ};
use board_common::{cortex_m::ClockDelay, panic_screen, refusal_screen};
use core::fmt::Display;
use core::panic::PanicInfo;

#[panic_handler]
#[allow(clippy::empty_loop)]
fn panic(info: &PanicInfo) -> ! {
    // Safety: the code that had the peripherals does not run any more, and the set-up resets them.
    panic_screen(info, || board::new(unsafe { Peripherals::steal() }), ClockDelay::<CPU_HZ>);
    loop {}
}

/// Shows why the program cannot do its work, on the display if one is connected, and over the serial line. The clocks must run.
pub fn refuse(words: impl Display) -> ! {
    cortex_m::interrupt::disable();
    // Safety: the caller does not go on, interrupts are off, and the set-up resets the peripherals.
    refusal_screen(words, || board::new(unsafe { Peripherals::steal() }), ClockDelay::<CPU_HZ>)
}
