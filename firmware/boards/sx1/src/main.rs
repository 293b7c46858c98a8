//! Pantin on QEMU's sx1, the Siemens SX1: plays the clips that it was built with on the phone's display.
#![no_std]
#![no_main]

mod board;
mod display;
mod log;
mod registers;
mod start;

use board::{Lcd, Sx1};
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const SEATS: usize = 8;

fn main() -> ! {
    let mut frame = Framebuffer::<Lcd>::new();
    board_common::play::<_, SEATS>(CLIPS, &mut frame, &mut Sx1::new())
}
