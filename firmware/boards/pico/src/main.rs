//! Pantin on the Raspberry Pi Pico: plays the clips that it was built with.
#![no_std]
#![no_main]

use pantin_figure::surface::Frame;
use pico::{Lit, Pico};
use rp2040_hal::pac::Peripherals;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like.
const CHANNELS: usize = 400;
const MOVING: usize = 320;
const JOINTS: usize = 80;

#[rp2040_hal::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes them") };
    let mut frame = Frame::<Lit>::new();
    let mut board = Pico::new(parts);
    #[cfg(feature = "update")]
    if let Some(mut store) = board_common::store::<pico::Rom>() {
        board_common::perform_stored::<_, _, CHANNELS, MOVING, JOINTS>(&mut store, CLIPS, &mut frame, &mut board)
    }
    board_common::perform::<_, CHANNELS, MOVING, JOINTS>(CLIPS, &mut frame, &mut board)
}
