//! A body of joints.

use super::{Show, display};
use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::run::{After, Scenery, play, set_up};
use pantin::Player;
use pantin_figure::rotation::Turning;
use pantin_figure::surface::{Frame, Layout};
use pantin_figure::{Look, Stage, View};

impl<L: Layout, const N: usize, R: Turning> Show<L> for Stage<N, R> {
    #[inline(always)]
    fn place(&mut self, pose: &[i32]) {
        Stage::place(self, pose);
    }

    #[inline(always)]
    fn draw(&mut self, frame: &mut Frame<L>, look: Look) {
        self.draw_on(frame, look);
    }

    #[inline(always)]
    fn aim(&mut self, player: &mut Player, view: View) {
        Stage::aim(self, player, view);
    }
}

/// Plays it on the whole display.
#[cfg_attr(feature = "face", inline(never))]
pub(super) fn perform<B: Board, const JOINTS: usize>(player: &mut Player, scenery: Scenery<B>) -> After {
    let mut stage = Stage::<JOINTS, B::Turning>::empty();
    if let Err(error) = set_up(&mut stage, player, display::<B::Layout>()) {
        error!("the rig is too big: {}", error);
        return After::Exit(Exit::BadClip);
    }
    stage.aim(player, scenery.scene.view);
    info!(
        "{}: {} frames of {} ns, {} channels, {} of them moving; {} joints drawn",
        scenery.entry.name,
        player.clip().frames(),
        player.clip().frame_time_ns(),
        player.clip().rig().channels(),
        player.clip().moving(),
        stage.skeleton().bones.len()
    );
    #[cfg(feature = "face")]
    let stage: &mut dyn Show<B::Layout> = &mut stage;
    #[cfg(not(feature = "face"))]
    let stage = &mut stage;
    play(player, stage, scenery)
}
