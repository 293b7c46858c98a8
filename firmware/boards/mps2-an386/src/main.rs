//! Pantin on QEMU's mps2-an386: plays the clips that it was built with, and sends the pictures over its serial line.
#![no_std]
#![no_main]

mod board;
mod registers;

use board_common::{NoFlash, cortex_m, run_emulated};

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const FIGURES: usize = 16;

#[cortex_m_rt::entry]
fn main() -> ! {
    cortex_m::guard_stack();
    run_emulated::<NoFlash, _, FIGURES>(CLIPS, board::new())
}
