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
use cortex_m_rt::entry;
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const SEATS: usize = 1;

#[entry]
fn main() -> ! {
    let mut frame = Framebuffer::<Pages>::new();
    #[cfg(feature = "update")]
    if let Some(mut store) = board_common::store::<flash::Nvmc>() {
        board_common::play_stored(&mut store, CLIPS, &mut frame, &mut Microbit::new())
    }
    board_common::play::<_, SEATS>(CLIPS, &mut frame, &mut Microbit::new())
}
