//! Pantin on QEMU's lm3s6965evb: plays the clip that it was built with.
#![no_std]
#![no_main]

mod board;
mod display;
mod faults;
mod registers;

use board::Lm3s;
use cortex_m_rt::entry;
use defmt_semihosting as _;
use faults::Code;
use pantin_app::{Exit, Options};

static CLIP: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/clip.ptn"));

#[entry]
fn main() -> ! {
    faults::guard_stack();
    let exit = pantin_app::run(CLIP, options(), &mut Lm3s::new());
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
