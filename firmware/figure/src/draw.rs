//! Draws a frame's lines into any `embedded-graphics` target.

use crate::lines::{Line, Lines, pixel};
use embedded_graphics::pixelcolor::{BinaryColor, Gray4, Gray8, PixelColor, Rgb565, Rgb888};
use embedded_graphics::prelude::{DrawTarget, Drawable, Point, Primitive};
use embedded_graphics::primitives::{Circle, Line as Stroke, PrimitiveStyle, PrimitiveStyleBuilder};

/// A display's way to show brightness.
pub trait Ink: PixelColor {
    /// The colour for a brightness, 0 the background; `None` leaves out what the display cannot tell from the figure.
    fn of_shade(shade: u8) -> Option<Self>;
}

impl Ink for Gray4 {
    fn of_shade(shade: u8) -> Option<Self> {
        Some(Gray4::new(shade >> 4))
    }
}

impl Ink for Gray8 {
    fn of_shade(shade: u8) -> Option<Self> {
        Some(Gray8::new(shade))
    }
}

impl Ink for BinaryColor {
    fn of_shade(shade: u8) -> Option<Self> {
        match shade {
            0 => Some(BinaryColor::Off),
            1..64 => None,
            _ => Some(BinaryColor::On),
        }
    }
}

impl Ink for Rgb565 {
    fn of_shade(shade: u8) -> Option<Self> {
        Some(Rgb565::new(shade >> 3, shade >> 2, shade >> 3))
    }
}

impl Ink for Rgb888 {
    fn of_shade(shade: u8) -> Option<Self> {
        Some(Rgb888::new(shade, shade, shade))
    }
}

impl<const N: usize> Lines<N> {
    /// Clears the target and draws the ground, the bones from far to near, and the head.
    pub fn draw<D>(&self, target: &mut D) -> Result<(), D::Error>
    where
        D: DrawTarget,
        D::Color: Ink,
    {
        if let Some(background) = D::Color::of_shade(0) {
            target.clear(background)?;
        }
        for line in self.ground.iter().chain(self.far_to_near()) {
            stroke(line, target)?;
        }
        let Some(head) = self.head else { return Ok(()) };
        let (Some(ink), Some(inside)) = (D::Color::of_shade(head.shade), D::Color::of_shade(0)) else { return Ok(()) };
        // An odd number of pixels across, so that it stands even about the pixel in its middle.
        let radius = pixel(head.radius.saturating_add(8)).max(1);
        let corner = |x: i16| pixel(x) - radius;
        let style = PrimitiveStyleBuilder::new().stroke_color(ink).stroke_width(1).fill_color(inside).build();
        let circle = Circle::new(Point::new(corner(head.centre[0]), corner(head.centre[1])), 2 * radius as u32 + 1);
        circle.into_styled(style).draw(target)
    }
}

fn stroke<D>(line: &Line, target: &mut D) -> Result<(), D::Error>
where
    D: DrawTarget,
    D::Color: Ink,
{
    let Some(ink) = D::Color::of_shade(line.shade) else { return Ok(()) };
    let [from, to] = [line.from, line.to].map(|end| Point::new(pixel(end[0]), pixel(end[1])));
    Stroke::new(from, to).into_styled(PrimitiveStyle::with_stroke(ink, 1)).draw(target)
}
