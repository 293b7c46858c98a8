//! The last step of a conversion under a bound for each channel: the bytes, played by the device's own decoder, against the motion.

use crate::expand::expand_made;
use crate::fit::bounds::{Bounds, unit};
use crate::fit::chain::Constraint;
use crate::fit::refusal::amount;
use crate::motion::Motion;
use anyhow::{Result, ensure};
use pantin::Clip;

/// A channel's greatest error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worst {
    /// In the motion's units, of accelerations in those a frame^2.
    pub error: f64,
    /// The same as a part of the channel's bound.
    pub part: f64,
    /// Index of the channel.
    pub channel: usize,
    /// When it is.
    pub frame: usize,
}

/// What the played clip differs in from its motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// The worst of what the bounds are for, against its bound.
    pub worst: Worst,
    /// The greatest error of a position, rotation or scalar as a part of the same number: how far a channel drifts under a
    /// bound for accelerations.
    pub drift: Worst,
}

/// Compares two motions of the same figure, channel by channel; rotations by whole turns alike are the same.
pub fn compare(original: &Motion, other: &Motion, bounds: &Bounds) -> Result<Report> {
    ensure!(original.frames == other.frames, "{} frames became {}", original.frames, other.frames);
    let mut report = Report::default();
    for (channel, (_, kind)) in original.rig.channel_kinds().into_iter().enumerate() {
        let wrap = |off: f64| if kind.is_rotation() { off - 360.0 * (off / 360.0).round() } else { off };
        let off = |frame: usize| wrap(other.values[channel][frame] - original.values[channel][frame]);
        let bend = |frame: usize| wrap(off(frame) + off(frame - 2) - 2.0 * off(frame - 1));
        for frame in 0..original.frames {
            report.drift.take(off(frame), bounds.greatest[channel], channel, frame);
            // The first two frames have no second difference: there the value counts.
            let held = if bounds.constraint == Constraint::Positions || frame < 2 { off(frame) } else { bend(frame) };
            report.worst.take(held, bounds.greatest[channel], channel, frame);
        }
    }
    Ok(report)
}

impl Worst {
    fn take(&mut self, error: f64, bound: f64, channel: usize, frame: usize) {
        let part = if error == 0.0 { 0.0 } else { error.abs() / bound };
        if part > self.part {
            *self = Worst { error: error.abs(), part, channel, frame };
        }
    }

    /// `0.0042 degrees (hip.Xrotation at frame 7)`.
    pub fn sentence(&self, motion: &Motion) -> String {
        if motion.rig.channels() == 0 {
            return "0 (no channels)".into();
        }
        let unit = unit(motion.rig.channel_kinds()[self.channel].1);
        format!("{:.5}{unit} ({} at frame {})", self.error, motion.rig.channel_name(self.channel), self.frame)
    }
}

/// Opens `bytes` (with `rig` if they hold none), plays them, and refuses them if a bound is broken.
pub fn verify(bytes: &[u8], rig: &[u8], motion: &Motion, bounds: &Bounds) -> Result<Report> {
    let played = expand_made(&Clip::with_rig(bytes, rig)?)?;
    let report = compare(motion, &played, bounds)?;
    if motion.rig.channels() == 0 {
        return Ok(report);
    }
    let Worst { error, part, channel, frame } = report.worst;
    let unit = unit(motion.rig.channel_kinds()[channel].1);
    let bound = bounds.greatest[channel];
    let (name, error, bound) = (motion.rig.channel_name(channel), amount(error, bound), amount(bound, bound));
    ensure!(part <= 1.0, "channel {name} at frame {frame} is {error}{unit} off; the bound is {bound}{unit}");
    Ok(report)
}
