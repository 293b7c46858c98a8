//! Pantin on the Raspberry Pi Pico: plays the clips that it was built with.
#![no_std]
#![no_main]

use board_common::run_forever;
use pico::{board, flash::Flash};
use rp2040_hal::pac::Peripherals;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[rp2040_hal::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes the peripherals") };
    run_forever::<Flash, _>(CLIPS, board::new(parts))
}
