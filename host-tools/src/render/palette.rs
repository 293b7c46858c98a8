//! What brightness looks like: from the paper over the farthest limbs' colour to the nearest ones'.

use anyhow::{Context, Result, ensure};
use std::str::FromStr;

/// Red, green and blue, 0 to 255.
pub type Rgb = [u8; 3];

/// The figure's own scale of brightness: its farthest and nearest limbs. What is darker is the ground.
pub const FARTHEST: u8 = 80;
/// The nearest.
pub const NEAREST: u8 = 255;
/// From here on a display of two colours shows ink, as [`pantin_figure::Ink`] has it: the figure without the ground.
pub const INKED: u8 = 64;

/// Colours by name: paper, far, near.
const NAMED: [(&str, &str); 8] = [
    ("grey", "000000,ffffff"),
    ("mono", "000000,ffffff"),
    ("oled", "000000,1c5a7c,d0f6ff"),
    ("amber", "0c0600,6a3c00,ffc04a"),
    ("green", "000a04,0b5c2c,7dff9e"),
    ("blueprint", "0e2a52,5a83b8,f6faff"),
    ("paper", "ffffff,b8bcc4,14161c"),
    ("dusk", "14121f,47649c,ffb56e"),
];

/// The colours of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Palette {
    paper: Rgb,
    far: Rgb,
    near: Rgb,
    /// Steps of brightness on a display of pixels: 2, 16 or 256.
    steps: u16,
}

impl Palette {
    /// The colour of a display's pixel of brightness `shade`.
    pub fn pixel(&self, shade: u8) -> Rgb {
        match self.steps {
            2 => self.ramp(if shade < INKED { 0 } else { NEAREST }),
            16 => self.ramp((shade >> 4) * 17),
            _ => self.ramp(shade),
        }
    }

    /// The colour of a brightness, without steps.
    pub fn ramp(&self, shade: u8) -> Rgb {
        match shade {
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
        self.steps == 2
    }

    /// At most 256 colours in which a smooth picture is told as well as by all of them: 15 of the figure, each in 16 parts to the
    /// paper, and the ground's and the margins'.
    pub fn smooth_colours(&self) -> Vec<Rgb> {
        let shades = (0..14u8).map(|step| FARTHEST + (u16::from(step) * 175 / 13) as u8);
        let edges = shades.flat_map(|shade| (1..=16).map(move |part| (shade, part)));
        let figure = edges.map(|(shade, part)| mix(self.paper, self.ramp(shade), part, 16));
        let ground = (1..=8).map(|step| self.ramp(step * 8));
        [self.paper, self.margin(), self.letters()].into_iter().chain(ground).chain(figure).collect()
    }

    /// The colours of pictures made of a display's pixels.
    pub fn pixel_colours(&self) -> Vec<Rgb> {
        let mut colours: Vec<Rgb> = (0..=255).map(|shade| self.pixel(shade)).collect();
        colours.dedup();
        colours.truncate(254);
        colours.extend([self.margin(), self.letters()]);
        colours
    }
}

impl Default for Palette {
    /// The reference display's: 16 greys.
    fn default() -> Palette {
        Palette { paper: [0; 3], far: [FARTHEST; 3], near: [255; 3], steps: 16 }
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
        let steps = match text {
            "mono" => 2,
            "grey" => 16,
            _ => 256,
        };
        Ok(Palette { paper, far, near, steps })
    }
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

    #[test]
    fn grey_is_the_reference_display_and_no_colour_gets_lost() {
        let grey: Palette = "grey".parse().unwrap();
        assert_eq!(grey, Palette::default());
        for shade in 0..=255u8 {
            assert_eq!(grey.ramp(shade), [shade; 3]);
            assert_eq!(grey.pixel(shade), [(shade >> 4) * 17; 3]);
        }
        for (name, _) in NAMED {
            let palette: Palette = name.parse().unwrap();
            assert!(palette.smooth_colours().len() <= 256 && palette.pixel_colours().len() <= 256, "{name}");
            let ends = [palette.ramp(0), palette.ramp(FARTHEST), palette.ramp(NEAREST)];
            assert_eq!(ends, [palette.paper, palette.far, palette.near]);
        }
    }

    #[test]
    fn two_or_three_colours_make_a_palette() {
        let own: Palette = "102030,f0e0d0".parse().unwrap();
        assert_eq!((own.pixel(0), own.pixel(255)), ([0x10, 0x20, 0x30], [0xf0, 0xe0, 0xd0]));
        assert_eq!("102030,0000ff,f0e0d0".parse::<Palette>().unwrap().pixel(FARTHEST), [0, 0, 255]);
        for wrong in ["", "sepia", "102030", "10203,f0e0d0", "10203g,f0e0d0", "+10203,f0e0d0", "0,0,0,0"] {
            let error = wrong.parse::<Palette>().unwrap_err().to_string();
            assert!(error.contains("blueprint") && error.contains("RRGGBB"), "{wrong}: {error}");
        }
    }

    #[test]
    fn mono_leaves_the_ground_out() {
        let mono: Palette = "mono".parse().unwrap();
        assert_eq!([0, 56, 64, 255].map(|shade| mono.pixel(shade)[0]), [0, 0, 255, 255]);
    }
}
