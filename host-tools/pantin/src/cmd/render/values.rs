//! Values of the command's options, as words.

use anyhow::{Context, Result, ensure};
pub use pantin_convert::Moment;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_sides_are_read_or_refused() {
        assert_eq!("240x135".parse::<Size>().unwrap(), Size([240, 135]));
        for wrong in ["240", "240x", "x", "7x64", "5000x10", "-8x8", "8x8x8"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
        assert_eq!(["front", "quarter", "-30"].map(|side| side.parse::<Side>().unwrap().orbit), [0, -50, -30]);
        assert!("above".parse::<Side>().is_err() && "361".parse::<Side>().is_err());
    }
}
