//! A display of any size, drawn on by the firmware's own code: what each pixel is of, and how bright.

use crate::image::Image;
use crate::palette::{Palette, Rgb};
use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{BinaryColor, Gray4, GrayColor, PixelColor, Rgb565, Rgb888, RgbColor};
use pantin::Pose;
use pantin_figure::FigureRenderer;
use pantin_figure::draw::stroke;
use pantin_figure::ink::{BodyPart, Ink};
use pantin_figure::lines::Line;
use pantin_figure::solid::{HeadPose, SolidFigure};
use pantin_figure::surface::{OnTarget, Surface};
use std::convert::Infallible;

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// What it is of.
    pub body_part: BodyPart,
    /// How bright; 0 is dark, and of nothing.
    pub shade: u8,
    /// The colour itself, of solid figures on displays of hues.
    pub rgb: Option<Rgb>,
}

impl PixelColor for Mark {
    type Raw = ();
}

impl Ink for Mark {
    const DARK: Mark = Mark { body_part: BodyPart::Ground, shade: 0, rgb: None };

    fn of(body_part: BodyPart, shade: u8) -> Mark {
        Mark { body_part, shade, rgb: None }
    }
}

/// A face on the head of a solid figure.
pub trait HeadFace {
    /// Draws it.
    fn draw<S: Surface>(&mut self, surface: &mut S, head: &HeadPose);
}

/// The figure's own face, which it draws itself.
struct OwnFace;

impl HeadFace for OwnFace {
    fn draw<S: Surface>(&mut self, _: &mut S, _: &HeadPose) {}
}

/// The display's pixels.
#[derive(Clone, Debug)]
pub struct Shades {
    width: usize,
    marks: Vec<Mark>,
}

impl Shades {
    /// A dark display.
    pub fn new(width: usize, height: usize) -> Shades {
        Shades { width, marks: vec![Mark::DARK; width * height] }
    }

    /// Columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// What a pixel shows; one outside is dark.
    pub fn at(&self, x: usize, y: usize) -> Mark {
        if x < self.width { self.marks.get(y * self.width + x).copied().unwrap_or(Mark::DARK) } else { Mark::DARK }
    }

    /// Draws a pose as the firmware does: on a display of two colours, or of more.
    pub fn draw<const N: usize>(&mut self, renderer: &mut FigureRenderer<N>, pose: Pose<'_>, ground: bool, mono: bool) {
        renderer.set_pose(pose).expect("the renderer was set up for this clip");
        self.draw_placed(renderer, ground, mono);
    }

    /// Draws the pose that the renderer placed last.
    pub fn draw_placed<const N: usize>(&mut self, renderer: &mut FigureRenderer<N>, ground: bool, mono: bool) {
        self.marks.fill(Mark::DARK);
        let look = pantin_figure::DrawStyle { ground, smooth: false };
        if mono {
            renderer.draw_on(&mut OnTarget::new(&mut Bits(self)), look);
        } else {
            renderer.draw_on(&mut OnTarget::new(self), look);
        }
    }

    /// Draws a pose of a solid figure as the firmware does: on a display of two colours, of 16 greys, or of hues, as the palette has them.
    pub fn draw_solid<const N: usize>(&mut self, figure: &mut SolidFigure<N>, pose: Pose<'_>, floor: bool, depth: Depth) {
        self.draw_solid_with(figure, pose, floor, depth, &mut OwnFace);
    }

    /// Draws a pose of a solid figure with a face on its head.
    pub fn draw_solid_with<const N: usize>(
        &mut self,
        figure: &mut SolidFigure<N>,
        pose: Pose<'_>,
        floor: bool,
        depth: Depth,
        face: &mut impl HeadFace,
    ) {
        figure.set_pose(pose).expect("the figure was set up for this clip");
        self.marks.fill(Mark::DARK);
        match depth {
            Depth::Bits => figure.draw_with_face(&mut OnTarget::new(&mut Bits(self)), floor, |s, head| face.draw(s, head)),
            Depth::Greys => figure.draw_with_face(&mut OnTarget::new(&mut Greys(self)), floor, |s, head| face.draw(s, head)),
            Depth::Hues => figure.draw_with_face(&mut OnTarget::new(&mut Hues(self)), floor, |s, head| face.draw(s, head)),
        }
    }

    /// Draws lines in their order, as the firmware does, over what is there.
    pub fn draw_lines(&mut self, lines: &[Line], mono: bool) {
        if mono {
            let mut bits = Bits(self);
            let mut surface = OnTarget::new(&mut bits);
            lines.iter().for_each(|line| stroke(line, &mut surface, false));
        } else {
            let mut surface = OnTarget::new(self);
            lines.iter().for_each(|line| stroke(line, &mut surface, false));
        }
    }

    /// What it looks like.
    pub fn image(&self, palette: &Palette) -> Image {
        Image::of(self.width, self.marks.iter().map(|mark| palette.mark(mark)).collect())
    }
}

impl OriginDimensions for Shades {
    fn size(&self) -> Size {
        Size::new(self.width as u32, (self.marks.len() / self.width) as u32)
    }
}

impl DrawTarget for Shades {
    type Color = Mark;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Mark>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        let size = self.size();
        for Pixel(place, mark) in pixels {
            let inside = (0..size.width as i32).contains(&place.x) && (0..size.height as i32).contains(&place.y);
            if inside {
                self.marks[place.y as usize * self.width + place.x as usize] = mark;
            }
        }
        Ok(())
    }
}

/// The colours of a display for solid figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Two.
    Bits,
    /// 16 greys.
    Greys,
    /// 65,536 colours.
    Hues,
}

/// A display of another kind whose pixels become marks.
macro_rules! display {
    ($(#[$doc:meta])* $name:ident, $colour:ty, $mark:expr) => {
        $(#[$doc])*
        struct $name<'a>(&'a mut Shades);

        impl OriginDimensions for $name<'_> {
            fn size(&self) -> Size {
                self.0.size()
            }
        }

        impl DrawTarget for $name<'_> {
            type Color = $colour;
            type Error = Infallible;

            fn draw_iter<I: IntoIterator<Item = Pixel<$colour>>>(&mut self, pixels: I) -> Result<(), Infallible> {
                let mark: fn($colour) -> Mark = $mark;
                self.0.draw_iter(pixels.into_iter().map(|Pixel(place, colour)| Pixel(place, mark(colour))))
            }
        }
    };
}

display! {
    /// The same as a display of two colours.
    Bits, BinaryColor, |bit| if bit.is_on() { Mark { body_part: BodyPart::Middle, shade: 255, rgb: None } } else { Mark::DARK }
}

display! {
    /// The same as a display of 16 greys.
    Greys, Gray4, |grey| Mark { body_part: BodyPart::Middle, shade: grey.luma() * 17, rgb: None }
}

display! {
    /// The same as a display of hues.
    Hues, Rgb565, |colour| {
        let colour: Rgb888 = colour.into();
        let rgb = [colour.r(), colour.g(), colour.b()];
        Mark { body_part: BodyPart::Middle, shade: rgb.into_iter().max().unwrap_or(0), rgb: Some(rgb) }
    }
}
