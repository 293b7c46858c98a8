//! What brightness looks like: from the paper over the farthest limbs' colour to the nearest ones'.

use crate::shades::{Depth, Mark};
use anyhow::{Context, Result, ensure};
use embedded_graphics::pixelcolor::{Rgb565, Rgb888, RgbColor};
use pantin_figure::Ink;
use pantin_figure::ink::BodyPart;
use pantin_figure::solid::Look;
use std::str::FromStr;

/// Red, green and blue, 0 to 255.
pub type Rgb = [u8; 3];

/// The figure's own scale of brightness: its farthest and nearest limbs. The ground's lines are darker.
pub const FARTHEST: u8 = 80;
/// Less than the ground's farthest lines.
const DARKEST: u8 = 8;
/// The nearest.
pub const NEAREST: u8 = 255;

/// Colours by name: paper, far, near.
const NAMED: [(&str, &str); 9] = [
    ("grey", "000000,ffffff"),
    ("mono", "000000,ffffff"),
    ("phone", "000000,ffeccd"),
    ("oled", "000000,1c5a7c,d0f6ff"),
    ("amber", "0c0600,6a3c00,ffc04a"),
    ("green", "000a04,0b5c2c,7dff9e"),
    ("blueprint", "0e2a52,5a83b8,f6faff"),
    ("paper", "ffffff,b8bcc4,14161c"),
    ("dusk", "14121f,47649c,ffb56e"),
];

/// How brightness becomes one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scale {
    /// Two colours alone.
    Mono,
    /// 16 steps, as the reference display has.
    Grey,
    /// The firmware's own hues: each side of the figure has one.
    Hues,
    /// From paper over far to near.
    Ramp,
}

/// The colours of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Palette {
    paper: Rgb,
    far: Rgb,
    near: Rgb,
    scale: Scale,
}

impl Palette {
    /// The colour of a display's pixel.
    pub fn pixel(&self, body_part: BodyPart, shade: u8) -> Rgb {
        match self.scale {
            Scale::Mono => self.ramp(body_part, if shade == 0 { 0 } else { NEAREST }),
            Scale::Grey => self.ramp(body_part, (shade >> 4) * 17),
            Scale::Hues => rgb(Rgb565::of(body_part, shade).into()),
            Scale::Ramp => self.ramp(body_part, shade),
        }
    }

    /// The colour of a pixel of [`Shades`](crate::shades::Shades).
    pub fn mark(&self, mark: &Mark) -> Rgb {
        mark.rgb.unwrap_or_else(|| self.pixel(mark.body_part, mark.shade))
    }

    /// The display on which solid figures are drawn.
    pub fn depth(&self) -> Depth {
        match self.scale {
            Scale::Mono => Depth::Bits,
            Scale::Hues => Depth::Hues,
            Scale::Grey | Scale::Ramp => Depth::Greys,
        }
    }

    /// At most 256 colours that represent a picture of a solid figure: of each material every 16th brightness, lit and shaded; on displays of
    /// greys the greys, and four steps from each to the next.
    pub fn solid_colours(&self, look: &Look) -> Vec<Rgb> {
        let mut colours = vec![self.paper, self.margin(), self.letters()];
        if self.scale == Scale::Hues {
            let lights = (143..=256).step_by(16).chain((88..=160).step_by(16)).chain([256]);
            let of = |light: u16| look.tints().map(move |tint| rgb(Rgb565::tint(&tint, light).into()));
            lights.flat_map(of).for_each(|colour| {
                if !colours.contains(&colour) && colours.len() < 256 {
                    colours.push(colour);
                }
            });
        } else {
            colours.extend((0..=60).map(|step| self.ramp(BodyPart::Middle, (step * 17 / 4) as u8)));
        }
        colours
    }

    /// The colour of a brightness, without steps.
    pub fn ramp(&self, body_part: BodyPart, shade: u8) -> Rgb {
        match shade {
            _ if self.scale == Scale::Hues => rgb(Rgb888::of(body_part, shade)),
            ..FARTHEST => mix(self.paper, self.far, shade, FARTHEST),
            _ => mix(self.far, self.near, shade - FARTHEST, NEAREST - FARTHEST),
        }
    }

    /// Background.
    pub fn paper(&self) -> Rgb {
        self.paper
    }

    /// What is between pictures.
    pub fn margin(&self) -> Rgb {
        mix(self.paper, self.near, 3, 16)
    }

    /// Letters.
    pub fn letters(&self) -> Rgb {
        mix(self.paper, self.near, 13, 16)
    }

    /// Whether there are two colours alone, and none between them.
    pub fn is_mono(&self) -> bool {
        self.scale == Scale::Mono
    }

    fn tones(&self) -> &'static [BodyPart] {
        if self.scale == Scale::Hues { &[BodyPart::Middle, BodyPart::Left, BodyPart::Right] } else { &[BodyPart::Middle] }
    }

    /// At most 256 colours that represent a smooth picture as well as all of them do: those of the figure, each in 16 parts to
    /// the paper, and the ground's and the margins'.
    pub fn smooth_colours(&self) -> Vec<Rgb> {
        let steps = 14 / self.tones().len() as u16;
        let shade = move |step: u16| FARTHEST + (step * u16::from(NEAREST - FARTHEST) / (steps - 1)) as u8;
        let inks = self.tones().iter().flat_map(|&body_part| (0..steps).map(move |step| self.ramp(body_part, shade(step))));
        let figure = inks.flat_map(|ink| (1..=16).map(move |part| mix(self.paper, ink, part, 16)));
        let ground = (1..=24).map(|step| self.ramp(BodyPart::Ground, step * 8));
        [self.paper, self.margin(), self.letters()].into_iter().chain(ground).chain(figure).collect()
    }

    /// At most 256 colours of pictures made of a display's pixels: all of them, or every fourth brightness of a palette of several
    /// hues.
    pub fn pixel_colours(&self) -> Vec<Rgb> {
        let step = if self.tones().len() > 1 { 4 } else { 1 };
        let shades = || (DARKEST..=NEAREST).rev().step_by(step);
        let mut colours = vec![self.paper, self.margin(), self.letters()];
        let tones = self.tones().iter().chain([&BodyPart::Ground]);
        for colour in tones.flat_map(|&body_part| shades().map(move |shade| self.pixel(body_part, shade))) {
            if !colours.contains(&colour) && colours.len() < 256 {
                colours.push(colour);
            }
        }
        colours
    }
}

impl Default for Palette {
    /// The reference display's: 16 greys.
    fn default() -> Palette {
        Palette { paper: [0; 3], far: [FARTHEST; 3], near: [255; 3], scale: Scale::Grey }
    }
}

impl FromStr for Palette {
    type Err = anyhow::Error;

    /// A name, or two colours `RRGGBB,RRGGBB` (paper, ink), or three (paper, far, near).
    fn from_str(text: &str) -> Result<Palette> {
        let named = NAMED.iter().find(|(name, _)| *name == text);
        let colours: Option<Vec<Rgb>> = named.map_or(text, |(_, colours)| colours).split(',').map(colour).collect();
        let names: Vec<&str> = NAMED.iter().map(|(name, _)| *name).collect();
        let expected = || format!("expected one of {}, or colours as RRGGBB,RRGGBB (paper, ink)", names.join(", "));
        let colours = colours.with_context(expected)?;
        ensure!((2..=3).contains(&colours.len()), expected());
        let (paper, near) = (colours[0], colours[colours.len() - 1]);
        let far = if colours.len() == 3 { colours[1] } else { mix(paper, near, FARTHEST, NEAREST) };
        let scale = match text {
            "mono" => Scale::Mono,
            "grey" => Scale::Grey,
            "phone" => Scale::Hues,
            _ => Scale::Ramp,
        };
        Ok(Palette { paper, far, near, scale })
    }
}

fn rgb(colour: Rgb888) -> Rgb {
    [colour.r(), colour.g(), colour.b()]
}

fn colour(text: &str) -> Option<Rgb> {
    let digits = text.len() == 6 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let number = u32::from_str_radix(text, 16).ok().filter(|_| digits)?;
    Some([(number >> 16) as u8, (number >> 8) as u8, number as u8])
}

/// `part` of `whole` of the way between two colours.
fn mix(from: Rgb, to: Rgb, part: u8, whole: u8) -> Rgb {
    let (part, whole) = (i32::from(part), i32::from(whole));
    std::array::from_fn(|i| {
        let (from, to) = (i32::from(from[i]), i32::from(to[i]));
        (from + ((to - from) * part * 2 + whole).div_euclid(2 * whole)) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIDDLE: BodyPart = BodyPart::Middle;

    #[test]
    fn grey_is_the_reference_display_and_no_colour_gets_lost() {
        let grey: Palette = "grey".parse().unwrap();
        assert_eq!(grey, Palette::default());
        for shade in 0..=255u8 {
            assert_eq!(grey.ramp(MIDDLE, shade), [shade; 3]);
            assert_eq!(grey.pixel(BodyPart::Left, shade), [(shade >> 4) * 17; 3]);
        }
        for (name, _) in NAMED {
            let palette: Palette = name.parse().unwrap();
            assert!(palette.smooth_colours().len() <= 256, "{name}");
            assert_eq!(palette.ramp(MIDDLE, 0), palette.paper, "{name}");
            let colours = palette.pixel_colours();
            // A GIF's colours are exact, or one of the phone's 32 steps off where there are hues.
            let off = if name == "phone" { 9 } else { 0 };
            for (body_part, shade) in [MIDDLE, BodyPart::Left, BodyPart::Right, BodyPart::Ground]
                .into_iter()
                .flat_map(|body_part| (DARKEST..=255).map(move |s| (body_part, s)))
            {
                let colour = palette.pixel(body_part, shade);
                let apart = |other: &Rgb| (0..3).map(|i| colour[i].abs_diff(other[i])).max();
                assert!(colours.iter().filter_map(apart).min() <= Some(off), "{name} {body_part:?} {shade}");
            }
        }
    }

    #[test]
    fn two_or_three_colours_make_a_palette() {
        let own: Palette = "102030,f0e0d0".parse().unwrap();
        assert_eq!((own.pixel(MIDDLE, 0), own.pixel(MIDDLE, 255)), ([0x10, 0x20, 0x30], [0xf0, 0xe0, 0xd0]));
        assert_eq!("102030,0000ff,f0e0d0".parse::<Palette>().unwrap().pixel(MIDDLE, FARTHEST), [0, 0, 255]);
        for wrong in ["", "sepia", "102030", "10203,f0e0d0", "10203g,f0e0d0", "+10203,f0e0d0", "0,0,0,0"] {
            let error = wrong.parse::<Palette>().unwrap_err().to_string();
            assert!(error.contains("blueprint") && error.contains("RRGGBB"), "{wrong}: {error}");
        }
    }

    #[test]
    fn the_phones_sides_have_their_hues() {
        let phone: Palette = "phone".parse().unwrap();
        let [left, right] = [BodyPart::Left, BodyPart::Right].map(|body_part| phone.pixel(body_part, 255));
        assert!(left[0] > left[2] && right[2] > right[0]);
    }
}
