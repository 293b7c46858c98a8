//! Pantin on the Raspberry Pi Pico: plays the clips that it was built with.
#![no_std]
#![no_main]

use pantin_figure::surface::Framebuffer;
use pico::{Lit, Pico};
use rp2040_hal::pac::Peripherals;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[rp2040_hal::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes them") };
    let mut frame = Framebuffer::<Lit>::new();
    let mut board = Pico::new(parts);
    #[cfg(feature = "update")]
    if let Some(mut store) = board_common::store::<pico::Rom>() {
        board_common::perform_stored(&mut store, CLIPS, &mut frame, &mut board)
    }
    board_common::perform(CLIPS, &mut frame, &mut board)
}
