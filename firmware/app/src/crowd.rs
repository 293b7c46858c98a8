//! Several figures at once, each with its own clip and phase, side by side.

use crate::board::{Board, Exit};
use crate::log::error;
use crate::options::{Mode, Options};
use crate::run::{Wishes, listen, set_up, show};
use crate::scene::{Entry, Scene};
use crate::update::Listener;
use heapless::Vec;
use pantin::{ChannelState, Clip, Player};
use pantin_figure::rotation::Turning;
use pantin_figure::surface::{Frame, Layout};
use pantin_figure::{Canvas, Stage};

/// Most figures.
pub const FIGURES: usize = 16;

/// Room for one figure: see [`crate::run`] for the numbers.
pub struct Seat<R: Turning, const CHANNELS: usize, const MOVING: usize, const JOINTS: usize> {
    states: [ChannelState; MOVING],
    pose: [i32; CHANNELS],
    stage: Stage<JOINTS, R>,
}

impl<R: Turning, const CHANNELS: usize, const MOVING: usize, const JOINTS: usize> Seat<R, CHANNELS, MOVING, JOINTS> {
    /// Nobody sits there.
    #[inline(always)]
    pub fn empty() -> Self {
        Seat { states: [ChannelState::default(); MOVING], pose: [0; CHANNELS], stage: Stage::empty() }
    }
}

/// A figure on its seat.
struct Actor<'a, R: Turning, const JOINTS: usize> {
    player: Player<'a, 'a>,
    stage: &'a mut Stage<JOINTS, R>,
}

/// Plays a clip a seat until the mode's end: the clips in turn, each round of them begun a little later. Time is the first clip's; of the
/// keys, those that change how figures are drawn work.
#[inline(never)]
pub fn crowd<B: Board, const CHANNELS: usize, const MOVING: usize, const JOINTS: usize>(
    entries: &[Entry],
    options: Options,
    seats: &mut [Seat<B::Turning, CHANNELS, MOVING, JOINTS>],
    frame: &mut Frame<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut scene = Scene::new(&options);
    let mut actors: Vec<Actor<B::Turning, JOINTS>, FIGURES> = Vec::new();
    let count = seats.len().min(FIGURES);
    for (index, (seat, entry)) in seats.iter_mut().zip(entries.iter().cycle()).take(count).enumerate() {
        let clip = match Clip::new_checked(entry.bytes) {
            Ok(clip) => clip,
            Err(error) => {
                error!("a clip cannot be opened: {}", error);
                return Exit::BadClip;
            }
        };
        let mut player = match Player::new(clip, &mut seat.states, &mut seat.pose) {
            Ok(player) => player,
            Err(error) => {
                error!("a clip is too big: {}", error);
                return Exit::BadClip;
            }
        };
        if let Err(error) = sit(&mut seat.stage, &mut player, &scene, [index, count], [B::Layout::WIDTH, B::Layout::HEIGHT]) {
            error!("a rig is too big: {}", error);
            return Exit::BadClip;
        }
        player.seek(clip.frames() / count as u32 * index as u32);
        // There is room for as many.
        let _ = actors.push(Actor { player, stage: &mut seat.stage });
    }
    play(&mut actors, &options, &mut scene, frame, board);
    Exit::Done
}

/// Sets a figure up in its column: the display's height, and half as wide again as its share.
#[inline(never)]
fn sit<R: Turning, const JOINTS: usize>(
    stage: &mut Stage<JOINTS, R>,
    player: &mut Player,
    scene: &Scene,
    [index, count]: [usize; 2],
    [width, height]: [usize; 2],
) -> Result<(), pantin_figure::Error> {
    let share = width / count;
    let canvas = Canvas { width: (share * 3 / 2) as u16, height: height as u16 };
    set_up(stage, player, canvas)?;
    stage.aim(player, scene.view);
    stage.shift((share * index + share / 2) as i16 - (canvas.width / 2) as i16, 0);
    Ok(())
}

fn play<B: Board, const JOINTS: usize>(
    actors: &mut [Actor<B::Turning, JOINTS>],
    options: &Options,
    scene: &mut Scene,
    frame: &mut Frame<B::Layout>,
    board: &mut B,
) {
    let mut wishes = Wishes::new();
    let (mut due, mut shown) = (0, 0u32);
    if let (Some(first), true) = (actors.first(), options.mode != Mode::Sync) {
        board.start_timer(first.player.clip().frame_time_ns());
    }
    loop {
        decode(actors, due, board);
        place(actors, board);
        draw(actors, scene, frame, board);
        show(frame, board);
        shown = shown.wrapping_add(1);
        due = match options.mode {
            Mode::Sync => {
                let number = actors.first().map_or(0, |first| first.player.frame());
                if !listen(number, scene, &mut wishes, &mut Listener::default(), board) {
                    return;
                }
                1
            }
            Mode::Frames(count) if shown >= count => return,
            Mode::Frames(_) | Mode::Play => board.wait_ticks(),
        };
        wishes.clear();
    }
}

#[inline(never)]
fn decode<B: Board, const JOINTS: usize>(actors: &mut [Actor<B::Turning, JOINTS>], frames: u32, board: &mut B) {
    board.mark_start();
    for actor in actors {
        (0..frames).for_each(|_| actor.player.step());
    }
    board.mark_stop();
}

#[inline(never)]
fn place<B: Board, const JOINTS: usize>(actors: &mut [Actor<B::Turning, JOINTS>], board: &mut B) {
    board.mark_start();
    for actor in actors {
        actor.stage.place(actor.player.pose());
    }
    board.mark_stop();
}

#[inline(never)]
fn draw<B: Board, const JOINTS: usize>(
    actors: &mut [Actor<B::Turning, JOINTS>],
    scene: &Scene,
    frame: &mut Frame<B::Layout>,
    board: &mut B,
) {
    board.mark_start();
    frame.clear();
    for actor in actors {
        actor.stage.draw_on(frame, scene.look);
    }
    board.mark_stop();
}
