//! The program, with what the emulator's command line asks for.

use crate::end::{Code, exit};
use pantin_app::{Board, Entry, Exit, Options, run};
use pantin_figure::surface::Frame;

/// Letters of a command line: an emulator without arguments gives the program's own path, and a longer one counts as none.
const ROOM: usize = 512;

/// Plays the clips, and ends the emulator. The numbers are those of [`run`].
pub fn play<B: Board, const CHANNELS: usize, const MOVING: usize, const JOINTS: usize>(
    clips: &[Entry],
    frame: &mut Frame<B::Layout>,
    board: &mut B,
) -> ! {
    exit(match run::<B, CHANNELS, MOVING, JOINTS>(clips, options(), frame, board) {
        Exit::Done => Code::Done,
        Exit::BadClip => Code::BadClip,
    })
}

/// In a function of its own: the room is given back.
#[inline(never)]
fn options() -> Options {
    match semihosting::experimental::env::args::<ROOM>() {
        Ok(words) => Options::parse((&words).into_iter().flatten()),
        Err(_) => Options::parse([]),
    }
}
