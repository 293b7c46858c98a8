//! What a clip is drawn as: a body, and with the feature `face` a face, or both.
//!
//! Content is built on the stack of its `build` function, which then hands it to `then`: the program needs stack for the largest content,
//! not for the sum of all.

mod body;
#[cfg(feature = "face")]
mod both;
pub(crate) mod build;
#[cfg(feature = "face")]
mod face;
#[cfg(feature = "neck")]
mod neck;

use crate::capacity::Style;
use pantin::{Player, Pose};
use pantin_figure::surface::{Framebuffer, Layout};
use pantin_figure::{Canvas, View};

/// What is drawn.
pub(crate) trait Content<L: Layout> {
    /// Takes the pose to draw.
    fn set_pose(&mut self, pose: Pose<'_>);

    /// Takes the pose to draw of a body that stands somewhere in the world. No other content does.
    #[cfg(feature = "steer")]
    fn set_pose_at(&mut self, pose: Pose<'_>, _stand: pantin_figure::Stand) {
        self.set_pose(pose);
    }

    /// Draws it on a clear framebuffer.
    fn draw(&mut self, framebuffer: &mut Framebuffer<L>, style: Style);

    /// Sets the camera up for a view and a style. The player stays at its frame.
    fn aim(&mut self, player: &mut Player, view: View, style: Style);
}

/// The content of any clip: with the feature `face` a trait object, so that the loop is compiled once; else always a body.
#[cfg(feature = "face")]
pub(crate) type AnyContent<'a, B> = dyn Content<<B as crate::board::Board>::Layout> + 'a;
#[cfg(not(feature = "face"))]
pub(crate) type AnyContent<'a, B> = crate::board::BoardRenderer<B>;

/// Returns the area of a board's whole display.
fn whole_display<L: Layout>() -> Canvas {
    Canvas { width: L::WIDTH as u16, height: L::HEIGHT as u16 }
}
