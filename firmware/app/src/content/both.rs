//! A body and its face: side by side on a wide display, the face in a corner of a tall one.

use super::face::{self, Face};
use super::{AnyContent, Content, whole_display};
use crate::board::{Board, BoardRenderer, Exit};
use crate::capacity::{Renderer, Style};
use crate::log::{error, info};
use crate::session::{Outcome, PlayContext};
use pantin::{Player, Pose};
use pantin_figure::View;
use pantin_figure::camera::Areas;
use pantin_figure::surface::{Framebuffer, Layout};

/// A body and its face.
struct Both<'a, R, const N: usize> {
    renderer: &'a mut R,
    face: Face<'a, N>,
}

impl<L: Layout, R: Renderer, const N: usize> Content<L> for Both<'_, R, N> {
    fn set_pose(&mut self, pose: Pose<'_>) {
        Renderer::set_pose(self.renderer, pose);
        self.face.set_pose(pose);
    }

    fn draw(&mut self, framebuffer: &mut Framebuffer<L>, style: Style) {
        Renderer::draw(self.renderer, framebuffer, style);
        self.face.draw(framebuffer);
    }

    fn aim(&mut self, player: &mut Player, view: View, style: Style) {
        Renderer::aim(self.renderer, player, view, style);
        self.face.aim(view);
    }
}

/// Builds body and face.
#[inline(never)]
pub(super) fn build<B: Board>(
    player: &mut Player,
    context: &mut PlayContext<B>,
    then: impl FnOnce(&mut Player, &mut AnyContent<B>, &mut PlayContext<B>) -> Outcome,
) -> Outcome {
    let areas = whole_display::<B::Layout>().with_face();
    let mut renderer = BoardRenderer::<B>::empty();
    if let Err(error) = renderer.set_up(player, areas.body) {
        error!("the rig is too big: {}", error);
        return Outcome::Exit(Exit::BadClip);
    }
    Renderer::aim(&mut renderer, player, context.view_state.view, context.view_state.style);
    info!("{} joints drawn", renderer.bones());
    if face::is_small::<B::Layout>() {
        add_face::<B, { face::small::VERTICES }>(face::small::MODEL, player, &mut renderer, areas, context, then)
    } else {
        add_face::<B, { face::large::VERTICES }>(face::large::MODEL, player, &mut renderer, areas, context, then)
    }
}

/// Builds the face after the body is set up. Not inlined: the face's buffers are not yet on the stack while that uses its workspace.
#[inline(never)]
fn add_face<B: Board, const N: usize>(
    model: &'static [u8],
    player: &mut Player,
    renderer: &mut BoardRenderer<B>,
    areas: Areas,
    context: &mut PlayContext<B>,
    then: impl FnOnce(&mut Player, &mut AnyContent<B>, &mut PlayContext<B>) -> Outcome,
) -> Outcome {
    let rig = player.clip().rig();
    let views = [context.view_state.view, context.view_state.ahead];
    let outcome = face::with::<N, _>(model, &rig, areas.face, areas.face_column, views, |face| {
        then(player, &mut Both { renderer, face }, context)
    });
    outcome.unwrap_or_else(face::bad_model)
}
