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
use pantin_figure::surface::Frame;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like.
const CHANNELS: usize = if cfg!(feature = "large") { 400 } else { 144 };
const MOVING: usize = if cfg!(feature = "large") { 256 } else { 96 };
const JOINTS: usize = if cfg!(feature = "large") { 64 } else { 36 };
/// Most figures side by side.
const SEATS: usize = 4;

#[entry]
fn main() -> ! {
    board_common::cortex_m::guard_stack();
    let mut frame = Frame::<Oled>::new();
    board_common::play::<_, CHANNELS, MOVING, JOINTS, SEATS>(CLIPS, &mut frame, &mut Lm3s::new())
}
