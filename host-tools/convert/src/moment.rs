//! A moment of a motion, as people write it.

use anyhow::{Context, Result, bail, ensure};
use std::str::FromStr;

/// A moment of a motion: a frame's number from 0, or seconds as in `1.5s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// Counted from 0.
    Frame(u32),
    /// From the first frame.
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
    fn frames_and_seconds_are_read_or_refused() {
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
