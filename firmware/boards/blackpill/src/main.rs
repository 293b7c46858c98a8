//! Pantin on the "Black Pill": plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod flash;
#[cfg(not(feature = "spi"))]
mod i2c;
mod panic;
#[cfg(feature = "spi")]
mod spi_display;
#[cfg(feature = "buffered")]
mod uart_rx;
mod watchdog;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(parts) = stm32f4xx_hal::pac::Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    board_common::run_forever::<flash::Flash, _>(CLIPS, board::new(parts))
}
