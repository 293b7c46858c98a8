//! Pantin on the Raspberry Pi Pico 2: plays the clips that it was built with.
#![no_std]
#![no_main]

use pico2::board;
use rp235x_hal::pac::Peripherals;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[rp235x_hal::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    board_common::run_forever::<board_common::NoFlash, _>(CLIPS, board::new(parts))
}
