//! A frame as a display of 128x64 pixels shows it: drawn by the firmware's code.

use crate::error::exception;
use crate::facts::open;
use anyhow::{Context, Result, ensure};
use pantin::{ChannelState, Player};
use pantin_figure::draw::DrawStyle;
use pantin_figure::surface::{Framebuffer, MonoPages};
use pantin_figure::{Canvas, FigureRenderer, RIG_JOINTS, View};
use pyo3::prelude::*;

const WIDTH: usize = 128;
const HEIGHT: usize = 64;

/// The figure at a frame: a byte for each pixel, row by row, 1 where it is lit.
#[pyfunction]
pub fn image(py: Python<'_>, clip: &[u8], frame: i64) -> PyResult<Vec<u8>> {
    py.detach(|| pixels(clip, frame)).map_err(|error| exception(py, &error, None))
}

fn pixels(bytes: &[u8], frame: i64) -> Result<Vec<u8>> {
    let clip = open(bytes)?;
    let last = clip.frames() - 1;
    let found = u32::try_from(frame).ok().filter(|frame| *frame <= last);
    let frame = found.with_context(|| format!("frame {frame}; the clip has frames 0 to {last}"))?;
    ensure!(clip.rig().joint_count() > 0, "the clip has no joints, so there is no figure to draw");
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let canvas = Canvas { width: WIDTH as u16, height: HEIGHT as u16 };
    let renderer = FigureRenderer::<RIG_JOINTS>::of_clip(&mut player, canvas, View::default());
    let mut renderer = renderer.context("this figure cannot be drawn")?;
    player.seek(frame);
    renderer.set_pose(player.pose())?;
    let mut display = Framebuffer::<MonoPages<WIDTH, HEIGHT, { WIDTH * HEIGHT / 8 }>>::new();
    renderer.draw_on(&mut display, DrawStyle::default());
    Ok((0..WIDTH * HEIGHT).map(|pixel| display.pixel(pixel % WIDTH, pixel / WIDTH).is_on().into()).collect())
}
