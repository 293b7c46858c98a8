//! Pantin on QEMU's virt, a RISC-V: plays the clips that it was built with, and sends the pictures over its serial line.
#![no_std]
#![no_main]

mod board;
mod registers;
mod trap;

use board::{Pages, Virt};
use pantin_figure::surface::Framebuffer;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most figures side by side.
const SEATS: usize = 1;

/// Never returns: the emulator ends.
#[riscv_rt::entry]
fn main() -> ! {
    trap::guard_stack();
    let mut frame = Framebuffer::<Pages>::new();
    board_common::play::<_, SEATS>(CLIPS, &mut frame, &mut Virt::new())
}
