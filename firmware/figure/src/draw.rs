//! Draws a frame's lines on any surface, and into any `embedded-graphics` target.

use crate::ink::{BodyPart, Ink};
use crate::lines::{Line, pixel};
use crate::raster::{Dots, disc, dotted, line, smooth, thick};
use crate::renderer::FigureRenderer;
use crate::rotation::RotationBackend;
use crate::surface::{OnTarget, Surface};
use embedded_graphics::draw_target::DrawTarget;
use pantin::{Pose, WrongForm};

/// How lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawStyle {
    /// The grid below the figure.
    pub ground: bool,
    /// Edges between the pixels' greys.
    pub smooth: bool,
}

/// Why a figure was not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DrawError<E> {
    /// The pose has another form than the clip for which the renderer was set up.
    WrongForm(WrongForm),
    /// The display's own error.
    Target(E),
}

impl<E: core::fmt::Debug> core::fmt::Display for DrawError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            DrawError::WrongForm(error) => error.fmt(f),
            DrawError::Target(error) => write!(f, "the display failed: {error:?}"),
        }
    }
}

impl<E: core::fmt::Debug> core::error::Error for DrawError<E> {}

impl Default for DrawStyle {
    fn default() -> Self {
        DrawStyle { ground: true, smooth: false }
    }
}

impl<const N: usize, R: RotationBackend> FigureRenderer<N, R> {
    /// Draws the pose that was placed last on a clear surface: the ground, the bones from far to near, and the head.
    #[inline(never)]
    pub fn draw_on<S: Surface>(&mut self, surface: &mut S, style: DrawStyle) {
        if style.ground {
            self.draw_ground(surface, style.smooth, None);
        }
        self.sort();
        self.each_bone(|line| stroke(&line, surface, style.smooth));
        if let Some(head) = self.head() {
            let ink = S::Ink::of(BodyPart::Middle, head.shade);
            disc(surface, head.centre.map(pixel), pixel(head.radius.saturating_add(8)).max(1), ink, S::Ink::DARK);
        }
    }

    /// Draws the ground, in its own brightness or in one colour.
    pub(crate) fn draw_ground<S: Surface>(&self, surface: &mut S, smooth: bool, ink: Option<S::Ink>) {
        if self.ground().dotted {
            let mut dots = Dots::on(surface);
            self.each_dot(|dot| {
                let ink = ink.unwrap_or(S::Ink::of(BodyPart::Ground, dot.shade));
                dots.put([pixel(dot.place[0]), pixel(dot.place[1])], ink);
            });
            dots.mark();
        } else {
            self.each_ground_line(|ground| match ink {
                None => stroke(&ground, surface, smooth),
                Some(ink) => line(surface, ground.from.map(pixel), ground.to.map(pixel), ink),
            });
        }
    }

    /// Clears the target and draws the figure in a pose, with the ground: [`FigureRenderer::draw_on`] leaves it out by its style.
    ///
    /// The picture has the size of the canvas; pixels beyond it, or beyond the target, can be passed to the target, which ignores
    /// them as `embedded-graphics` asks of every driver.
    pub fn draw<D>(&mut self, pose: Pose<'_>, target: &mut D) -> Result<(), DrawError<D::Error>>
    where
        D: DrawTarget,
        D::Color: Ink,
    {
        target.clear(D::Color::DARK).map_err(DrawError::Target)?;
        self.draw_over(pose, target)
    }

    /// Draws the figure in a pose over what the target shows: beside other figures ([`FigureRenderer::shift`]), or on a background.
    pub fn draw_over<D>(&mut self, pose: Pose<'_>, target: &mut D) -> Result<(), DrawError<D::Error>>
    where
        D: DrawTarget,
        D::Color: Ink,
    {
        self.set_pose(pose).map_err(DrawError::WrongForm)?;
        let mut surface = OnTarget::new(target);
        self.draw_on(&mut surface, DrawStyle::default());
        surface.outcome().map_err(DrawError::Target)
    }
}

/// Draws a line in its width.
pub fn stroke<S: Surface>(of: &Line, surface: &mut S, soft: bool) {
    let ink = S::Ink::of(of.body_part, of.shade);
    let gap = S::Ink::gap(of.body_part);
    let [from, to] = [of.from, of.to];
    if soft && gap == 1 {
        let [from, to] = [from, to].map(|end| end.map(i32::from));
        return beside(from, to, of.width, |from, to| smooth(surface, from, to, ink));
    }
    let [from, to] = [[pixel(from[0]), pixel(from[1])], [pixel(to[0]), pixel(to[1])]];
    if gap > 1 {
        return dotted(surface, from, to, ink, gap);
    }
    if of.width == 1 {
        return line(surface, from, to, ink);
    }
    thick(surface, from, to, ink, of.width.into());
}

/// As many smooth lines as a stroke is wide, a pixel apart across its longer way.
fn beside(from: [i32; 2], to: [i32; 2], width: u8, mut draw: impl FnMut([i32; 2], [i32; 2])) {
    let steep = (to[1] - from[1]).abs() > (to[0] - from[0]).abs();
    for index in 0..i32::from(width) {
        let aside = (index - i32::from(width) / 2) * 16;
        let moved = |[x, y]: [i32; 2]| if steep { [x + aside, y] } else { [x, y + aside] };
        draw(moved(from), moved(to));
    }
}
