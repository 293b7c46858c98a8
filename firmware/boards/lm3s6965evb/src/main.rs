//! Pantin on QEMU's lm3s6965evb: plays the clip that it was built with.
#![no_std]
#![no_main]

mod board;
mod buttons;
mod display;
#[cfg(feature = "ethernet")]
mod ethernet;
mod registers;

use board::{Lm3s, Oled};
use cortex_m_rt::entry;
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const SEATS: usize = 4;

#[entry]
fn main() -> ! {
    board_common::cortex_m::guard_stack();
    let mut frame = Framebuffer::<Oled>::new();
    board_common::play::<_, SEATS>(CLIPS, &mut frame, &mut Lm3s::new())
}
