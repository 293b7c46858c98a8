//! Pantin on the "Black Pill": plays the clips that it was built with.
#![no_std]
#![no_main]

mod board;
mod clocks;
mod display;
#[cfg(feature = "update")]
mod flash;
mod panic;
#[cfg(feature = "update")]
mod received;

use board::BlackPill;
use display::Lit;
use pantin_figure::surface::Framebuffer;
use stm32f4xx_hal::pac::Peripherals;

#[cfg(feature = "defmt")]
use defmt_rtt as _;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(parts) = Peripherals::take() else { unreachable!("nothing else takes them") };
    let mut frame = Framebuffer::<Lit>::new();
    let mut board = BlackPill::new(parts);
    #[cfg(feature = "update")]
    if let Some(mut store) = board_common::store::<flash::Sectors>() {
        board_common::perform_stored(&mut store, CLIPS, &mut frame, &mut board)
    }
    board_common::perform(CLIPS, &mut frame, &mut board)
}
