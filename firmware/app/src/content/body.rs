//! A body of joints.

use super::{Content, display};
use crate::board::{Board, Exit};
use crate::capacity::{Capacity, Figure};
use crate::log::{error, info};
use crate::run::{Outcome, PlayContext, play};
use pantin::{Player, Pose};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{DrawStyle, View};

impl<L: Layout, F: Figure> Content<L> for F {
    #[inline(always)]
    fn set_pose(&mut self, pose: Pose<'_>) {
        Figure::set_pose(self, pose);
    }

    #[inline(always)]
    fn draw(&mut self, frame: &mut Framebuffer<L>, style: DrawStyle) {
        Figure::draw(self, frame, style);
    }

    #[inline(always)]
    fn aim(&mut self, player: &mut Player, view: View) {
        Figure::aim(self, player, view);
    }
}

/// Plays it on the whole display.
#[cfg_attr(feature = "face", inline(never))]
pub(super) fn perform<B: Board>(player: &mut Player, context: PlayContext<B>) -> Outcome {
    let mut renderer = <B::Capacity as Capacity>::Figure::<B::Rotation>::empty();
    if let Err(error) = renderer.set_up(player, display::<B::Layout>()) {
        error!("the rig is too big: {}", error);
        return Outcome::Exit(Exit::BadClip);
    }
    Figure::aim(&mut renderer, player, context.view_state.view);
    info!(
        "{}: {} frames of {} ns, {} channels, {} of them moving; {} joints drawn",
        context.entry.name,
        player.clip().frames(),
        player.clip().frame_time_ns(),
        player.clip().rig().channels(),
        player.clip().moving(),
        renderer.bones()
    );
    #[cfg(feature = "face")]
    let renderer: &mut dyn Content<B::Layout> = &mut renderer;
    #[cfg(not(feature = "face"))]
    let renderer = &mut renderer;
    play(player, renderer, context)
}
