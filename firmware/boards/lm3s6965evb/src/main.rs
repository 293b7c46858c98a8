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
use board_common::fitted;
use cortex_m_rt::entry;
use pantin_figure::surface::Frame;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like.
const MOST: [usize; 3] = if cfg!(feature = "large") { [400, 256, 64] } else { [144, 96, 36] };
/// Any clip may come over a line.
const TAKEN: [usize; 3] = if cfg!(any(feature = "link", feature = "ethernet")) { MOST } else { LARGEST };
const CHANNELS: usize = fitted(TAKEN[0], MOST[0]);
const MOVING: usize = fitted(TAKEN[1], MOST[1]);
const JOINTS: usize = fitted(TAKEN[2], MOST[2]);
/// Most figures side by side.
const SEATS: usize = 4;

#[entry]
fn main() -> ! {
    board_common::cortex_m::guard_stack();
    let mut frame = Frame::<Oled>::new();
    board_common::play::<_, CHANNELS, MOVING, JOINTS, SEATS>(CLIPS, &mut frame, &mut Lm3s::new())
}
