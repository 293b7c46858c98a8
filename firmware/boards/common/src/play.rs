//! The program, with what the emulator's command line asks for.

use crate::end::{Code, exit};
#[cfg(feature = "several")]
use heapless::Vec;
use pantin_app::{Board, Entry, Exit, Options, run};
#[cfg(feature = "several")]
use pantin_app::{FigureBuffers, multi};
use pantin_figure::surface::Framebuffer;
#[allow(deprecated)]
use semihosting::sys::arm_compat::{CommandLine, sys_get_cmdline};

/// Letters of a command line: an emulator without arguments gives the program's own path, and a longer one counts as none.
const ROOM: usize = 512;

/// Plays the clips, and ends the emulator. `SEATS` is the most figures side by side.
pub fn play<B: Board, const SEATS: usize>(clips: &[Entry], frame: &mut Framebuffer<B::Layout>, board: &mut B) -> ! {
    let options = options();
    #[cfg(feature = "several")]
    if options.figures > 1 {
        exit(several::<B, SEATS>(clips, options, frame, board).into())
    }
    exit(run(clips, options, frame, board).into())
}

/// The same with a store, whose clip comes first.
#[cfg(feature = "update")]
pub fn play_stored<B: Board, S: pantin_store::Slot>(
    store: &mut pantin_store::Store<S>,
    clips: &[Entry],
    frame: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> ! {
    exit(pantin_app::run_stored(store, clips, options(), frame, board).into())
}

/// In a function of its own: the seats take memory only where several figures are asked for.
#[cfg(feature = "several")]
#[inline(never)]
fn several<B: Board, const SEATS: usize>(
    clips: &[Entry],
    options: Options,
    frame: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut seats = Vec::<FigureBuffers<B>, SEATS>::new();
    while seats.len() < options.figures && !seats.is_full() {
        let _ = seats.push(FigureBuffers::empty());
    }
    multi(clips, options, &mut seats, frame, board)
}

/// In a function of its own: the room is given back.
#[inline(never)]
fn options() -> Options {
    let mut room = [0; ROOM];
    let mut line = CommandLine { ptr: room.as_mut_ptr(), size: ROOM };
    // Safety: the room is as large as it says and lives until the line has been read.
    // The safer call that the library has beside it slices, and so brings in panics.
    #[allow(unsafe_code, deprecated)]
    let told = unsafe { sys_get_cmdline(&mut line) };
    let text = told.ok().and_then(|()| core::str::from_utf8(room.get(..line.size)?).ok());
    Options::parse(text.unwrap_or("").split(' '))
}

impl From<Exit> for Code {
    fn from(exit: Exit) -> Code {
        match exit {
            Exit::Done => Code::Done,
            Exit::BadClip => Code::BadClip,
        }
    }
}
