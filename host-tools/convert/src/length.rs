//! A distance in a figure: a length, or a part of the figure's height.

use crate::import::units::figure_height_cm;
use crate::motion::Motion;
use anyhow::{Context, Result};

/// A distance of joints: a length, or a part of the figure's height. Above 0 and at most [`Length::GREATEST`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Centimetres.
    Cm(f64),
    /// Percent of the figure's height.
    Percent(f64),
}

impl Length {
    /// A length in centimetres.
    pub fn cm(cm: f64) -> Length {
        Length::Cm(cm)
    }

    /// A part of the figure's height, in percent.
    pub fn percent(percent: f64) -> Length {
        Length::Percent(percent)
    }

    /// The greatest number of centimetres (10 km), or of percent: far from where double precision loses a figure.
    pub const GREATEST: f64 = 1e6;

    /// Whether it is above 0 and at most [`Length::GREATEST`].
    pub fn is_valid(self) -> bool {
        let (Length::Cm(number) | Length::Percent(number)) = self;
        number > 0.0 && number <= Length::GREATEST
    }

    /// The length in cm for `motion`; 1 for percent of a motion without joints, which bounds nothing.
    pub(crate) fn of(self, motion: &Motion) -> Result<f64> {
        match self {
            Length::Cm(cm) => Ok(cm),
            Length::Percent(_) if motion.rig.joints.is_empty() => Ok(1.0),
            Length::Percent(percent) => {
                let height =
                    figure_height_cm(motion).context("the figure has no height to take a part of: give the error as a length")?;
                Ok(percent / 100.0 * height)
            }
        }
    }
}

impl std::str::FromStr for Length {
    type Err = String;

    /// A number with a unit: cm, mm, m, in or %; without one, cm.
    fn from_str(text: &str) -> Result<Length, String> {
        let units = [("cm", 1.0), ("mm", 0.1), ("in", 2.54), ("m", 100.0), ("%", 0.0), ("", 1.0)];
        let (number, factor) = units
            .iter()
            .find_map(|(unit, factor)| text.strip_suffix(unit).map(|number| (number, *factor)))
            .unwrap_or((text, 1.0));
        let number = number.trim().parse::<f64>().ok();
        let length = number.map(|number| if factor == 0.0 { Length::Percent(number) } else { Length::Cm(number * factor) });
        let length = length.filter(|length| length.is_valid());
        length.ok_or_else(|| match number {
            Some(number) if number > 0.0 => "expected at most 10 km, or 1000000 % of the figure's height".into(),
            _ => "expected a length above 0, like 0.5cm, or a part of the figure's height, like 0.5%".into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_and_parts_are_told_by_their_unit() {
        let read = ["2", "2cm", "2 mm", "2in", "2m", "2%", "0.5 %"].map(|text| text.parse::<Length>().unwrap());
        use Length::*;
        assert_eq!(read, [Cm(2.0), Cm(2.0), Cm(0.2), Cm(5.08), Cm(200.0), Percent(2.0), Percent(0.5)]);
        assert!(["", "0", "-1cm", "nan%", "2 miles"].iter().all(|text| text.parse::<Length>().is_err()));
        for text in ["1e300cm", "inf", "10001m", "1000001%"] {
            assert!(text.parse::<Length>().unwrap_err().starts_with("expected at most 10 km"), "{text}");
        }
        assert_eq!("10000m".parse(), Ok(Cm(Length::GREATEST)));
    }
}
