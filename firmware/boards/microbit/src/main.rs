//! Pantin on QEMU's microbit: plays the clips that it was built with, and sends the pictures over its serial line.
#![no_std]
#![no_main]

mod board;
mod flash;
mod registers;
#[cfg(feature = "update")]
mod uart_rx;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[cortex_m_rt::entry]
fn main() -> ! {
    // One figure: there is no memory for several.
    board_common::run_emulated::<flash::Flash, _, 1>(CLIPS, board::new())
}
