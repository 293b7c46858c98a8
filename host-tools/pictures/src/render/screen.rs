//! The reference board's display: 128x64 pixels of 16 greys.

use anyhow::{Context, Result};
use embedded_graphics::pixelcolor::GrayColor;
use pantin::{ChannelState, Clip, Player};
use pantin_figure::surface::{self, Gray4Rows};
use pantin_figure::{Canvas, DrawStyle, FigureRenderer, View};

/// Pixels in a row.
pub const WIDTH: usize = 128;
/// Rows.
pub const HEIGHT: usize = 64;
/// The display's size as the camera takes it.
pub const CANVAS: Canvas = Canvas { width: WIDTH as u16, height: HEIGHT as u16 };
/// More joints than a rig's figure can have: the pictures do not depend on it.
const JOINTS: usize = pantin_figure::RIG_JOINTS;

/// What the firmware draws into: two pixels a byte, the left one in the high half.
pub type Framebuffer = surface::Framebuffer<Gray4Rows<WIDTH, HEIGHT, { WIDTH * HEIGHT / 8 }>>;

/// One picture of the display: brightness 0 to 15 a pixel, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// `WIDTH * HEIGHT` of them.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// What a framebuffer shows.
    pub fn of(frame: &Framebuffer) -> Picture {
        Picture { pixels: (0..HEIGHT * WIDTH).map(|index| frame.pixel(index % WIDTH, index / WIDTH).luma()).collect() }
    }

    /// The picture in greys of 0 to 255, each pixel a square of `scale`.
    pub fn enlarged(&self, scale: usize) -> Vec<u8> {
        let rows = self.pixels.chunks(WIDTH);
        rows.flat_map(|row| {
            let line: Vec<u8> = row.iter().flat_map(|&grey| std::iter::repeat_n(grey * 17, scale)).collect();
            line.repeat(scale)
        })
        .collect()
    }
}

/// Draws the pictures of a clip's `frames`, which must ascend.
pub fn pictures(clip: &Clip, view: View, frames: impl IntoIterator<Item = u32>) -> Result<Vec<Picture>> {
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(*clip, &mut states, &mut pose).map_err(|error| anyhow::anyhow!("{error}"))?;
    let mut renderer = FigureRenderer::<JOINTS>::of_clip(&mut player, CANVAS, view).context("this figure cannot be drawn")?;
    let mut frame = Framebuffer::new();
    let draw = |number| {
        player.seek(number);
        frame.clear();
        renderer.set_pose(player.pose()).expect("the renderer was set up for this clip");
        renderer.draw_on(&mut frame, DrawStyle::default());
        Picture::of(&frame)
    };
    Ok(frames.into_iter().map(draw).collect())
}
