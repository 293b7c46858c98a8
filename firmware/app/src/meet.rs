//! Two characters that meet: one is steered, the other one stands in its way and reacts to it.

use crate::board::{Board, BoardRenderer, Exit};
use crate::capacity::{Renderer, Style};
use crate::keys::SteerKey;
use crate::options::Options;
use crate::run::{Actor, play};
use crate::session::{Entry, Outcome, PlayContext};
use crate::source::paired::{Meeting, PairedSource, Role};
use crate::source::steered::SteeredSource;
use crate::steer::{Body, Refusal, exit};
use crate::update::Listener;
use crate::view_state::ViewState;
use pantin::{ChannelState, Player, Pose};
use pantin_animator::{Placement, first_clip};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{CameraTarget, Canvas, Stand, View};

/// How far apart the two stand at first, in cm.
const APART_CM: u32 = 245;

/// The camera stays, and sees the steered figure walk to the right.
const VIEW: View = View { orbit: -50, tilt: 10, track: CameraTarget::Fixed, up: None };

/// Plays the character of a bank, steered as by [`crate::steer`], and another one that stands 2.45 m before it: that one turns to it, waves when it comes
/// near and when it leaves, and bows back. They look at each other, and the steered one lays a hand on the other's shoulder where it reaches it. The camera stays.
///
/// The rig needs the joints `head` and `right-hand`, each with two joints above it. Each of the two takes as much memory as the character of [`crate::steer`].
///
/// Returns [`Exit::BadClip`] as [`crate::steer`] does.
#[inline(never)]
pub fn meet<B: Board, const CHANNELS: usize>(
    bank: &[u8],
    keys: &[SteerKey],
    leave: u16,
    options: Options,
    framebuffer: &mut Framebuffer<B::Layout>,
    board: &mut B,
) -> Exit {
    let mode = options.mode;
    let mut view_state = ViewState::new(&options);
    let (style, feet) = (view_state.style, options.feet);
    #[cfg(feature = "solid")]
    let style = Style { look: options.other_look, ..style };
    let listener = Listener::default();
    let mut context = PlayContext { mode, view_state: &mut view_state, framebuffer, board, listener };
    exit(set_up::<B, CHANNELS>(bank, keys, leave, style, feet, &mut context))
}

fn set_up<B: Board, const CHANNELS: usize>(
    bank: &[u8],
    keys: &[SteerKey],
    leave: u16,
    other_style: Style,
    holds_feet: bool,
    context: &mut PlayContext<B>,
) -> Result<Outcome, Refusal> {
    // One by one: as arrays they would be copied, which takes their stack twice.
    let mut steered = Body::<CHANNELS>::new();
    let mut other = Body::<CHANNELS>::new();
    let mut first = BoardRenderer::<B>::empty();
    let mut second = BoardRenderer::<B>::empty();
    let meeting = Meeting::default();
    let (steered, mut other) = (steered.character(bank, holds_feet)?, other.character(bank, holds_feet)?);
    PairedSource::put(&mut other, APART_CM);
    for (renderer, style) in [(&mut first, context.view_state.style), (&mut second, other_style)] {
        aim::<B, CHANNELS>(bank, [steered.pose(), other.pose()], renderer, style)?;
    }
    let held = context.board.held();
    let source =
        |character, keys, role| PairedSource::new(SteeredSource::new(character, keys, leave, context.mode, held), role, &meeting);
    let (mut steered, mut other) = (source(steered, keys, Role::Steered)?, source(other, &[], Role::Other)?);
    let entry = Entry { name: "", bytes: &[], rig: &[] };
    Ok(play(
        &mut [
            Actor { entry: &entry, source: &mut steered, content: &mut first },
            Actor { entry: &entry, source: &mut other, content: &mut second },
        ],
        context,
    ))
}

/// Sets a figure up, and a camera that sees both where they stand.
#[inline(never)]
fn aim<B: Board, const CHANNELS: usize>(
    bank: &[u8],
    stands: [(Pose, Placement); 2],
    renderer: &mut BoardRenderer<B>,
    style: Style,
) -> Result<(), Refusal> {
    let canvas = Canvas { width: B::Layout::WIDTH as u16, height: B::Layout::HEIGHT as u16 };
    let (mut states, mut values) = ([ChannelState::NEW; CHANNELS], [0; CHANNELS]);
    let mut player = Player::new(first_clip(bank)?, &mut states, &mut values)?;
    renderer.set_up(&mut player, canvas)?;
    renderer.look_at_stands(canvas, VIEW, style, |visit| {
        for (pose, placement) in &stands {
            visit(pose.values, Stand { place: placement.place, heading: placement.heading });
        }
    });
    Ok(())
}
