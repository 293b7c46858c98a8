//! The colours that a terminal has.

use crossterm::style::Color;
use pantin_images::palette::Rgb;

/// How many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Colours {
    /// 24-bit colours.
    All,
    /// The 256 colours that most terminals have.
    #[value(name = "256")]
    Cube,
    /// The terminal's default colours only.
    None,
}

/// Steps of red, green and blue among the 256 colours.
const STEPS: [u8; 6] = [0, 95, 135, 175, 215, 255];
/// The first of them, and the first of 24 greys.
const CUBE: u8 = 16;
const GREYS: u8 = 232;

impl Colours {
    /// What the environment says: NO_COLOR (any text), COLORTERM, TERM, or that this is Windows Terminal.
    pub fn of_environment(variable: impl Fn(&str) -> Option<String>) -> Colours {
        let has = |name: &str, words: &[&str]| variable(name).is_some_and(|value| words.iter().any(|word| value.contains(word)));
        if variable("NO_COLOR").is_some_and(|value| !value.is_empty()) {
            Colours::None
        } else if has("COLORTERM", &["truecolor", "24bit"]) || has("TERM", &["direct"]) || has("WT_SESSION", &[""]) {
            Colours::All
        } else if has("TERM", &["256"]) {
            Colours::Cube
        } else {
            Colours::None
        }
    }

    /// The terminal's colour for one of ours.
    pub fn of(self, rgb: Rgb) -> Option<Color> {
        match self {
            Colours::All => Some(Color::Rgb { r: rgb[0], g: rgb[1], b: rgb[2] }),
            Colours::Cube => Some(Color::AnsiValue(nearest(rgb))),
            Colours::None => None,
        }
    }
}

fn apart(a: Rgb, b: Rgb) -> u32 {
    (0..3).map(|i| u32::from(a[i].abs_diff(b[i])).pow(2)).sum()
}

/// The nearest of the 240 colours that are the same on all terminals.
fn nearest(rgb: Rgb) -> u8 {
    let steps = rgb.map(|x| (0..6).min_by_key(|&step| STEPS[step].abs_diff(x)).unwrap_or(0));
    let cube = (CUBE + (steps[0] * 36 + steps[1] * 6 + steps[2]) as u8, steps.map(|step| STEPS[step]));
    let mean = rgb.iter().map(|&x| u32::from(x)).sum::<u32>() / 3;
    // Greys are 8, 18, 28 ... 238.
    let grey = (mean.saturating_sub(3) / 10).min(23) as u8;
    let grey = (GREYS + grey, [8 + 10 * grey; 3]);
    if apart(grey.1, rgb) < apart(cube.1, rgb) { grey.0 } else { cube.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_environment_says_how_many_colours_there_are() {
        let of = |variables: &[(&str, &str)]| {
            Colours::of_environment(|name| variables.iter().find(|(key, _)| *key == name).map(|(_, value)| value.to_string()))
        };
        assert_eq!(of(&[("TERM", "xterm-256color"), ("COLORTERM", "truecolor")]), Colours::All);
        assert_eq!(of(&[("TERM", "tmux-256color")]), Colours::Cube);
        assert_eq!(of(&[("TERM", "vt100")]), Colours::None);
        assert_eq!(of(&[]), Colours::None);
        assert_eq!(of(&[("TERM", "xterm-256color"), ("COLORTERM", "24bit"), ("NO_COLOR", "1")]), Colours::None);
        assert_eq!(of(&[("TERM", "xterm-256color"), ("NO_COLOR", "")]), Colours::Cube);
    }

    #[test]
    fn the_256_colours_are_the_nearest_ones() {
        assert_eq!([[0; 3], [255; 3], [255, 0, 0], [95, 135, 175]].map(nearest), [16, 231, 196, 67]);
        assert_eq!([[8; 3], [238; 3], [120, 121, 119]].map(nearest), [232, 255, 243]);
    }
}
