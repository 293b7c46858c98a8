//! A refusal: why a program cannot do its work, which the display shows without end.
#![allow(unsafe_code)]

use crate::rp_hal::pac::Peripherals;
use crate::{board, clocks::CPU_HZ};
use board_common::{cortex_m::ClockDelay, refusal_screen};
use core::fmt::Display;

/// Shows why the program cannot do its work, on the display if one is connected, and over the serial line. The clocks must run.
pub fn refuse(words: impl Display) -> ! {
    cortex_m::interrupt::disable();
    // Safety: the caller does not go on, interrupts are off, and the set-up resets the peripherals.
    refusal_screen(words, || board::new(unsafe { Peripherals::steal() }), ClockDelay::<CPU_HZ>)
}
