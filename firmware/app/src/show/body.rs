//! A body of joints.

use super::Show;
use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::options::Mode;
use crate::run::{After, play, set_up};
use crate::scene::{Entry, Scene};
use pantin::Player;
use pantin_figure::rotation::Turning;
use pantin_figure::surface::{Frame, Layout};
use pantin_figure::{Canvas, Look, Stage, View};

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
pub(super) fn perform<B: Board, const JOINTS: usize>(
    player: &mut Player,
    entry: &Entry,
    mode: Mode,
    scene: &mut Scene,
    frame: &mut Frame<B::Layout>,
    board: &mut B,
) -> After {
    let canvas = Canvas { width: B::Layout::WIDTH as u16, height: B::Layout::HEIGHT as u16 };
    let mut stage = Stage::<JOINTS, B::Turning>::empty();
    if let Err(error) = set_up(&mut stage, player, canvas) {
        error!("the rig is too big: {}", error);
        return After::Exit(Exit::BadClip);
    }
    stage.aim(player, scene.view);
    info!(
        "{}: {} frames of {} ns, {} channels, {} of them moving; {} joints drawn",
        entry.name,
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
    play(player, stage, entry, mode, scene, frame, board)
}
