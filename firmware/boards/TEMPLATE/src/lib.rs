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
use pantin_figure::surface::Framebuffer;

/// What `main` does once the chip's crate has set up clocks and pins. The room for clips is that of boards with 64 KiB of RAM or more; the first
/// micro:bit's 16 KiB hold 144 channels, 96 that move and 36 joints, without the feature `large` of `pantin-app`.
pub fn main<B: I2c, L: Read + Write, P: InputPin, C: Clock, W: Watchdog>(
    clips: &[Entry],
    mut board: MyBoard<B, L, P, C, W>,
) -> ! {
    let mut frame = Framebuffer::<Pages>::new();
    board_common::perform(clips, &mut frame, &mut board)
}
