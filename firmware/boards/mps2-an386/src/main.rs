//! Pantin on QEMU's mps2-an386: plays the clips that it was built with, and sends the pictures over its serial line.
#![no_std]
#![no_main]

mod board;
mod registers;

use board::{Mps2, Oled};
use cortex_m_rt::entry;
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const SEATS: usize = 16;

#[entry]
fn main() -> ! {
    board_common::cortex_m::guard_stack();
    let mut frame = Framebuffer::<Oled>::new();
    board_common::play::<_, SEATS>(CLIPS, &mut frame, &mut Mps2::new())
}
