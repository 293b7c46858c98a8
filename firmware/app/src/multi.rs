//! Several figures side by side, each with its own clip and phase.

use crate::board::{Board, BoardRenderer, Exit};
use crate::capacity::{Capacity, Renderer};
use crate::log::error;
use crate::options::Options;
use crate::run::{Actor, play};
use crate::session::{Entry, Outcome, PlayContext};
use crate::update::Listener;
use crate::view_state::ViewState;
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
    renderer: BoardRenderer<B>,
}

impl<B: Board> FigureBuffers<B> {
    /// Makes buffers without a clip.
    #[inline(always)]
    pub fn empty() -> Self {
        FigureBuffers { states: B::Capacity::states(), pose: B::Capacity::pose(), renderer: Renderer::empty() }
    }
}

/// Plays as many figures as there are buffers, at most [`FIGURES`], until the mode ends. The clips are assigned in turn; each figure starts
/// a little later in its clip than the one before. The frame time is the first clip's. Commands apply to all figures; the one for the next
/// clip gives each figure the clip after its own.
///
/// Returns [`Exit::BadClip`] for a clip that is damaged or larger than [`Board::Capacity`].
#[inline(never)]
pub fn multi<B: Board>(
    entries: &[Entry],
    options: Options,
    buffers: &mut [FigureBuffers<B>],
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mut view_state = ViewState::new(&options);
    let mut first = 0;
    loop {
        let listener = Listener::default();
        let mut context = PlayContext { mode: options.mode, view_state: &mut view_state, framebuffer, board, listener };
        match play_from(entries, first, buffers, &mut context) {
            Outcome::Clip(steps) => first = (first as i32 + steps).checked_rem_euclid(entries.len() as i32).unwrap_or(0) as usize,
            Outcome::Exit(exit) => return exit,
            #[cfg(feature = "update")]
            Outcome::Received(_) | Outcome::Playable => {}
        }
    }
}

/// Sets the figures up, the first one with the clip at `first`, and plays them.
fn play_from<B: Board>(
    entries: &[Entry],
    first: usize,
    buffers: &mut [FigureBuffers<B>],
    context: &mut PlayContext<B>,
) -> Outcome {
    let count = buffers.len().min(FIGURES);
    let mut figures: Vec<(&Entry, Player, &mut BoardRenderer<B>), FIGURES> = Vec::new();
    let entries = entries.iter().cycle().skip(first);
    for (index, (buffers, entry)) in buffers.iter_mut().zip(entries).take(count).enumerate() {
        let clip = match Clip::with_rig(entry.bytes, entry.rig) {
            Ok(clip) => clip,
            Err(error) => {
                error!("a clip cannot be opened: {}", error);
                return Outcome::Exit(Exit::BadClip);
            }
        };
        let mut player = match Player::new(clip, buffers.states.as_mut(), buffers.pose.as_mut()) {
            Ok(player) => player,
            Err(error) => {
                error!("a clip is too big: {}", error);
                return Outcome::Exit(Exit::BadClip);
            }
        };
        if let Err(error) = set_up::<B>(&mut buffers.renderer, &mut player, context.view_state, [index, count]) {
            error!("a rig is too big: {}", error);
            return Outcome::Exit(Exit::BadClip);
        }
        player.seek(clip.frames() / count as u32 * index as u32);
        // There are at most `FIGURES`.
        let _ = figures.push((entry, player, &mut buffers.renderer));
    }
    let mut actors: Vec<Actor<B, Player>, FIGURES> = Vec::new();
    for (entry, source, renderer) in &mut figures {
        let _ = actors.push(Actor { entry, source, content: *renderer });
    }
    play(&mut actors, context)
}

/// Sets a figure up in its column, which is as high as the display and one and a half times as wide as the figure's share of it.
#[inline(never)]
fn set_up<B: Board>(
    renderer: &mut BoardRenderer<B>,
    player: &mut Player,
    view_state: &ViewState,
    [index, count]: [usize; 2],
) -> Result<(), pantin_figure::Error> {
    let share = B::Layout::WIDTH / count;
    let canvas = Canvas { width: (share * 3 / 2) as u16, height: B::Layout::HEIGHT as u16 };
    renderer.set_up(player, canvas)?;
    Renderer::aim(renderer, player, view_state.view, view_state.style);
    renderer.shift((share * index + share / 2) as i16 - (canvas.width / 2) as i16, 0);
    Ok(())
}
