//! The firmware's face in a terminal.

use super::cells::Grid;
use super::figure::canvas;
use super::picture::Show;
use super::playback::Playback;
use super::settings::Settings;
use crate::face::cast::Cast;
use crate::render::shades::Shades;
use anyhow::{Context, Result};
use pantin::Clip;
use pantin_figure::{Canvas, View};

/// A clip's face, its camera set up again when the terminal or the view changes.
pub struct Face<'a, 'm> {
    clip: Clip<'a>,
    playback: Playback<'a, 'm>,
    /// From where it is seen straight ahead.
    ahead: View,
    cast: Option<(Canvas, View, Cast)>,
}

impl<'a, 'm> Face<'a, 'm> {
    /// Of a clip that is one.
    pub fn new(clip: Clip<'a>, playback: Playback<'a, 'm>, ahead: View) -> Face<'a, 'm> {
        Face { clip, playback, ahead, cast: None }
    }

    fn set_up(&mut self, canvas: Canvas, view: View) -> Result<()> {
        if self.cast.as_ref().is_none_or(|(before, seen, _)| (*before, *seen) != (canvas, view)) {
            let from = View { orbit: view.orbit - self.ahead.orbit, tilt: view.tilt - self.ahead.tilt, ..view };
            let cast = Cast::of_clip(&self.clip, canvas, &[from])?.context("this clip is no face")?;
            self.cast = Some((canvas, view, cast));
        }
        Ok(())
    }
}

impl Show for Face<'_, '_> {
    fn draw(&mut self, frame: u32, settings: &Settings, grid: &mut Grid, rows: usize) -> Result<()> {
        let (dots, canvas) = canvas(settings, grid, rows);
        self.set_up(canvas, settings.view)?;
        let pose = self.playback.pose(frame);
        let mut shades = Shades::new(canvas.width.into(), canvas.height.into());
        if let Some((_, _, cast)) = &mut self.cast {
            shades.draw_lines(&cast.lines(pose.values, 0), settings.in_bits());
        }
        grid.show(&shades, rows, dots, &settings.palette, settings.coloured());
        Ok(())
    }

    fn has_views(&self) -> bool {
        true
    }
}
