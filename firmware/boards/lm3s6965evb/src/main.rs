//! Pantin on QEMU's lm3s6965evb: plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod buttons;
mod display;
#[cfg(feature = "ethernet")]
mod ethernet;
mod registers;

#[cfg(not(feature = "steer"))]
use board_common::{NoFlash, run_emulated};

#[cfg(not(feature = "steer"))]
include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
#[cfg(not(feature = "steer"))]
const FIGURES: usize = 4;

#[cortex_m_rt::entry]
fn main() -> ! {
    board_common::cortex_m::guard_stack();
    #[cfg(feature = "steer")]
    board_common::run_steered(board::new());
    #[cfg(not(feature = "steer"))]
    run_emulated::<NoFlash, _, FIGURES>(CLIPS, board::new())
}
