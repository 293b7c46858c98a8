//! Bounds on the error of each channel, for coding channel by channel: the paper's delta and epsilon (METHOD 2.3).

use super::chain::Constraint;
use super::raw;
use crate::import::units::figure_height_cm;
use crate::motion::{Kind, Motion};
use anyhow::{Result, ensure};

/// Largest error of a rotation that is coded exactly, in degrees: rounding to 16 bits a turn is off by half of it.
pub const EXACT_DEGREES: f64 = 0.006;
/// The same for other channels, as a part of their [`range`], or of the figure's height if that is more: places.
pub const EXACT_PART: f64 = 1.0 / 65536.0;

/// The bounds of all channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// What is bounded.
    pub constraint: Constraint,
    /// Whether curves are known and tubes around them narrow.
    pub exact: bool,
    /// The greatest error of each channel in the motion's units, of accelerations in those a frame^2.
    pub greatest: Vec<f64>,
    /// What was asked for: less where a position's step is coarser.
    pub asked: Vec<f64>,
}

impl Bounds {
    /// `error` degrees for rotations and exponential maps, `error` percent of the [`range`] for all others, but no less than the
    /// clip's own step there (2^-30 of the farthest position).
    pub fn of(motion: &Motion, constraint: Constraint, error: f64) -> Bounds {
        Bounds::at_least(motion, constraint, false, error, error / 100.0)
    }

    /// Of a motion whose curves are known, rounding alone: every channel that moves has keys.
    pub fn exact(motion: &Motion) -> Result<Bounds> {
        for (channel, (values, keys)) in motion.values.iter().zip(&motion.keys).enumerate() {
            let still = values.iter().all(|value| *value == values[0]);
            ensure!(
                still || keys.is_some(),
                "channel {} moves and has no keys; exact coding needs a source with keys for every moving channel (.keys, or glTF whose rotations are CUBICSPLINE or STEP)",
                motion.rig.channel_name(channel)
            );
        }
        let mut bounds = Bounds::at_least(motion, Constraint::Positions, true, EXACT_DEGREES, EXACT_PART);
        let height = figure_height_cm(motion).map_or(0.0, |cm| cm / motion.rig.cm_per_unit);
        let kinds = motion.rig.channel_kinds();
        for channel in (0..kinds.len()).filter(|&channel| kinds[channel].1.is_position()) {
            bounds.asked[channel] = bounds.asked[channel].max(EXACT_PART * height);
            bounds.greatest[channel] = bounds.greatest[channel].max(bounds.asked[channel]);
        }
        Ok(bounds)
    }

    fn at_least(motion: &Motion, constraint: Constraint, exact: bool, degrees: f64, part: f64) -> Bounds {
        let asked = asked(motion, degrees, part);
        let mut bounds = Bounds { constraint, exact, greatest: asked.clone(), asked };
        bounds.at_least_steps(motion, raw::clip_length_exponent(&motion.rig, &motion.values));
        bounds
    }

    /// A moving channel of positions whose bound is a step instead of the less that was asked for, and that bound.
    pub fn raised(&self, motion: &Motion) -> Option<(usize, f64)> {
        let raised = |&channel: &usize| self.greatest[channel] > self.asked[channel] && range(motion, channel) > 0.0;
        let channel = (0..self.asked.len()).find(raised)?;
        Some((channel, self.asked[channel]))
    }

    /// Raises bounds of positions below the step of a clip with this length exponent to that step.
    pub fn at_least_steps(&mut self, motion: &Motion, length_exponent: i8) {
        let steps = raw::scales(&motion.rig, length_exponent);
        for ((greatest, (_, kind)), step) in self.greatest.iter_mut().zip(motion.rig.channel_kinds()).zip(steps) {
            if kind.is_position() {
                *greatest = greatest.max(step);
            }
        }
    }
}

fn asked(motion: &Motion, degrees: f64, part: f64) -> Vec<f64> {
    let of = |(channel, (_, kind)): (usize, (Option<usize>, Kind))| {
        if kind.is_rotation() || kind.is_exponential() { degrees } else { part * range(motion, channel) }
    };
    motion.rig.channel_kinds().into_iter().enumerate().map(of).collect()
}

/// What a percentage of a channel is of: a position's way from its least to its greatest value, a scalar's full scale, 2 for
/// quaternion components (-1 to 1).
pub fn range(motion: &Motion, channel: usize) -> f64 {
    let (_, kind) = motion.rig.channel_kinds()[channel];
    if kind.is_quaternion() {
        return 2.0;
    }
    if let Some(scalar) = channel.checked_sub(motion.rig.joint_channels()) {
        return motion.rig.scalars[scalar].full_scale;
    }
    let values = &motion.values[channel];
    let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(least, most), x| (least.min(*x), most.max(*x)));
    most - least
}

/// The unit of a channel's errors, as a word behind a number.
pub fn unit(kind: Kind) -> &'static str {
    if kind.is_rotation() || kind.is_exponential() {
        " degrees"
    } else if kind.is_position() {
        " units"
    } else {
        ""
    }
}
