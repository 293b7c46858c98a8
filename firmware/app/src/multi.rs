//! Several figures at once, each with its own clip and phase, side by side.

use crate::board::{Board, Exit};
use crate::capacity::{Capacity, Figure};
use crate::log::error;
use crate::options::{Mode, Options};
use crate::run::{Effects, listen, show};
use crate::update::Listener;
use crate::view_state::{Entry, ViewState};
use heapless::Vec;
use pantin::{Clip, Player};
use pantin_figure::Canvas;
use pantin_figure::surface::{Framebuffer, Layout};

/// Most figures.
pub const FIGURES: usize = 16;

/// The buffers of one figure.
pub struct FigureBuffers<B: Board> {
    states: <B::Capacity as Capacity>::States,
    pose: <B::Capacity as Capacity>::Pose,
    renderer: Renderer<B>,
}

type Renderer<B> = <<B as Board>::Capacity as Capacity>::Figure<<B as Board>::Rotation>;

impl<B: Board> FigureBuffers<B> {
    /// Makes buffers without a clip.
    #[inline(always)]
    pub fn empty() -> Self {
        FigureBuffers { states: B::Capacity::states(), pose: B::Capacity::pose(), renderer: Figure::empty() }
    }
}

/// A figure and its clip.
struct Actor<'a, B: Board> {
    player: Player<'a, 'a>,
    renderer: &'a mut Renderer<B>,
}

/// Plays a clip a seat until the mode's end: the clips in turn, each round of them begun a little later. Time is the first clip's; of the
/// keys, those that change how figures are drawn work.
#[inline(never)]
pub fn multi<B: Board>(
    entries: &[Entry],
    options: Options,
    buffers: &mut [FigureBuffers<B>],
    frame: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut view_state = ViewState::new(&options);
    let mut actors: Vec<Actor<B>, FIGURES> = Vec::new();
    let count = buffers.len().min(FIGURES);
    for (index, (buffers, entry)) in buffers.iter_mut().zip(entries.iter().cycle()).take(count).enumerate() {
        let clip = match Clip::new_checked(entry.bytes) {
            Ok(clip) => clip,
            Err(error) => {
                error!("a clip cannot be opened: {}", error);
                return Exit::BadClip;
            }
        };
        let mut player = match Player::new(clip, buffers.states.as_mut(), buffers.pose.as_mut()) {
            Ok(player) => player,
            Err(error) => {
                error!("a clip is too big: {}", error);
                return Exit::BadClip;
            }
        };
        if let Err(error) =
            arrange(&mut buffers.renderer, &mut player, &view_state, [index, count], [B::Layout::WIDTH, B::Layout::HEIGHT])
        {
            error!("a rig is too big: {}", error);
            return Exit::BadClip;
        }
        player.seek(clip.frames() / count as u32 * index as u32);
        // There is room for as many.
        let _ = actors.push(Actor { player, renderer: &mut buffers.renderer });
    }
    play(&mut actors, &options, &mut view_state, frame, board);
    Exit::Done
}

/// Sets a figure up in its column: the display's height, and half as wide again as its share.
#[inline(never)]
fn arrange<F: Figure>(
    renderer: &mut F,
    player: &mut Player,
    view_state: &ViewState,
    [index, count]: [usize; 2],
    [width, height]: [usize; 2],
) -> Result<(), pantin_figure::Error> {
    let share = width / count;
    let canvas = Canvas { width: (share * 3 / 2) as u16, height: height as u16 };
    renderer.set_up(player, canvas)?;
    renderer.aim(player, view_state.view);
    renderer.shift((share * index + share / 2) as i16 - (canvas.width / 2) as i16, 0);
    Ok(())
}

fn play<B: Board>(
    actors: &mut [Actor<B>],
    options: &Options,
    view_state: &mut ViewState,
    frame: &mut Framebuffer<B::Layout>,
    board: &mut B,
) {
    let mut effects = Effects::new();
    let (mut due, mut shown) = (0, 0u32);
    if let (Some(first), true) = (actors.first(), options.mode != Mode::Sync) {
        board.start_timer(first.player.clip().frame_time_ns());
    }
    loop {
        decode(actors, due, board);
        place(actors, board);
        draw(actors, view_state, frame, board);
        show(frame, board);
        shown = shown.wrapping_add(1);
        due = match options.mode {
            Mode::Sync => {
                let number = actors.first().map_or(0, |first| first.player.frame());
                if !listen(number, view_state, &mut effects, &mut Listener::default(), board) {
                    return;
                }
                1
            }
            Mode::Frames(count) if shown >= count => return,
            Mode::Frames(_) | Mode::Play => board.wait_ticks(),
        };
        effects.clear();
    }
}

#[inline(never)]
fn decode<B: Board>(actors: &mut [Actor<B>], frames: u32, board: &mut B) {
    board.mark_start();
    for actor in actors {
        (0..frames).for_each(|_| actor.player.step());
    }
    board.mark_stop();
}

#[inline(never)]
fn place<B: Board>(actors: &mut [Actor<B>], board: &mut B) {
    board.mark_start();
    for actor in actors {
        // It is of the clip that the renderer was set up for.
        let _ = actor.renderer.set_pose(actor.player.pose());
    }
    board.mark_stop();
}

#[inline(never)]
fn draw<B: Board>(actors: &mut [Actor<B>], view_state: &ViewState, frame: &mut Framebuffer<B::Layout>, board: &mut B) {
    board.mark_start();
    frame.clear();
    for actor in actors {
        actor.renderer.draw(frame, view_state.style);
    }
    board.mark_stop();
}
