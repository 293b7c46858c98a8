//! A body with volume and its face, which is on the body's neck.

use super::face::Face;
use super::{AnyContent, Content, face, whole_display};
use crate::board::{Board, BoardRenderer, Exit};
use crate::capacity::{Renderer, Style};
use crate::log::{error, info};
use crate::session::{Outcome, PlayContext};
use pantin::{Player, Pose};
use pantin_face::{CARTOON, CARTOON_VERTICES};
use pantin_figure::View;
use pantin_figure::surface::{Framebuffer, Layout};

/// A body and the face on its neck. In lines, it has no face.
struct OnNeck<'a, R> {
    renderer: &'a mut R,
    face: Face<'a, CARTOON_VERTICES>,
}

impl<L: Layout, R: Renderer> Content<L> for OnNeck<'_, R> {
    fn set_pose(&mut self, pose: Pose<'_>) {
        Renderer::set_pose(self.renderer, pose);
        self.face.shape(pose.values);
    }

    fn draw(&mut self, framebuffer: &mut Framebuffer<L>, style: Style) {
        let face = &mut self.face;
        Renderer::draw_with_face(self.renderer, framebuffer, style, |framebuffer, head| face.draw_on_head(framebuffer, head));
    }

    fn aim(&mut self, player: &mut Player, view: View, style: Style) {
        Renderer::aim(self.renderer, player, view, style);
    }
}

/// Returns whether a clip's body has a neck: whether it is a person's.
// Not inlined: this renderer leaves the stack.
#[inline(never)]
pub(super) fn is_there<B: Board>(player: &mut Player) -> bool {
    let mut renderer = BoardRenderer::<B>::empty();
    renderer.set_up(player, whole_display::<B::Layout>()).is_ok() && renderer.is_person()
}

/// Builds body and face.
#[inline(never)]
pub(super) fn build<B: Board>(
    player: &mut Player,
    context: &mut PlayContext<B>,
    then: impl FnOnce(&mut Player, &mut AnyContent<B>, &mut PlayContext<B>) -> Outcome,
) -> Outcome {
    let mut renderer = BoardRenderer::<B>::empty();
    if let Err(error) = renderer.set_up(player, whole_display::<B::Layout>()) {
        error!("the rig is too big: {}", error);
        return Outcome::Exit(Exit::BadClip);
    }
    renderer.set_bare_face();
    Renderer::aim(&mut renderer, player, context.view_state.view, context.view_state.style);
    info!("{} joints drawn", renderer.bones());
    add_face::<B>(player, &mut renderer, context, then)
}

/// Builds the face after the body is set up. Not inlined: the face's buffers are not yet on the stack while that uses its workspace.
#[inline(never)]
fn add_face<B: Board>(
    player: &mut Player,
    renderer: &mut BoardRenderer<B>,
    context: &mut PlayContext<B>,
    then: impl FnOnce(&mut Player, &mut AnyContent<B>, &mut PlayContext<B>) -> Outcome,
) -> Outcome {
    let rig = player.clip().rig();
    let radius = renderer.head_radius();
    let outcome = face::on_head(CARTOON, &rig, radius, |face| then(player, &mut OnNeck { renderer, face }, context));
    outcome.unwrap_or_else(face::bad_model)
}
