//! A board to copy: docs/BOARDS.md says how. The program builds and links as it is; its board has no display yet.
#![no_std]
#![no_main]

mod board;
mod panic;
mod placeholder;

use board_common::{NoFlash, run_forever};
// YOUR BOARD: `use CRATE as _;` until `board.rs` uses the chip's crate, which brings the interrupt vectors.

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[cortex_m_rt::entry]
fn main() -> ! {
    run_forever::<NoFlash, _>(CLIPS, board::new())
}
