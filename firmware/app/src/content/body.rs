//! A body of joints.

use super::{AnyContent, Content, whole_display};
use crate::board::{Board, BoardRenderer, Exit};
use crate::capacity::{Renderer, Style};
use crate::log::{error, info};
use crate::session::{Outcome, PlayContext};
use pantin::{Player, Pose};
use pantin_figure::View;
use pantin_figure::surface::{Framebuffer, Layout};

impl<L: Layout, R: Renderer> Content<L> for R {
    #[inline(always)]
    fn set_pose(&mut self, pose: Pose<'_>) {
        Renderer::set_pose(self, pose);
    }

    #[cfg(feature = "steer")]
    #[inline(always)]
    fn set_pose_at(&mut self, pose: Pose<'_>, stand: pantin_figure::Stand) {
        Renderer::set_pose_at(self, pose, stand);
    }

    #[inline(always)]
    fn draw(&mut self, framebuffer: &mut Framebuffer<L>, style: Style) {
        Renderer::draw(self, framebuffer, style);
    }

    #[inline(always)]
    fn aim(&mut self, player: &mut Player, view: View, style: Style) {
        Renderer::aim(self, player, view, style);
    }
}

/// Builds it for the whole display.
#[cfg_attr(feature = "face", inline(never))]
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
    Renderer::aim(&mut renderer, player, context.view_state.view, context.view_state.style);
    info!("{} joints drawn", renderer.bones());
    then(player, &mut renderer, context)
}
