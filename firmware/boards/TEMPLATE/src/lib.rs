//! A board to copy: docs/BOARDS.md says how. What its own crate has to bring is `embedded-hal`'s traits, a clock, and a watchdog.
#![no_std]
#![forbid(unsafe_code)]

mod board;

pub use board::{Clock, MyBoard, Watchdog};

use board_parts::ssd1306::Pages;
use embedded_hal::digital::InputPin;
use embedded_hal::i2c::I2c;
use embedded_hal_nb::serial::{Read, Write};
use pantin_app::Entry;
use pantin_figure::surface::Frame;

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like: those of the
/// boards that have 128 KiB of RAM or more. The first micro:bit's 16 KiB hold 144, 96 and 36, without the feature `large` of `pantin-app`.
const CHANNELS: usize = 400;
const MOVING: usize = 320;
const JOINTS: usize = 80;

/// What `main` does once the chip's crate has set up clocks and pins.
pub fn main<B: I2c, L: Read + Write, P: InputPin, C: Clock, W: Watchdog>(
    clips: &[Entry],
    mut board: MyBoard<B, L, P, C, W>,
) -> ! {
    let mut frame = Frame::<Pages>::new();
    board_common::perform::<_, CHANNELS, MOVING, JOINTS>(clips, &mut frame, &mut board)
}
