//! The reference board's display: 128x64 pixels of 16 greys.

use anyhow::{Context, Result};
use embedded_graphics::framebuffer::{Framebuffer, buffer_size};
use embedded_graphics::pixelcolor::raw::{BigEndian, RawU4};
use embedded_graphics::pixelcolor::{Gray4, GrayColor};
use embedded_graphics::prelude::Point;
use pantin::{ChannelState, Clip, Player};
use pantin_figure::{Canvas, Stage, View};

/// Pixels in a row.
pub const WIDTH: usize = 128;
/// Rows.
pub const HEIGHT: usize = 64;
/// The display's size as the camera takes it.
pub const CANVAS: Canvas = Canvas { width: WIDTH as u16, height: HEIGHT as u16 };
/// More joints than a rig's figure can have: the pictures do not depend on it.
const JOINTS: usize = pantin_figure::RIG_JOINTS;

/// What the firmware draws into: two pixels a byte, the left one in the high half.
pub type Frame = Framebuffer<Gray4, RawU4, BigEndian, WIDTH, HEIGHT, { buffer_size::<Gray4>(WIDTH, HEIGHT) }>;

/// One picture of the display: brightness 0 to 15 a pixel, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// `WIDTH * HEIGHT` of them.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// What a framebuffer shows.
    pub fn of(frame: &Frame) -> Picture {
        let places = (0..HEIGHT * WIDTH).map(|index| Point::new((index % WIDTH) as i32, (index / WIDTH) as i32));
        let pixel = |place| embedded_graphics::image::GetPixel::pixel(frame, place).map_or(0, |grey: Gray4| grey.luma());
        Picture { pixels: places.map(pixel).collect() }
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
    let mut stage = Stage::<JOINTS>::of_clip(&mut player, CANVAS, view).context("this figure cannot be drawn")?;
    let mut frame = Frame::new();
    let draw = |number| {
        player.seek(number);
        let Ok(()) = stage.draw(player.pose(), &mut frame);
        Picture::of(&frame)
    };
    Ok(frames.into_iter().map(draw).collect())
}
