//! A body and its face: side by side on a wide display, the face in a corner of a tall one.

use super::face::{self, Face};
use super::{Show, display};
use crate::board::{Board, Exit};
use crate::log::{error, info};
use crate::run::{After, Scenery, play, set_up};
use pantin::Player;
use pantin_figure::rotation::Turning;
use pantin_figure::surface::{Frame, Layout};
use pantin_figure::{Canvas, Look, Stage, View};

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
struct Both<'a, const N: usize, R: Turning> {
    stage: &'a mut Stage<N, R>,
    face: Face<'a>,
}

impl<L: Layout, const N: usize, R: Turning> Show<L> for Both<'_, N, R> {
    fn place(&mut self, pose: &[i32]) {
        self.stage.place(pose);
        self.face.place(pose);
    }

    fn draw(&mut self, frame: &mut Frame<L>, look: Look) {
        self.stage.draw_on(frame, look);
        self.face.draw(frame);
    }

    fn aim(&mut self, player: &mut Player, view: View) {
        self.stage.aim(player, view);
        self.face.aim(view);
    }
}

/// Plays them.
#[inline(never)]
pub(super) fn perform<B: Board, const JOINTS: usize>(player: &mut Player, scenery: Scenery<B>) -> After {
    let parts = Parts::of::<B::Layout>();
    let mut stage = Stage::<JOINTS, B::Turning>::empty();
    if let Err(error) = set_up(&mut stage, player, parts.body) {
        error!("the rig is too big: {}", error);
        return After::Exit(Exit::BadClip);
    }
    stage.aim(player, scenery.scene.view);
    beside(player, &mut stage, parts, scenery)
}

/// Makes room for the face once the body is set up, which takes room of its own.
#[inline(never)]
fn beside<B: Board, const JOINTS: usize>(
    player: &mut Player,
    stage: &mut Stage<JOINTS, B::Turning>,
    parts: Parts,
    scenery: Scenery<B>,
) -> After {
    let rig = player.clip().rig();
    let views = [scenery.scene.view, scenery.scene.ahead];
    let after = face::with(&rig, parts.face, parts.column, views, |face| {
        info!(
            "{}: {} frames of {} ns, {} channels, {} of them moving; {} joints drawn, {} drive the face",
            scenery.entry.name,
            player.clip().frames(),
            player.clip().frame_time_ns(),
            player.clip().rig().channels(),
            player.clip().moving(),
            stage.skeleton().bones.len(),
            face.names()
        );
        let both: &mut dyn Show<B::Layout> = &mut Both { stage, face };
        play(player, both, scenery)
    });
    after.unwrap_or_else(face::no_model)
}
