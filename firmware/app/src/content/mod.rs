//! What a clip is drawn as: a body, and with the feature `face` a face, or both.

mod body;
#[cfg(feature = "face")]
mod both;
#[cfg(feature = "face")]
mod face;

use crate::board::Board;
use crate::run::{Outcome, PlayContext};
use pantin::{Player, Pose};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, DrawStyle, View};

/// What is before the camera.
pub(crate) trait Content<L: Layout> {
    /// Puts it where a pose has it.
    fn set_pose(&mut self, pose: Pose<'_>);

    /// Draws that on a clear display.
    fn draw(&mut self, frame: &mut Framebuffer<L>, style: DrawStyle);

    /// Sets the camera up for another view; leaves the player where it is.
    fn aim(&mut self, player: &mut Player, view: View);
}

/// Plays the clip as what it is. Each kind has its room in a function of its own: the largest counts, not their sum.
pub(crate) fn build<B: Board>(player: &mut Player, context: PlayContext<B>) -> Outcome {
    #[cfg(feature = "face")]
    if face::is_in(player.clip()) {
        return match player.clip().rig().joint_count() {
            0 => face::perform(player, context),
            _ => both::perform(player, context),
        };
    }
    body::perform(player, context)
}

/// All of a board's display.
fn display<L: Layout>() -> Canvas {
    Canvas { width: L::WIDTH as u16, height: L::HEIGHT as u16 }
}
