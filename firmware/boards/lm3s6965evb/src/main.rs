//! Pantin on QEMU's lm3s6965evb: plays the clip that it was built with.
#![no_std]
#![no_main]

mod board;
mod buttons;
mod display;
mod faults;
mod registers;

use board::{Lm3s, Oled};
use cortex_m_rt::entry;
use defmt_semihosting as _;
use faults::Code;
use pantin_app::{Exit, Options};
use pantin_figure::surface::Frame;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like.
const CHANNELS: usize = 192;
const MOVING: usize = 104;
const JOINTS: usize = 40;

#[entry]
fn main() -> ! {
    faults::guard_stack();
    let mut frame = Frame::<Oled>::new();
    let exit = pantin_app::run::<_, CHANNELS, MOVING, JOINTS>(CLIPS, options(), &mut frame, &mut Lm3s::new());
    faults::exit(match exit {
        Exit::Done => Code::Done,
        Exit::BadClip => Code::BadClip,
    })
}

/// What the emulator's command line asks for.
fn options() -> Options {
    const ROOM: usize = 1024;
    match semihosting::experimental::env::args::<ROOM>() {
        Ok(words) => Options::parse((&words).into_iter().flatten()),
        Err(_) => Options::parse([]),
    }
}
