//! The flags of `pantin convert` that bound channels instead of joints.

use anyhow::Result;
use pantin_convert::Options;
/// Bounds for each channel, in place of --max-error.
#[derive(clap::Args, Clone, Debug)]
pub struct ChannelBound {
    /// Instead of --max-error: largest error of each channel at every frame, in degrees for each Euler angle in its joint's own order, as for servos, and in
    /// percent for all others (of a position's range, of a scalar's full scale, of 2 for a quaternion's components)
    #[arg(long, value_name = "ERROR", group = "bound", value_parser = above_zero)]
    max_channel_error: Option<f64>,
    /// Instead of --max-error: largest error of each channel's acceleration (second difference) at every frame, in degrees per frame^2 for
    /// rotations and in percent per frame^2 for all others. Positions and rotations drift; the command prints by how much
    #[arg(long, value_name = "ERROR", group = "bound", value_parser = above_zero)]
    max_accel_error: Option<f64>,
    /// Instead of --max-error: code channels with keys (.keys; glTF's translations and weights, and its CUBICSPLINE rotations as quaternions) exactly except for
    /// rounding: at most 0.006 degrees, for positions 2^-16 of the figure's height, or 2^-16 of the range
    /// that --max-channel-error refers to
    #[arg(long, group = "bound")]
    exact: bool,
}

/// A finite number above 0.
pub fn above_zero(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a number above 0".into()),
    }
}

/// The greatest angle between two rotations, in degrees: above 0, not above 180.
pub fn degrees(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if (Options::LEAST_DEGREES..=180.0).contains(&number) => Ok(number),
        Ok(number) if number > 0.0 && number < Options::LEAST_DEGREES => {
            Err(format!("a clip's angles have steps of 8.4e-8 degrees: the least bound is {:e} degrees", Options::LEAST_DEGREES))
        }
        _ => Err("expected degrees, above 0 and at most 180".into()),
    }
}

impl ChannelBound {
    /// The options' names for clap.
    pub const OPTIONS: [&str; 3] = ["max_channel_error", "max_accel_error", "exact"];

    /// Whether any of them is given.
    pub fn is_given(&self) -> bool {
        self.exact || self.max_channel_error.is_some() || self.max_accel_error.is_some()
    }

    /// The bound that the flags ask for, if any.
    pub fn bound(&self) -> Option<pantin_convert::ChannelBound> {
        match (self.max_channel_error, self.max_accel_error) {
            (Some(delta), _) => Some(pantin_convert::ChannelBound::Error(delta)),
            (_, Some(epsilon)) => Some(pantin_convert::ChannelBound::Acceleration(epsilon)),
            _ => self.exact.then_some(pantin_convert::ChannelBound::Exact),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_are_above_what_an_angle_can_hold_and_up_to_half_a_turn() {
        assert_eq!(["2", "180", "1e-6"].map(|text| degrees(text).unwrap()), [2.0, 180.0, 1e-6]);
        assert!(["0", "-1", "nan", "inf", "180.1", "two"].iter().all(|text| degrees(text).unwrap_err().contains("at most 180")));
        assert!(degrees("1e-9").unwrap_err().contains("steps"));
    }
}
