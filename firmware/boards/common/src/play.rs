//! The program, with what the emulator's command line asks for.

use crate::end::{Code, exit};
use heapless::Vec;
use pantin_app::{Board, Entry, Exit, Options, Seat, crowd, run};
use pantin_figure::surface::Frame;

/// Letters of a command line: an emulator without arguments gives the program's own path, and a longer one counts as none.
const ROOM: usize = 512;

/// Plays the clips, and ends the emulator. The numbers are those of [`run`], and the most figures side by side.
pub fn play<B: Board, const CHANNELS: usize, const MOVING: usize, const JOINTS: usize, const SEATS: usize>(
    clips: &[Entry],
    frame: &mut Frame<B::Layout>,
    board: &mut B,
) -> ! {
    let options = options();
    exit(
        match options.figures {
            ..2 => run::<B, CHANNELS, MOVING, JOINTS>(clips, options, frame, board),
            _ => several::<B, CHANNELS, MOVING, JOINTS, SEATS>(clips, options, frame, board),
        }
        .into(),
    )
}

/// In a function of its own: the seats take memory only where several figures are asked for.
#[inline(never)]
fn several<B: Board, const CHANNELS: usize, const MOVING: usize, const JOINTS: usize, const SEATS: usize>(
    clips: &[Entry],
    options: Options,
    frame: &mut Frame<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut seats = Vec::<Seat<B::Turning, CHANNELS, MOVING, JOINTS>, SEATS>::new();
    while seats.len() < options.figures && !seats.is_full() {
        let _ = seats.push(Seat::empty());
    }
    crowd(clips, options, &mut seats, frame, board)
}

/// In a function of its own: the room is given back.
#[inline(never)]
fn options() -> Options {
    match semihosting::experimental::env::args::<ROOM>() {
        Ok(words) => Options::parse((&words).into_iter().flatten()),
        Err(_) => Options::parse([]),
    }
}

impl From<Exit> for Code {
    fn from(exit: Exit) -> Code {
        match exit {
            Exit::Done => Code::Done,
            Exit::BadClip => Code::BadClip,
        }
    }
}
