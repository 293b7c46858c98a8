//! The firmware's figure and its face in a terminal.

use super::cells::{Dots, Grid};
use super::picture::Show;
use super::playback::Playback;
use super::settings::Settings;
use anyhow::{Context, Result};
use pantin::Player;
use pantin_figure::solid::SolidFigure;
use pantin_figure::{Canvas, RIG_JOINTS, View};
use pantin_images::shades::Depth;
use pantin_images::shades::Shades;
use pantin_pictures::face::cast::Cast;
use pantin_pictures::render::figure::MOST_PIXELS;

/// A clip's body, its face, or both; their cameras are set up again when the terminal or the view changes.
pub struct Figure<'a, 'm> {
    playback: Playback<'a, 'm>,
    /// Looks through the clip for the camera, so that the playback keeps its place.
    scout: Player<'a, 'm>,
    shown: Option<Shown>,
    /// From where the face is seen straight ahead.
    ahead: View,
}

/// What one view on one canvas shows.
struct Shown {
    canvas: Canvas,
    view: View,
    solid: bool,
    body: Option<SolidFigure<RIG_JOINTS>>,
    face: Option<Cast<'static>>,
}

impl<'a, 'm> Figure<'a, 'm> {
    /// Both at the clip's begin.
    pub fn new(playback: Playback<'a, 'm>, scout: Player<'a, 'm>, ahead: View) -> Figure<'a, 'm> {
        Figure { playback, scout, shown: None, ahead }
    }

    fn set_up(&mut self, canvas: Canvas, settings: &Settings) -> Result<()> {
        let &Settings { view, solid, .. } = settings;
        if self.shown.as_ref().is_none_or(|shown| (shown.canvas, shown.view, shown.solid) != (canvas, view, solid)) {
            let from = View { orbit: view.orbit - self.ahead.orbit, tilt: view.tilt - self.ahead.tilt, ..view };
            let face = Cast::of_clip(self.scout.clip(), canvas, &[from])?;
            let area = if face.is_some() { canvas.with_face().body } else { canvas };
            let body = match self.scout.clip().rig().joint_count() {
                0 => None,
                _ => {
                    let body = SolidFigure::of_clip(&mut self.scout, area, view, settings.look);
                    let mut body = body.context("this figure cannot be drawn")?;
                    if !solid {
                        body.make_room(false);
                        body.aim(&mut self.scout, view);
                    }
                    Some(body)
                }
            };
            self.shown = Some(Shown { canvas, view, solid, body, face });
        }
        Ok(())
    }
}

/// The pixels of a grid's first `rows`, and how they become letters.
fn canvas(settings: &Settings, grid: &Grid, rows: usize) -> (Dots, Canvas) {
    let dots = settings.dots(rows);
    let [across, down] = dots.pixels();
    let [width, height] = [grid.columns * across, rows * down].map(|pixels| pixels.min(MOST_PIXELS) as u16);
    (dots, Canvas { width, height })
}

impl Show for Figure<'_, '_> {
    fn draw(&mut self, frame: u32, settings: &Settings, grid: &mut Grid, rows: usize) -> Result<()> {
        let (dots, canvas) = canvas(settings, grid, rows);
        self.set_up(canvas, settings)?;
        let pose = self.playback.pose(frame);
        let mut shades = Shades::new(canvas.width.into(), canvas.height.into());
        if let Some(Shown { body, face, .. }) = &mut self.shown {
            match body {
                Some(body) if settings.solid => {
                    let depth = if settings.in_bits() { Depth::Bits } else { settings.palette.depth() };
                    shades.draw_solid(body, pose, settings.ground, depth);
                }
                Some(body) => shades.draw(body.lines(), pose, settings.ground, settings.in_bits()),
                None => {}
            }
            if let Some(cast) = face {
                shades.draw_lines(&cast.lines(pose.values, 0), settings.in_bits());
            }
        }
        grid.show(&shades, rows, dots, &settings.palette, settings.coloured());
        Ok(())
    }

    fn has_views(&self) -> bool {
        true
    }
}
