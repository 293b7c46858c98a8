//! Values of the command's options, as words.

use anyhow::{Context, Result, bail, ensure};
use pantin_figure::View;
use std::str::FromStr;

/// Most columns or rows of one picture.
const MOST: usize = 4096;

/// Columns and rows: `240x240`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [usize; 2]);

impl FromStr for Size {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Size> {
        let parts = text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
        let size: [usize; 2] = parts.context("expected columns and rows, as in 240x240")?;
        ensure!(size.iter().all(|side| (8..=MOST).contains(side)), "each side must be 8 to {MOST}");
        Ok(Size(size))
    }
}

/// A side from which the figure is seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Side {
    /// As it was given.
    pub name: String,
    /// Degrees about the figure.
    pub orbit: i16,
}

impl FromStr for Side {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Side> {
        let orbit = match text {
            "front" => 0,
            "side" | "right" => -90,
            "left" => 90,
            "back" => 180,
            "quarter" => View::default().orbit,
            degrees => degrees.parse().ok().filter(|degrees: &i16| degrees.abs() <= 360).context(
                "expected front, side, left, right, back, quarter, or degrees from -360 to 360, several with commas between",
            )?,
        };
        Ok(Side { name: text.to_string(), orbit })
    }
}

/// A time in the clip: a frame's number, or seconds as in `1.5s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// Counted from 0.
    Frame(u32),
    /// From the clip's begin.
    Seconds(f64),
}

impl FromStr for Moment {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Moment> {
        let expected = "expected a frame's number, or seconds as in 1.5s";
        match text.strip_suffix('s') {
            None => Ok(Moment::Frame(text.parse().context(expected)?)),
            Some(number) => match number.parse() {
                Ok(seconds) if (0.0..1e9).contains(&seconds) => Ok(Moment::Seconds(seconds)),
                _ => bail!(expected),
            },
        }
    }
}

impl Moment {
    /// The nearest frame, whether a motion has it or not.
    pub fn nearest(self, frame_time: f64) -> usize {
        match self {
            Moment::Frame(frame) => frame as usize,
            Moment::Seconds(seconds) => (seconds / frame_time).round() as usize,
        }
    }

    /// Returns the frame of a clip with `frames` frames.
    pub fn frame(self, frames: u32, frame_time: f64) -> Result<u32> {
        let frame = match self {
            Moment::Frame(frame) => frame,
            Moment::Seconds(seconds) => (seconds / frame_time).round().min(f64::from(u32::MAX)) as u32,
        };
        let (last, seconds) = (frames - 1, f64::from(frames - 1) * frame_time);
        ensure!(frame < frames, "frame {frame} is not in the clip: it has frames 0 to {last} (0 s to {seconds:.2}s)");
        Ok(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_sides_and_moments_are_read_or_refused() {
        assert_eq!("240x135".parse::<Size>().unwrap(), Size([240, 135]));
        for wrong in ["240", "240x", "x", "7x64", "5000x10", "-8x8", "8x8x8"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
        assert_eq!(["front", "quarter", "-30"].map(|side| side.parse::<Side>().unwrap().orbit), [0, -50, -30]);
        assert!("above".parse::<Side>().is_err() && "361".parse::<Side>().is_err());
        assert_eq!("12".parse::<Moment>().unwrap(), Moment::Frame(12));
        assert!(["-1", "1.5", "s", "-2s", "NaNs", "infs"].iter().all(|wrong| wrong.parse::<Moment>().is_err()));
    }

    #[test]
    fn a_moment_outside_of_the_clip_is_refused() {
        assert_eq!(Moment::Seconds(0.5).frame(31, 1.0 / 60.0).unwrap(), 30);
        let error = Moment::Seconds(0.6).frame(31, 1.0 / 60.0).unwrap_err().to_string();
        assert!(error.contains("frame 36") && error.contains("0 to 30"), "{error}");
    }
}
