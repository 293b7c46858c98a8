//! The program: open a clip, then decode, place, draw and show frame by frame, and take what is asked for in between.

use crate::board::{Board, Exit};
use crate::capacity::Capacity;
use crate::commands::{Command, LETTERS};
use crate::content::{self, Content};
use crate::hud;
use crate::log::{error, info};
use crate::options::{Mode, Options};
use crate::update::Listener;
use crate::view_state::{Effect, Entry, ViewState};
use heapless::Deque;
use pantin::{Clip, Player};
use pantin_figure::surface::Framebuffer;

/// In [`Mode::Sync`]: asks for the next picture. Any letter of [`LETTERS`] may come before it.
pub const NEXT: u8 = b'\n';
/// Ends the program.
pub const QUIT: u8 = b'q';
/// In [`Mode::Sync`]: a picture is on the display; its frame's number follows, in 4 bytes, the least first.
pub const SHOWN: u8 = b'F';

/// Wishes that wait to be granted.
pub(crate) type Effects = Deque<Effect, 8>;

/// Where to go when a clip is left.
pub(crate) enum Outcome {
    Clip(i32),
    Exit(Exit),
    /// A clip came over the line, at this frame.
    #[cfg(feature = "update")]
    Whole(u32),
    /// It can be played.
    #[cfg(feature = "update")]
    Ready,
}

/// Plays clips until the mode's end. Without a clip it returns at once.
///
/// Returns [`Exit::BadClip`] for a clip that is damaged or larger than [`Board::Capacity`].
pub fn run<B: Board>(entries: &[Entry], options: Options, frame: &mut Framebuffer<B::Layout>, board: &mut B) -> Exit {
    let mut view_state = ViewState::new(&options);
    let mut at = 0;
    while let Some(entry) = entries.get(at) {
        let context = PlayContext {
            entry,
            mode: options.mode,
            view_state: &mut view_state,
            frame,
            board,
            listener: Listener::default(),
            #[cfg(feature = "update")]
            start: 0,
            #[cfg(feature = "update")]
            trial: false,
        };
        match perform(context) {
            Outcome::Clip(steps) => at = (at as i32 + steps).rem_euclid(entries.len() as i32) as usize,
            Outcome::Exit(exit) => return exit,
            #[cfg(feature = "update")]
            Outcome::Whole(_) | Outcome::Ready => {}
        }
    }
    Exit::Done
}

/// What a clip is played with.
pub(crate) struct PlayContext<'a, B: Board> {
    pub entry: &'a Entry<'a>,
    pub mode: Mode,
    pub view_state: &'a mut ViewState,
    pub frame: &'a mut Framebuffer<B::Layout>,
    pub board: &'a mut B,
    /// Who listens for a clip that is to replace this one.
    pub listener: Listener<'a>,
    /// The frame to begin with.
    #[cfg(feature = "update")]
    pub start: u32,
    /// Only whether it can be played is asked.
    #[cfg(feature = "update")]
    pub trial: bool,
}

pub(crate) fn perform<B: Board>(context: PlayContext<B>) -> Outcome {
    let clip = match Clip::new_checked(context.entry.bytes) {
        Ok(clip) => clip,
        Err(error) => {
            error!("the clip cannot be opened: {}", error);
            return Outcome::Exit(Exit::BadClip);
        }
    };
    let (mut states, mut pose) = (B::Capacity::states(), B::Capacity::pose());
    let mut player = match Player::new(clip, states.as_mut(), pose.as_mut()) {
        Ok(player) => player,
        Err(error) => {
            error!("the clip is too big: {}", error);
            return Outcome::Exit(Exit::BadClip);
        }
    };
    content::build(&mut player, context)
}

/// Plays what is set up; with faces `S` is any, and this is compiled once for all of them.
#[inline(never)]
pub(crate) fn play<B: Board, S: Content<B::Layout> + ?Sized>(
    player: &mut Player,
    renderer: &mut S,
    context: PlayContext<B>,
) -> Outcome {
    #[cfg(feature = "update")]
    {
        if context.trial {
            return Outcome::Ready;
        }
        player.seek(context.start);
    }
    #[cfg(feature = "link")]
    if context.view_state.link {
        return crate::link::play(player, renderer, context);
    }
    let PlayContext { entry, mode, view_state, frame, board, mut listener, .. } = context;
    let (mut due, mut shown, mut late) = (0, 0u32, 0u32);
    let mut effects = Effects::new();
    if mode != Mode::Sync {
        board.start_timer(view_state.tick_ns(player.clip().frame_time_ns()));
    }
    loop {
        decode(player, due, board);
        place(player, renderer, board);
        draw(renderer, view_state, frame, board);
        if view_state.hud {
            hud::draw(view_state, entry, [player.frame(), player.clip().frames()], frame);
        }
        show(frame, board);
        shown = shown.wrapping_add(1);
        listener.picture();
        due = match mode {
            Mode::Sync => match listen(player.frame(), view_state, &mut effects, &mut listener, board) {
                true => view_state.frames(1),
                false => break,
            },
            Mode::Frames(count) if shown >= count => break,
            Mode::Frames(_) | Mode::Play => {
                // The clip keeps its time on a board that is too slow for every frame.
                let ticks = board.wait_ticks();
                late = late.wrapping_add(ticks - 1);
                while let Some(key) = board.button().or_else(|| Command::from_letter(listener.poll(board)?)) {
                    // More keys than fit between two pictures are a mistake of theirs.
                    let _ = effects.push_back(view_state.take(key));
                }
                view_state.frames(if mode == Mode::Play { ticks } else { 1 })
            }
        };
        #[cfg(feature = "update")]
        if listener.is_whole() {
            return Outcome::Whole(player.frame());
        }
        while let Some(effect) = effects.pop_front() {
            match effect {
                Effect::Nothing => {}
                Effect::Aim => {
                    renderer.aim(player, view_state.view);
                }
                Effect::Pace if mode == Mode::Sync => {}
                Effect::Pace => board.start_timer(view_state.tick_ns(player.clip().frame_time_ns())),
                Effect::Move(frames) => due = frames,
                Effect::Clip(steps) => return Outcome::Clip(steps),
                Effect::Help => help(board),
            }
        }
    }
    info!("{} pictures, {} ticks late", shown, late);
    Outcome::Exit(Exit::Done)
}

/// Tells the other end of the line which frame is on the display, and takes its keys; whether it wants another picture, or a clip came whole.
#[inline(never)]
pub(crate) fn listen<B: Board>(
    frame: u32,
    view_state: &mut ViewState,
    effects: &mut Effects,
    listener: &mut Listener,
    board: &mut B,
) -> bool {
    board.send(&[SHOWN]);
    board.send(&frame.to_le_bytes());
    while !listener.is_whole() {
        let byte = board.receive();
        match listener.letter(byte, board) {
            Some(NEXT) => return true,
            Some(QUIT) => return false,
            Some(letter) => {
                if let Some(key) = Command::from_letter(letter) {
                    let _ = effects.push_back(view_state.take(key));
                }
            }
            None => {}
        }
    }
    true
}

/// The letters and what they do, a line each.
#[inline(never)]
fn help<B: Board>(board: &mut B) {
    for (letter, _, words) in LETTERS {
        board.send(&[letter, b' ']);
        board.send(words.as_bytes());
        board.send(b"\r\n");
    }
}

#[inline(never)]
fn decode<B: Board>(player: &mut Player, frames: i32, board: &mut B) {
    board.mark_start();
    for _ in 0..frames {
        player.step();
    }
    for _ in frames..0 {
        let last = player.clip().frames() - 1;
        player.seek(player.frame().checked_sub(1).unwrap_or(last));
    }
    board.mark_stop();
}

#[inline(never)]
fn place<B: Board, S: Content<B::Layout> + ?Sized>(player: &Player, renderer: &mut S, board: &mut B) {
    board.mark_start();
    renderer.set_pose(player.pose());
    board.mark_stop();
}

#[inline(never)]
fn draw<B: Board, S: Content<B::Layout> + ?Sized>(
    renderer: &mut S,
    view_state: &ViewState,
    frame: &mut Framebuffer<B::Layout>,
    board: &mut B,
) {
    board.mark_start();
    frame.clear();
    renderer.draw(frame, view_state.style);
    board.mark_stop();
}

#[inline(never)]
pub(crate) fn show<B: Board>(frame: &mut Framebuffer<B::Layout>, board: &mut B) {
    board.mark_start();
    board.present(frame);
    board.mark_stop();
}
