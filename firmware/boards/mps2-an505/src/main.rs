//! Pantin on QEMU's mps2-an505: plays the clips that it was built with, and sends the pictures over its serial line.
#![no_std]
#![no_main]

#[path = "../../mps2-an386/src/board.rs"]
mod board;
#[path = "../../mps2-an386/src/registers.rs"]
mod registers;

use board_common::{NoFlash, cortex_m, run_emulated};

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// The core clock.
const CPU_HZ: u32 = 20_000_000;
/// Clocks in a bit at 115,200 baud.
const BAUD_CLOCKS: u32 = 174;
/// The address of serial line 0 for secure programs.
const UART0: usize = 0x5020_0000;

#[cortex_m_rt::entry]
fn main() -> ! {
    cortex_m::guard_stack();
    run_emulated::<NoFlash, _, 1>(CLIPS, board::new())
}
