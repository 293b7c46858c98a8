//! Pantin on QEMU's sx1, the Siemens SX1: plays the clips that it was built with on the phone's display.
#![no_std]
#![no_main]

mod board;
mod display;
mod log;
mod registers;
mod start;

#[cfg(not(feature = "steer"))]
use board_common::{NoFlash, run_emulated};

#[cfg(not(feature = "steer"))]
include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
#[cfg(not(feature = "steer"))]
const FIGURES: usize = 8;

fn main() -> ! {
    #[cfg(feature = "steer")]
    board_common::run_steered(board::new());
    #[cfg(not(feature = "steer"))]
    run_emulated::<NoFlash, _, FIGURES>(CLIPS, board::new())
}
