//! The program in an emulator, whose command line has its options.

use crate::Flash;
use crate::exit::{Code, exit};
#[cfg(feature = "several")]
use heapless::Vec;
use pantin_app::{Board, Entry, Exit, Options, run};
#[cfg(feature = "several")]
use pantin_app::{FigureBuffers, multi};
use pantin_figure::surface::Framebuffer;
#[allow(deprecated)]
use semihosting::sys::arm_compat::{CommandLine, sys_get_cmdline};

/// Most bytes of a command line. A longer one counts as empty. An emulator without arguments passes the program's path.
const COMMAND_LINE_BYTES: usize = 512;

/// Plays the clips as the command line says, and ends the emulator: first the clip that the flash `F` stores, if there is one.
///
/// Without the feature `update`, `F` is not used. `FIGURES` is the most figures side by side.
pub fn run_emulated<F: Flash, B: Board, const FIGURES: usize>(clips: &[Entry], mut board: B) -> ! {
    let (options, mut framebuffer) = (options(), Framebuffer::new());
    #[cfg(feature = "update")]
    if let Some(mut store) = crate::flash::store::<F>() {
        exit(pantin_app::run_stored(&mut store, clips, options, &mut framebuffer, &mut board).into())
    }
    #[cfg(feature = "several")]
    if options.figures > 1 {
        exit(several::<B, FIGURES>(clips, options, &mut framebuffer, &mut board).into())
    }
    exit(run(clips, options, &mut framebuffer, &mut board).into())
}

// Not inlined: the buffers are on the stack only where several figures are asked for.
#[cfg(feature = "several")]
#[inline(never)]
fn several<B: Board, const FIGURES: usize>(
    clips: &[Entry],
    options: Options,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut buffers = Vec::<FigureBuffers<B>, FIGURES>::new();
    while buffers.len() < options.figures && !buffers.is_full() {
        let _ = buffers.push(FigureBuffers::empty());
    }
    multi(clips, options, &mut buffers, framebuffer, board)
}

// Not inlined: the buffer leaves the stack.
#[inline(never)]
pub(crate) fn options() -> Options {
    let mut buffer = [0; COMMAND_LINE_BYTES];
    let mut line = CommandLine { ptr: buffer.as_mut_ptr(), size: COMMAND_LINE_BYTES };
    // Safety: the buffer is as large as it says and lives until the line has been read.
    // The library's safe call slices, and so links panics.
    #[allow(unsafe_code, deprecated)]
    let read = unsafe { sys_get_cmdline(&mut line) };
    let text = read.ok().and_then(|()| core::str::from_utf8(buffer.get(..line.size)?).ok());
    Options {
        #[cfg(feature = "solid")]
        look: crate::LOOK,
        #[cfg(all(feature = "meet", feature = "solid"))]
        other_look: crate::OTHER_LOOK,
        ..Options::parse(text.unwrap_or("").split(' '))
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
