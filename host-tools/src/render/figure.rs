//! A clip's figure before one camera or several.

use super::image::Image;
use super::palette::Palette;
use super::scene::Scene;
use super::shades::Shades;
use super::smooth;
use anyhow::{Context, Result};
use pantin::{ChannelState, Clip, Player};
use pantin_figure::{Canvas, RIG_JOINTS, Stage, View};

/// Most columns and rows of a picture made of a display's pixels: the figure's places have 16 bits, four of them below the pixel.
pub const MOST_PIXELS: usize = 1024;

/// How lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// One pixel wide, as the firmware draws on a display.
    Pixels,
    /// Smooth, thicker the nearer.
    Smooth,
}

/// A player's memory.
pub struct Memory {
    states: Vec<ChannelState>,
    pose: Vec<i32>,
}

impl Memory {
    /// As much as a clip needs.
    pub fn of(clip: &Clip) -> Memory {
        Memory { states: vec![ChannelState::default(); clip.moving()], pose: vec![0; clip.rig().channels()] }
    }

    /// A player at frame 0.
    pub fn player<'a, 'm>(&'m mut self, clip: Clip<'a>) -> Result<Player<'a, 'm>> {
        Ok(Player::new(clip, &mut self.states, &mut self.pose)?)
    }
}

/// The figure of one frame after another, each view by its own camera.
pub struct Figure<'a, 'm> {
    player: Player<'a, 'm>,
    stages: Vec<Stage<RIG_JOINTS>>,
    size: [usize; 2],
    factor: usize,
}

impl<'a, 'm> Figure<'a, 'm> {
    /// Sets up the cameras for pictures of `size` (columns, rows).
    pub fn new(mut player: Player<'a, 'm>, size: [usize; 2], views: &[View]) -> Result<Figure<'a, 'm>> {
        let factor = size[0].max(size[1]).div_ceil(MOST_PIXELS);
        let [width, height] = size.map(|pixels| pixels.div_ceil(factor) as u16);
        let canvas = Canvas { width, height };
        let stage = |view: &View| Stage::of_clip(&mut player, canvas, *view).context("this figure cannot be drawn");
        let stages = views.iter().map(stage).collect::<Result<_>>()?;
        Ok(Figure { player, stages, size, factor })
    }

    /// Goes to a frame.
    pub fn seek(&mut self, frame: u32) {
        self.player.seek(frame);
    }

    /// The frame as a view's camera sees it.
    pub fn scene(&mut self, view: usize) -> Scene {
        Scene::of(&mut self.stages[view], self.player.pose(), self.factor as f32)
    }

    /// The same as a picture. Pixels are at most [`MOST_PIXELS`] a side.
    pub fn image(&mut self, view: usize, look: Look, palette: &Palette) -> Image {
        let [width, height] = self.size;
        match look {
            Look::Smooth => smooth::draw(&self.scene(view), width, height, palette),
            Look::Pixels => {
                let mut shades = Shades::new(width, height);
                shades.draw(self.stages[view].look(self.player.pose()), true, palette.is_mono());
                shades.image(palette)
            }
        }
    }
}
