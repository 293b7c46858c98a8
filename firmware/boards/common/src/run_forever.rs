//! The program on a board that one can hold: it plays forever, and its display shows an error if a clip cannot be played.

use crate::Flash;
use core::fmt::Write;
use pantin::Clip;
use pantin_app::{Board, Entry, Exit, Mode, Options, TextScreen, run};
use pantin_figure::surface::Framebuffer;

/// If this byte is received before the first picture, the program plays one frame per request ([`Mode::Sync`]); when that ends, it starts
/// again. It is ASCII's "synchronous idle".
pub const IN_STEP: u8 = 0x16;

/// The time between two readings of the buttons and the serial line while an error is shown.
const ERROR_PERIOD_NS: u32 = 100_000_000;

/// Plays the clips at their own frame rates, forever: first the clip that the flash `F` stores, if there is one, then those that the program
/// was built with. If a clip cannot be played, the display shows why until a byte is received or a button pressed; then the program starts again.
///
/// Without the feature `update`, `F` is not used. With the feature `link`, the figure takes the poses that arrive over the serial line instead.
pub fn run_forever<F: Flash, B: Board>(clips: &[Entry], mut board: B) -> ! {
    let mut framebuffer = Framebuffer::new();
    #[cfg(feature = "update")]
    if let Some(mut store) = crate::flash::store::<F>() {
        loop {
            let options = options(&mut board);
            if pantin_app::run_stored(&mut store, clips, options, &mut framebuffer, &mut board) == Exit::BadClip {
                show_error(clips, &mut framebuffer, &mut board);
            }
        }
    }
    loop {
        let options = options(&mut board);
        if clips.is_empty() || run(clips, options, &mut framebuffer, &mut board) == Exit::BadClip {
            show_error(clips, &mut framebuffer, &mut board);
        }
    }
}

fn options<B: Board>(board: &mut B) -> Options {
    let mode = if board.poll() == Some(IN_STEP) { Mode::Sync } else { Mode::Play };
    Options {
        mode,
        #[cfg(feature = "solid")]
        solid: true,
        #[cfg(feature = "solid")]
        look: crate::LOOK,
        #[cfg(feature = "neck")]
        neck: true,
        #[cfg(feature = "link")]
        link: true,
        ..Options::parse([])
    }
}

#[inline(never)]
fn show_error<B: Board>(clips: &[Entry], framebuffer: &mut Framebuffer<B::Layout>, board: &mut B) {
    let mut screen = TextScreen::new(framebuffer);
    let bad = clips.iter().find_map(|entry| Some((entry.name, Clip::with_rig(entry.bytes, entry.rig).err()?)));
    // Writing on a text screen cannot fail.
    let _ = match bad {
        Some((name, error)) => write!(screen, "{name}\ncannot be played:\n{error}"),
        None if clips.is_empty() => write!(screen, "There is no clip."),
        None => write!(screen, "A clip is too big for this board."),
    };
    board.start_timer(ERROR_PERIOD_NS);
    while board.poll().is_none() && board.button().is_none() {
        board.present(framebuffer);
        board.wait_ticks();
    }
}
