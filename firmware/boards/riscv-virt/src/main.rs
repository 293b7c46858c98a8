//! Pantin on QEMU's virt, a RISC-V: plays the clips that it was built with, and sends the pictures over its serial line.
#![no_std]
#![no_main]

mod board;
mod registers;
mod trap;

use board_common::{NoFlash, run_emulated};

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Never returns: the emulator ends.
#[riscv_rt::entry]
fn main() -> ! {
    trap::guard_stack();
    run_emulated::<NoFlash, _, 1>(CLIPS, board::new())
}
