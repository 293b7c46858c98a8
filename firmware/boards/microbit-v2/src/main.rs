//! Pantin on the BBC micro:bit v2: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod dog;
mod leds;
mod line;
mod oled;
mod panic;

use board::Microbit;
use board_parts::ssd1306::Pages;
use nrf52833_hal::pac::Peripherals;
use pantin_figure::surface::Frame;

#[cfg(feature = "defmt")]
use defmt_rtt as _;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like.
const CHANNELS: usize = 400;
const MOVING: usize = 320;
const JOINTS: usize = 80;

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes them") };
    let mut frame = Frame::<Pages>::new();
    board_common::perform::<_, CHANNELS, MOVING, JOINTS>(CLIPS, &mut frame, &mut Microbit::new(parts))
}
