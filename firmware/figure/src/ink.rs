//! A display's way to show what a line is of, and how bright.

use embedded_graphics::pixelcolor::{BinaryColor, Gray4, Gray8, PixelColor, Rgb565, Rgb888};

/// What a line is of: displays with colours tell it by hue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyPart {
    /// The grid on which the figure stands.
    Ground,
    /// Trunk and head, and limbs of no side.
    Middle,
    /// The figure's own left.
    Left,
    /// The figure's own right.
    Right,
}

/// A colour in which figures are drawn.
pub trait Ink: PixelColor {
    /// The background.
    const DARK: Self;

    /// The colour of a tone in a brightness.
    fn of(body_part: BodyPart, shade: u8) -> Self;

    /// Pixels from one dot of a line to the next: more than 1 where the colour cannot set the ground apart from the figure.
    fn gap(_tone: BodyPart) -> u32 {
        1
    }
}

impl Ink for Gray4 {
    const DARK: Self = Gray4::new(0);

    #[inline]
    fn of(_tone: BodyPart, shade: u8) -> Self {
        Gray4::new(shade >> 4)
    }
}

impl Ink for Gray8 {
    const DARK: Self = Gray8::new(0);

    #[inline]
    fn of(_tone: BodyPart, shade: u8) -> Self {
        Gray8::new(shade)
    }
}

impl Ink for BinaryColor {
    const DARK: Self = BinaryColor::Off;

    #[inline]
    fn of(_tone: BodyPart, shade: u8) -> Self {
        BinaryColor::from(shade > 0)
    }

    #[inline]
    fn gap(body_part: BodyPart) -> u32 {
        if body_part == BodyPart::Ground { 5 } else { 1 }
    }
}

/// Red, green and blue of a tone at full brightness.
const fn hue(body_part: BodyPart) -> [u32; 3] {
    match body_part {
        BodyPart::Ground => [170, 255, 230],
        BodyPart::Middle => [255, 236, 205],
        BodyPart::Left => [255, 160, 60],
        BodyPart::Right => [80, 190, 255],
    }
}

#[inline]
fn tinted(body_part: BodyPart, shade: u8) -> [u8; 3] {
    hue(body_part).map(|full| ((full * u32::from(shade)) >> 8) as u8)
}

impl Ink for Rgb565 {
    const DARK: Self = Rgb565::new(0, 0, 0);

    #[inline]
    fn of(body_part: BodyPart, shade: u8) -> Self {
        let [red, green, blue] = tinted(body_part, shade);
        Rgb565::new(red >> 3, green >> 2, blue >> 3)
    }
}

impl Ink for Rgb888 {
    const DARK: Self = Rgb888::new(0, 0, 0);

    #[inline]
    fn of(body_part: BodyPart, shade: u8) -> Self {
        let [red, green, blue] = tinted(body_part, shade);
        Rgb888::new(red, green, blue)
    }
}
