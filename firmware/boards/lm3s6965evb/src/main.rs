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
use heapless::Vec;
use pantin_app::{Exit, Options, Seat};
use pantin_figure::surface::Frame;

include!(concat!(env!("OUT_DIR"), "/clips.rs"));

/// Most channels of a clip, most of them that move, and most joints of a figure without fingers and the like.
const CHANNELS: usize = 192;
const MOVING: usize = 104;
const JOINTS: usize = 40;
/// Most figures side by side.
const SEATS: usize = 4;

#[entry]
fn main() -> ! {
    faults::guard_stack();
    let (options, mut frame, mut board) = (options(), Frame::<Oled>::new(), Lm3s::new());
    let exit = match options.figures {
        ..2 => pantin_app::run::<_, CHANNELS, MOVING, JOINTS>(CLIPS, options, &mut frame, &mut board),
        _ => crowd(options, &mut frame, &mut board),
    };
    faults::exit(match exit {
        Exit::Done => Code::Done,
        Exit::BadClip => Code::BadClip,
    })
}

/// In a function of its own: the seats take memory only where several figures are asked for.
#[inline(never)]
fn crowd(options: Options, frame: &mut Frame<Oled>, board: &mut Lm3s) -> Exit {
    let mut seats = Vec::<Seat<_, CHANNELS, MOVING, JOINTS>, SEATS>::new();
    while seats.len() < options.figures && !seats.is_full() {
        let _ = seats.push(Seat::empty());
    }
    pantin_app::crowd(CLIPS, options, &mut seats, frame, board)
}

/// What the emulator's command line asks for.
fn options() -> Options {
    const ROOM: usize = 1024;
    match semihosting::experimental::env::args::<ROOM>() {
        Ok(words) => Options::parse((&words).into_iter().flatten()),
        Err(_) => Options::parse([]),
    }
}
