//! Pantin on the BBC micro:bit v2: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod debug_port;
mod flash;
mod leds;
mod panic;
mod serial;
#[cfg(feature = "buffered")]
mod uart_rx;
mod watchdog;

use nrf52833_hal::pac::Peripherals;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[cortex_m_rt::entry]
fn main() -> ! {
    debug_port::open();
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    board_common::run_forever::<flash::Flash, _>(CLIPS, board::new(parts))
}
