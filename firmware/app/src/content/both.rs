//! A body and its face: side by side on a wide display, the face in a corner of a tall one.

use super::face::{self, Face};
use super::{Content, display};
use crate::board::{Board, Exit};
use crate::capacity::{Capacity, Figure};
use crate::log::{error, info};
use crate::run::{Outcome, PlayContext, play};
use pantin::{Player, Pose};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, DrawStyle, View};

/// The parts of the display: the body's, and the face's square at the top right.
struct Parts {
    body: Canvas,
    face: Canvas,
    /// First column of the face's.
    column: i16,
}

impl Parts {
    fn of<L: Layout>() -> Parts {
        let Canvas { width, height } = display::<L>();
        let wide = 2 * width >= 3 * height;
        let side = if wide { height } else { width / 5 * 2 };
        let body = if wide { width - side } else { width };
        Parts { body: Canvas { width: body, height }, face: Canvas { width: side, height: side }, column: (width - side) as i16 }
    }
}

/// Both.
struct Both<'a, F> {
    renderer: &'a mut F,
    face: Face<'a>,
}

impl<L: Layout, F: Figure> Content<L> for Both<'_, F> {
    fn set_pose(&mut self, pose: Pose<'_>) {
        Figure::set_pose(self.renderer, pose);
        self.face.set_pose(pose);
    }

    fn draw(&mut self, frame: &mut Framebuffer<L>, style: DrawStyle) {
        Figure::draw(self.renderer, frame, style);
        self.face.draw(frame);
    }

    fn aim(&mut self, player: &mut Player, view: View) {
        Figure::aim(self.renderer, player, view);
        self.face.aim(view);
    }
}

/// Plays them.
#[inline(never)]
pub(super) fn perform<B: Board>(player: &mut Player, context: PlayContext<B>) -> Outcome {
    let parts = Parts::of::<B::Layout>();
    let mut renderer = <B::Capacity as Capacity>::Figure::<B::Rotation>::empty();
    if let Err(error) = renderer.set_up(player, parts.body) {
        error!("the rig is too big: {}", error);
        return Outcome::Exit(Exit::BadClip);
    }
    Figure::aim(&mut renderer, player, context.view_state.view);
    beside(player, &mut renderer, parts, context)
}

/// Makes room for the face once the body is set up, which takes room of its own.
#[inline(never)]
fn beside<B: Board>(
    player: &mut Player,
    renderer: &mut <B::Capacity as Capacity>::Figure<B::Rotation>,
    parts: Parts,
    context: PlayContext<B>,
) -> Outcome {
    let rig = player.clip().rig();
    let views = [context.view_state.view, context.view_state.ahead];
    let after = face::with(&rig, parts.face, parts.column, views, |face| {
        info!(
            "{}: {} frames of {} ns, {} channels, {} of them moving; {} joints drawn, {} drive the face",
            context.entry.name,
            player.clip().frames(),
            player.clip().frame_time_ns(),
            player.clip().rig().channels(),
            player.clip().moving(),
            renderer.bones(),
            face.names()
        );
        let both: &mut dyn Content<B::Layout> = &mut Both { renderer, face };
        play(player, both, context)
    });
    after.unwrap_or_else(face::no_model)
}
