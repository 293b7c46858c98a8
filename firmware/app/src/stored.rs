//! The program of a board with a store: the clip in it comes before those that the board was built with, and may be replaced over the line.

use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::options::Options;
use crate::run::{Outcome, PlayContext, perform};
use crate::update::Listener;
use crate::view_state::{Entry, ViewState};
use pantin_figure::surface::Framebuffer;
use pantin_store::{Slot, Store, StoredClip, Update};

/// What [`run`](crate::run) does, with a store. A clip that came is played from its first frame; one that this board cannot play is refused,
/// and the one before goes on where it was.
pub fn run_stored<B: Board, S: Slot>(
    store: &mut Store<S>,
    entries: &[Entry],
    options: Options,
    frame: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut view_state = ViewState::new(&options);
    loop {
        let (stored, mut update) = Update::open(store);
        let context = StoredContext { options, view_state: &mut view_state, frame, board };
        if let Some(exit) = until_sealed(stored, &mut update, entries, context) {
            return exit;
        }
    }
}

/// What clips are played on.
struct StoredContext<'a, B: Board> {
    options: Options,
    view_state: &'a mut ViewState,
    frame: &'a mut Framebuffer<B::Layout>,
    board: &'a mut B,
}

impl<B: Board> StoredContext<'_, B> {
    /// One clip on it.
    fn context<'s>(&'s mut self, entry: &'s Entry<'s>, start: u32, listener: Listener<'s>) -> PlayContext<'s, B> {
        let StoredContext { options, view_state, frame, board } = self;
        PlayContext { entry, mode: options.mode, view_state, frame, board, start, listener, trial: false }
    }
}

fn entry<'a>(stored: &'a StoredClip) -> Entry<'a> {
    Entry { name: stored.info.name.as_str(), bytes: stored.bytes }
}

/// Plays until the program ends, or a new clip is sealed: then none.
fn until_sealed<B: Board, S: Slot>(
    stored: Option<StoredClip>,
    update: &mut Update<S>,
    entries: &[Entry],
    mut stored_context: StoredContext<B>,
) -> Option<Exit> {
    let mut own = stored.as_ref().map(entry);
    let (mut at, mut start) = (0, 0);
    while let Some(entry) = own.as_ref().into_iter().chain(entries).nth(at) {
        let context = stored_context.context(entry, start, Listener { over: Some(update) });
        match perform(context) {
            Outcome::Clip(steps) => {
                let count = (entries.len() + usize::from(own.is_some())) as i32;
                (at, start) = ((at as i32 + steps).checked_rem_euclid(count)? as usize, 0);
            }
            Outcome::Whole(frame) => {
                let playable = try_out(update, &mut stored_context);
                if update.finish(playable, |bytes| stored_context.board.send(bytes)) {
                    info!("a new clip");
                    return None;
                }
                error!("a clip came and is refused");
                start = frame;
            }
            // Flashed with a clip that is too much for it, a board plays its own.
            Outcome::Exit(Exit::BadClip) if at == 0 && own.is_some() => own = None,
            Outcome::Exit(exit) => return Some(exit),
            Outcome::Ready => {}
        }
    }
    Some(Exit::Done)
}

/// Whether the board can play the clip that came: it is set up as if it were to be played.
#[inline(never)]
fn try_out<B: Board, S: Slot>(update: &Update<S>, stored_context: &mut StoredContext<B>) -> bool {
    let Some(candidate) = update.candidate() else { return false };
    let entry = entry(&candidate);
    let context = PlayContext { trial: true, ..stored_context.context(&entry, 0, Listener::default()) };
    matches!(perform(context), Outcome::Ready)
}
