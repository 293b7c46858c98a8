//! Pantin on QEMU's lm3s6965evb: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod buttons;
mod display;
#[cfg(feature = "ethernet")]
mod ethernet;
mod registers;

use board_common::{NoFlash, run_emulated};

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const FIGURES: usize = 4;

#[cortex_m_rt::entry]
fn main() -> ! {
    board_common::cortex_m::guard_stack();
    run_emulated::<NoFlash, _, FIGURES>(CLIPS, board::new())
}
