//! `--max-error` and `--mean-error`: a length, or a part of the figure's height.

use anyhow::{Context, Result};
use pantin_convert::import::units::figure_height_cm;
use pantin_convert::motion::Motion;

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
                let height =
                    figure_height_cm(motion).context("the figure has no height to take a part of: give the error as a length")?;
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
}
