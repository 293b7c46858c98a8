//! Pantin on the nRF52840 DK: plays the clips that it was built with. The chip is a larger one of the micro:bit v2's family, and most modules are
//! that board's.
#![no_std]
#![no_main]

mod board;
mod panic;
#[cfg_attr(feature = "pins-xiao", path = "pins/xiao.rs")]
mod pins;

#[path = "../../microbit-v2/src/debug_port.rs"]
mod debug_port;
#[path = "../../microbit-v2/src/flash.rs"]
mod flash;
#[path = "../../microbit-v2/src/oled.rs"]
mod oled;
#[path = "../../microbit-v2/src/serial.rs"]
mod serial;
#[cfg(feature = "buffered")]
#[path = "../../microbit-v2/src/uart_rx.rs"]
mod uart_rx;
#[path = "../../microbit-v2/src/watchdog.rs"]
mod watchdog;

use nrf_hal::pac::Peripherals;
use nrf52840_hal as nrf_hal;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// The processor's clock.
const CPU_HZ: u32 = 64_000_000;

#[cortex_m_rt::entry]
fn main() -> ! {
    // The first build whose debug port is closed after a reset.
    debug_port::open(b'F');
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    board_common::run_forever::<flash::Flash, _>(CLIPS, board::new(parts))
}
