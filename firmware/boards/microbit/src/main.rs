//! Pantin on QEMU's microbit: plays the clips that it was built with, and sends the pictures over its serial line.
#![no_std]
#![no_main]

mod board;
#[cfg(feature = "update")]
mod flash;
#[cfg(feature = "update")]
mod received;
mod registers;

use board::{Microbit, Pages};
use board_common::fitted;
use cortex_m_rt::entry;
use pantin_figure::surface::Frame;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like.
const MOST: [usize; 3] = [144, 96, 36];
/// Any clip may come over the line.
const TAKEN: [usize; 3] = if cfg!(feature = "update") { MOST } else { LARGEST };
const CHANNELS: usize = fitted(TAKEN[0], MOST[0]);
const MOVING: usize = fitted(TAKEN[1], MOST[1]);
const JOINTS: usize = fitted(TAKEN[2], MOST[2]);
/// Most figures side by side.
const SEATS: usize = 1;

#[entry]
fn main() -> ! {
    let mut frame = Frame::<Pages>::new();
    #[cfg(feature = "update")]
    if let Some(mut store) = board_common::store::<flash::Nvmc>() {
        board_common::play_stored::<_, _, CHANNELS, MOVING, JOINTS>(&mut store, CLIPS, &mut frame, &mut Microbit::new())
    }
    board_common::play::<_, CHANNELS, MOVING, JOINTS, SEATS>(CLIPS, &mut frame, &mut Microbit::new())
}
