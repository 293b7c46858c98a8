//! The program on a board that one can hold: it plays for ever, and says on the display why it does not.

use core::fmt::Write;
use pantin::Clip;
use pantin_app::{Board, Entry, Exit, Mode, Options, TextScreen, run};
use pantin_figure::surface::Framebuffer;

/// The letter that, sent before the first picture, has the program play in step ([`Mode::Sync`]); its end there begins it anew. ASCII's
/// "synchronous idle".
pub const IN_STEP: u8 = 0x16;

/// How often a clip that does not play is shown again, and letters and buttons looked at.
const PAUSE_NS: u32 = 100_000_000;

/// Plays the clips at their own pace, for ever. Where a clip does not play, the display says so until
/// there is a letter or a button; then it all begins anew.
pub fn perform<B: Board>(clips: &[Entry], frame: &mut Framebuffer<B::Layout>, board: &mut B) -> ! {
    loop {
        let options = options(board);
        if clips.is_empty() || run(clips, options, frame, board) == Exit::BadClip {
            complain(clips, frame, board);
        }
    }
}

/// The same with a store, whose clip comes first.
#[cfg(feature = "update")]
pub fn perform_stored<B: Board, S: pantin_store::Slot>(
    store: &mut pantin_store::Store<S>,
    clips: &[Entry],
    frame: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> ! {
    loop {
        let options = options(board);
        if pantin_app::run_stored(store, clips, options, frame, board) == Exit::BadClip {
            complain(clips, frame, board);
        }
    }
}

fn options<B: Board>(board: &mut B) -> Options {
    let mode = if board.poll() == Some(IN_STEP) { Mode::Sync } else { Mode::Play };
    Options { mode, ..Options::parse([]) }
}

#[inline(never)]
fn complain<B: Board>(clips: &[Entry], frame: &mut Framebuffer<B::Layout>, board: &mut B) {
    let mut page = TextScreen::new(frame);
    let bad = clips.iter().find_map(|entry| Some((entry.name, Clip::new_checked(entry.bytes).err()?)));
    // Writing on a page cannot fail.
    let _ = match bad {
        Some((name, error)) => write!(page, "{name}\ncannot be played:\n{error}"),
        None if clips.is_empty() => write!(page, "There is no clip."),
        None => write!(page, "A clip is too big for this board."),
    };
    board.start_timer(PAUSE_NS);
    while board.poll().is_none() && board.button().is_none() {
        board.present(frame);
        board.wait_ticks();
    }
}
