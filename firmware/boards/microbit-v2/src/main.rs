//! Pantin on the BBC micro:bit v2: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod dog;
#[cfg(feature = "update")]
mod flash;
mod leds;
mod line;
mod oled;
mod panic;
#[cfg(feature = "update")]
mod received;

use board::Microbit;
use board_parts::ssd1306::Pages;
use nrf52833_hal::pac::Peripherals;
use pantin_figure::surface::Framebuffer;

#[cfg(feature = "defmt")]
use defmt_rtt as _;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes them") };
    let mut frame = Framebuffer::<Pages>::new();
    let mut board = Microbit::new(parts);
    #[cfg(feature = "update")]
    if let Some(mut store) = board_common::store::<flash::Pages>() {
        board_common::perform_stored(&mut store, CLIPS, &mut frame, &mut board)
    }
    board_common::perform(CLIPS, &mut frame, &mut board)
}
