//! Pantin on QEMU's sx1, the Siemens SX1: plays the clips that it was built with on the phone's display.
#![no_std]
#![no_main]

mod board;
mod display;
mod log;
mod registers;
mod start;

use board_common::{NoFlash, run_emulated};

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const FIGURES: usize = 8;

fn main() -> ! {
    run_emulated::<NoFlash, _, FIGURES>(CLIPS, board::new())
}
