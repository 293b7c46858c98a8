//! Pantin on the Nucleo-F411RE: plays the clips that it was built with. The chip is that of the "Black Pill", and so are most modules.
#![no_std]
#![no_main]

#[path = "../../blackpill/src/flash.rs"]
mod flash;
#[path = "../../blackpill/src/panic.rs"]
mod panic;
#[cfg(feature = "spi")]
#[path = "../../blackpill/src/spi_display.rs"]
mod spi_display;
#[cfg(feature = "buffered")]
#[path = "../../blackpill/src/uart_rx.rs"]
mod uart_rx;
#[path = "../../blackpill/src/watchdog.rs"]
mod watchdog;

mod board;
#[cfg(not(feature = "spi"))]
#[path = "../../blackpill/src/i2c.rs"]
mod i2c;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(parts) = stm32f4xx_hal::pac::Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    board_common::run_forever::<flash::Flash, _>(CLIPS, board::new(parts))
}
