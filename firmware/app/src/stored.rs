//! The program of a board with a store: what is stored comes before the built-in clips, and can be replaced over the serial line. It is a clip, or with the
//! feature `bank` also a bank.

use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::options::Options;
use crate::run::{Task, open};
use crate::session::{Entry, Outcome, PlayContext};
use crate::update::Listener;
use crate::view_state::ViewState;
use pantin_figure::surface::Framebuffer;
use pantin_store::{Slot, Store, StoredClip, Update};

/// Plays the stored clip, or the clips of the stored bank, then the built-in ones, as [`run`](crate::run()) does. A clip that arrives over the serial line is stored and played
/// from its first frame. One that this board cannot play is refused, and the current clip plays on.
pub fn run_stored<B: Board, S: Slot>(
    store: &mut Store<S>,
    entries: &[Entry],
    options: Options,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut view_state = ViewState::new(&options);
    loop {
        let (stored, mut update) = Update::open(store);
        let context = StoredContext { options, view_state: &mut view_state, framebuffer, board };
        if let Some(exit) = until_replaced(stored, &mut update, entries, context) {
            return exit;
        }
    }
}

/// What all clips are played with.
struct StoredContext<'a, B: Board> {
    options: Options,
    view_state: &'a mut ViewState,
    framebuffer: &'a mut Framebuffer<B::Layout>,
    board: &'a mut B,
}

impl<B: Board> StoredContext<'_, B> {
    /// Lends it to one clip.
    fn lend<'s>(&'s mut self, listener: Listener<'s>) -> PlayContext<'s, B> {
        let StoredContext { options, view_state, framebuffer, board } = self;
        PlayContext { mode: options.mode, view_state, framebuffer, board, listener }
    }
}

/// Returns a stored clip: there is one, or as many as the bank has.
fn entry<'a>(stored: &'a StoredClip, at: usize) -> Option<Entry<'a>> {
    #[cfg(feature = "bank")]
    if let Ok(bank) = pantin::Bank::new_checked(stored.bytes) {
        let clip = bank.entries().nth(at)?;
        return Some(Entry { name: clip.name(), bytes: clip.bytes(), rig: bank.rig_bytes() });
    }
    (at == 0).then_some(Entry { name: stored.info.name.as_str(), bytes: stored.bytes, rig: &[] })
}

/// Returns the number of clips that are stored.
fn count(stored: &StoredClip) -> usize {
    #[cfg(feature = "bank")]
    if let Ok(bank) = pantin::Bank::new_checked(stored.bytes) {
        return bank.len();
    }
    let _ = stored;
    1
}

/// Plays until the program ends. Returns `None` if a new clip was stored.
fn until_replaced<B: Board, S: Slot>(
    stored: Option<StoredClip>,
    update: &mut Update<S>,
    entries: &[Entry],
    mut stored_context: StoredContext<B>,
) -> Option<Exit> {
    let mut own = stored.as_ref().map_or(0, count);
    let (mut at, mut from) = (0usize, 0);
    while let Some(entry) = match at.checked_sub(own) {
        Some(at) => entries.get(at).copied(),
        None => stored.as_ref().and_then(|stored| entry(stored, at)),
    } {
        stored_context.view_state.idle.several = own + entries.len() > 1;
        let mut context = stored_context.lend(Listener { update: Some(update) });
        match open(&entry, Task::Play { from }, &mut context) {
            Outcome::Clip(steps) => {
                let count = (entries.len() + own) as i32;
                (at, from) = ((at as i32 + steps).checked_rem_euclid(count)? as usize, 0);
            }
            Outcome::Received(frame) => {
                let playable = is_playable(update, &mut stored_context);
                if update.finish(playable, |bytes| stored_context.board.send(bytes)) {
                    info!("a new clip is stored");
                    return None;
                }
                error!("the clip that arrived is refused");
                from = frame;
            }
            // Flash may have been written with a clip that is too big for the board, which then plays its own.
            Outcome::Exit(Exit::BadClip) if at < own => (own, at) = (0, 0),
            Outcome::Exit(exit) => return Some(exit),
            Outcome::Playable => {}
        }
    }
    Some(Exit::Done)
}

/// Returns whether the board can play what arrived, by setting every clip up.
#[inline(never)]
fn is_playable<B: Board, S: Slot>(update: &Update<S>, stored_context: &mut StoredContext<B>) -> bool {
    let Some(candidate) = update.candidate() else { return false };
    let mut is_playable = |at: usize| {
        let entry = entry(&candidate, at);
        entry.is_some_and(|entry| {
            matches!(open(&entry, Task::Check, &mut stored_context.lend(Listener::default())), Outcome::Playable)
        })
    };
    (0..count(&candidate)).all(&mut is_playable)
}
