//! A body of joints.

use super::{Content, display};
use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::run::{Outcome, PlayContext, play, set_up};
use pantin::Player;
use pantin_figure::rotation::RotationBackend;
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{DrawStyle, FigureRenderer, View};

impl<L: Layout, const N: usize, R: RotationBackend> Content<L> for FigureRenderer<N, R> {
    #[inline(always)]
    fn set_pose(&mut self, pose: &[i32]) {
        FigureRenderer::set_pose(self, pose);
    }

    #[inline(always)]
    fn draw(&mut self, frame: &mut Framebuffer<L>, style: DrawStyle) {
        self.draw_on(frame, style);
    }

    #[inline(always)]
    fn aim(&mut self, player: &mut Player, view: View) {
        FigureRenderer::aim(self, player, view);
    }
}

/// Plays it on the whole display.
#[cfg_attr(feature = "face", inline(never))]
pub(super) fn perform<B: Board, const JOINTS: usize>(player: &mut Player, context: PlayContext<B>) -> Outcome {
    let mut renderer = FigureRenderer::<JOINTS, B::Rotation>::empty();
    if let Err(error) = set_up(&mut renderer, player, display::<B::Layout>()) {
        error!("the rig is too big: {}", error);
        return Outcome::Exit(Exit::BadClip);
    }
    renderer.aim(player, context.view_state.view);
    info!(
        "{}: {} frames of {} ns, {} channels, {} of them moving; {} joints drawn",
        context.entry.name,
        player.clip().frames(),
        player.clip().frame_time_ns(),
        player.clip().rig().channels(),
        player.clip().moving(),
        renderer.skeleton().bones.len()
    );
    #[cfg(feature = "face")]
    let renderer: &mut dyn Content<B::Layout> = &mut renderer;
    #[cfg(not(feature = "face"))]
    let renderer = &mut renderer;
    play(player, renderer, context)
}
