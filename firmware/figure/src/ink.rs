//! A display's way to show what a line is of, and how bright.

use crate::solid::{Light, Pattern, Tint};
use embedded_graphics::pixelcolor::{BinaryColor, Gray2, Gray4, Gray8, PixelColor, Rgb565, Rgb888};

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

    /// Whether the display has more than two colours: solid figures on others have patterns.
    const TONES: bool = true;

    /// Whether lit and shaded sides of solid figures differ, from a height of 80 pixels on.
    const SHADED: bool = true;

    /// Whether the display has hues: solid figures on others have sides of different brightness.
    const HUES: bool = false;

    /// The colour of a material of a solid figure. By default it is a grey.
    #[inline]
    fn tint(tint: &Tint, light: Light) -> Self {
        Self::of(BodyPart::Middle, ((u32::from(tint.grey) * 17 * u32::from(light)) >> 8).min(255) as u8)
    }
}

/// Red, green and blue of a material of a solid figure.
#[inline]
fn lit(tint: &Tint, light: Light) -> [u8; 3] {
    tint.rgb.map(|part| ((u32::from(part) * u32::from(light)) >> 8).min(255) as u8)
}

impl Ink for Gray4 {
    const DARK: Self = Gray4::new(0);

    #[inline]
    fn of(_tone: BodyPart, shade: u8) -> Self {
        Gray4::new(shade >> 4)
    }

    #[inline]
    fn tint(tint: &Tint, light: Light) -> Self {
        Gray4::new(((u32::from(tint.grey) * u32::from(light) + 128) >> 8).min(15) as u8)
    }
}

impl Ink for Gray2 {
    const DARK: Self = Gray2::new(0);
    const SHADED: bool = false;

    #[inline]
    fn of(_tone: BodyPart, shade: u8) -> Self {
        Gray2::new(shade >> 6)
    }

    /// Four greys do without depth.
    #[inline]
    fn tint(tint: &Tint, _light: Light) -> Self {
        Gray2::new(tint.grey >> 2)
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
    const TONES: bool = false;
    const SHADED: bool = false;

    #[inline]
    fn of(_tone: BodyPart, shade: u8) -> Self {
        BinaryColor::from(shade > 0)
    }

    #[inline]
    fn gap(body_part: BodyPart) -> u32 {
        if body_part == BodyPart::Ground { 5 } else { 1 }
    }

    #[inline]
    fn tint(tint: &Tint, _light: Light) -> Self {
        BinaryColor::from(tint.pattern != Pattern::Dark)
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
    const HUES: bool = true;

    #[inline]
    fn of(body_part: BodyPart, shade: u8) -> Self {
        let [red, green, blue] = tinted(body_part, shade);
        Rgb565::new(red >> 3, green >> 2, blue >> 3)
    }

    #[inline]
    fn tint(tint: &Tint, light: Light) -> Self {
        let [red, green, blue] = lit(tint, light);
        Rgb565::new(red >> 3, green >> 2, blue >> 3)
    }
}

impl Ink for Rgb888 {
    const DARK: Self = Rgb888::new(0, 0, 0);
    const HUES: bool = true;

    #[inline]
    fn of(body_part: BodyPart, shade: u8) -> Self {
        let [red, green, blue] = tinted(body_part, shade);
        Rgb888::new(red, green, blue)
    }

    #[inline]
    fn tint(tint: &Tint, light: Light) -> Self {
        let [red, green, blue] = lit(tint, light);
        Rgb888::new(red, green, blue)
    }
}
