//! A character that the user steers: the board's buttons, and letters over its serial line, are the inputs of its state machine.

use crate::board::{Board, BoardRenderer, Exit};
use crate::capacity::{Renderer, Style};
use crate::keys::SteerKey;
use crate::log::error;
use crate::options::Options;
use crate::run::{Actor, play};
use crate::session::{Entry, Outcome, PlayContext};
use crate::source::steered::SteeredSource;
use crate::update::Listener;
use crate::view_state::ViewState;
use pantin::{ChannelState, Player};
use pantin_animator::machine::TableError;
use pantin_animator::{Character, Feet, LayerMemory, Workspace, first_clip, visit_poses};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, View};

/// Words of a layer's mask: a bit for each joint.
const MASK_WORDS: usize = crate::RIG.div_ceil(32);

/// Why a character cannot be played.
pub(crate) enum Refusal {
    /// The figure has no place in the renderer.
    Figure(pantin_figure::Error),
    /// The bank, its state machine or one of its clips.
    Character(pantin_animator::Error),
}

impl From<pantin_figure::Error> for Refusal {
    fn from(error: pantin_figure::Error) -> Refusal {
        Refusal::Figure(error)
    }
}

impl From<pantin_animator::Error> for Refusal {
    fn from(error: pantin_animator::Error) -> Refusal {
        Refusal::Character(error)
    }
}

impl From<pantin::TooSmall> for Refusal {
    fn from(error: pantin::TooSmall) -> Refusal {
        Refusal::Character(error.into())
    }
}

/// Plays the state machine of a bank until a button in `leave` is pressed, the letter `q` comes, or the mode ends. The rig has at most `CHANNELS`
/// channels. The machine's first layer plays; further layers, and the second clips of blends, do not. If the bank has a table of feet, planted feet stay
/// where they are, for about 2 KB of stack. Name, frame and speed are always shown.
///
/// Returns [`Exit::BadClip`] for a bank without a state machine, one that is damaged, or a rig that is too large; the log has the reason.
#[inline(never)]
pub fn steer<B: Board, const CHANNELS: usize>(
    bank: &[u8],
    keys: &[SteerKey],
    leave: u16,
    options: Options,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mode = options.mode;
    let mut view_state = ViewState::new(&Options { hud: true, ..options });
    let listener = Listener::default();
    let mut context = PlayContext { mode, view_state: &mut view_state, framebuffer, board, listener };
    exit(set_up::<B, CHANNELS>(bank, keys, leave, options.feet, &mut context))
}

/// Says in the log why something cannot be played.
pub(crate) fn exit(outcome: Result<Outcome, Refusal>) -> Exit {
    match outcome {
        Ok(Outcome::Exit(exit)) => exit,
        Ok(_) => Exit::Done,
        Err(Refusal::Figure(error)) => {
            error!("the rig is too big: {}", error);
            Exit::BadClip
        }
        Err(Refusal::Character(error)) => {
            error!("the state machine cannot be played: {}", defmt::Display2Format(&error));
            Exit::BadClip
        }
    }
}

/// Memory of a character whose rig has at most `CHANNELS` channels: of the second clip of blends it has none.
pub(crate) struct Body<'a, const CHANNELS: usize> {
    memory: Workspace<CHANNELS, CHANNELS>,
    states: [ChannelState; CHANNELS],
    values: [i32; CHANNELS],
    sampled: [i32; CHANNELS],
    words: [u32; MASK_WORDS],
    feet: Feet<'a>,
}

impl<'a, const CHANNELS: usize> Body<'a, CHANNELS> {
    #[inline(always)]
    pub fn new() -> Self {
        let values = || [0; CHANNELS];
        Body {
            memory: Workspace::new(),
            states: [ChannelState::NEW; CHANNELS],
            values: values(),
            sampled: values(),
            words: [0; MASK_WORDS],
            feet: Feet::new(),
        }
    }

    /// The character of a bank, with its first layer and, if they are to be held, its feet, if it has them.
    pub fn character<'m>(&'m mut self, bank: &'a [u8], holds_feet: bool) -> Result<Character<'a, 'm>, Refusal> {
        let Body { memory, states, values, sampled, words, feet } = self;
        let mut character = Character::new(bank, memory.lend())?;
        if character.table().layer(0).is_some() {
            character.lend_layer(LayerMemory { states, values, sampled, words })?;
        }
        match if holds_feet { character.lend_feet(feet) } else { Ok(()) } {
            // A bank without feet.
            Ok(()) | Err(pantin_animator::Error::Machine(TableError::Missing)) => {}
            Err(error) => return Err(error.into()),
        }
        Ok(character)
    }
}

/// Sets the character up and plays it.
fn set_up<B: Board, const CHANNELS: usize>(
    bank: &[u8],
    keys: &[SteerKey],
    leave: u16,
    holds_feet: bool,
    context: &mut PlayContext<B>,
) -> Result<Outcome, Refusal> {
    let mut body = Body::<CHANNELS>::new();
    let mut renderer = BoardRenderer::<B>::empty();
    aim::<B>(bank, context.view_state.style, &mut renderer, &mut body.states, &mut body.values, &mut body.sampled)?;
    let mut source = SteeredSource::new(body.character(bank, holds_feet)?, keys, leave, context.mode, context.board.held());
    Ok(play(
        &mut [Actor { entry: &Entry { name: "", bytes: &[], rig: &[] }, source: &mut source, content: &mut renderer }],
        context,
    ))
}

/// Sets the figure up, and the camera for the clips of all states.
#[inline(never)]
fn aim<B: Board>(
    bytes: &[u8],
    style: Style,
    renderer: &mut BoardRenderer<B>,
    states: &mut [ChannelState],
    values: &mut [i32],
    sampled: &mut [i32],
) -> Result<(), Refusal> {
    let canvas = Canvas { width: B::Layout::WIDTH as u16, height: B::Layout::HEIGHT as u16 };
    let mut player = Player::new(first_clip(bytes)?, states, values)?;
    renderer.set_up(&mut player, canvas)?;
    let mut visited = Ok(());
    renderer.look_at(canvas, View::default(), style, |visit| {
        visited = visited.and(visit_poses(bytes, states, values, sampled, &mut |_, values| visit(values)));
    });
    Ok(visited?)
}
