//! The values of `--max-error`, `--mean-error` and `--shell` (a length, or a part of the figure's height) and of bounds on rotations.

use crate::import::units::figure_height_cm;
use crate::motion::Motion;
use anyhow::{Context, Result};

/// What a joint may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointError {
    /// A length.
    Cm(f64),
    /// Percent of the figure's height.
    Percent(f64),
}

/// Without an option.
pub const DEFAULT: JointError = JointError::Cm(0.5);

impl JointError {
    /// The bound for `motion`.
    pub fn cm(self, motion: &Motion) -> Result<f64> {
        match self {
            JointError::Cm(cm) => Ok(cm),
            JointError::Percent(_) if motion.rig.joints.is_empty() => Ok(1.0),
            JointError::Percent(percent) => {
                let height = figure_height_cm(motion).context("the figure has no height to take a part of: give a length")?;
                Ok(percent / 100.0 * height)
            }
        }
    }
}

/// A number with a unit; without one, cm.
pub fn parse(text: &str) -> Result<JointError, String> {
    let units = [("cm", 1.0), ("mm", 0.1), ("in", 2.54), ("m", 100.0), ("%", 0.0), ("", 1.0)];
    let (number, factor) =
        units.iter().find_map(|(unit, factor)| text.strip_suffix(unit).map(|number| (number, *factor))).unwrap_or((text, 1.0));
    match number.trim().parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() && factor == 0.0 => Ok(JointError::Percent(number)),
        Ok(number) if number > 0.0 && number.is_finite() => Ok(JointError::Cm(number * factor)),
        _ => Err("expected a length above 0, like 0.5cm, or a part of the figure's height, like 0.5%".into()),
    }
}

/// The least bound on a rotation in degrees: rounding three angles to steps of 360 / 2^32 degrees turns a joint by nearly as much.
const LEAST_DEGREES: f64 = 2e-7;

/// The greatest angle between two rotations, in degrees: above 0, not above 180.
pub fn degrees(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if (LEAST_DEGREES..=180.0).contains(&number) => Ok(number),
        Ok(number) if number > 0.0 && number < LEAST_DEGREES => {
            Err(format!("a clip's angles have steps of 8.4e-8 degrees: the least bound is {LEAST_DEGREES:e} degrees"))
        }
        _ => Err("expected degrees, above 0 and at most 180".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_and_parts_are_told_by_their_unit() {
        let read = ["2", "2cm", "2 mm", "2in", "2m", "2%", "0.5 %"].map(|text| parse(text).unwrap());
        use JointError::*;
        assert_eq!(read, [Cm(2.0), Cm(2.0), Cm(0.2), Cm(5.08), Cm(200.0), Percent(2.0), Percent(0.5)]);
        assert!(["", "0", "-1cm", "nan%", "2 miles"].iter().all(|text| parse(text).is_err()));
    }

    #[test]
    fn degrees_are_above_what_an_angle_can_hold_and_up_to_half_a_turn() {
        assert_eq!(["2", "180", "1e-6"].map(|text| degrees(text).unwrap()), [2.0, 180.0, 1e-6]);
        assert!(["0", "-1", "nan", "inf", "180.1", "two"].iter().all(|text| degrees(text).unwrap_err().contains("at most 180")));
        assert!(degrees("1e-9").unwrap_err().contains("steps"));
    }
}
