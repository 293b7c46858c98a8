//! Pantin on the BBC micro:bit v2: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod debug_port;
mod flash;
mod leds;
mod oled;
mod panic;
mod serial;
#[cfg(feature = "buffered")]
mod uart_rx;
mod watchdog;

use nrf_hal::pac::Peripherals;
use nrf52833_hal as nrf_hal;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// The processor's clock.
const CPU_HZ: u32 = 64_000_000;
/// The first build whose debug port is closed after a reset.
const FIRST_BUILD: u8 = b'B';

#[cortex_m_rt::entry]
fn main() -> ! {
    debug_port::open(FIRST_BUILD);
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    board_common::run_forever::<flash::Flash, _>(CLIPS, board::new(parts))
}
