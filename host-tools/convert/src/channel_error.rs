//! The last step of a conversion under a bound for each channel: the bytes, played by the device's own decoder, against the motion.

use crate::expand::expand_made;
use crate::fit::bounds::{Bounds, unit};
use crate::fit::chain::Constraint;
use crate::fit::refusal::amount;
use crate::motion::Motion;
use crate::note::first_of;
use anyhow::{Result, ensure};
use pantin::Clip;

/// A channel's greatest error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worst {
    /// In degrees, in the motion's units of length, or in the scalar's units; of accelerations in those a frame^2.
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
    /// The greatest error of each channel that has one, of its value at a frame: how far it drifts under a bound of accelerations. The worst
    /// first, as parts of the channels' bounds.
    pub drift: Vec<Worst>,
}

/// Compares two motions of the same figure, channel by channel; rotations by whole turns alike are the same.
pub fn compare(original: &Motion, other: &Motion, bounds: &Bounds) -> Result<Report> {
    ensure!(original.frames == other.frames, "{} frames became {}", original.frames, other.frames);
    let mut report = Report::default();
    let mut drift = vec![Worst::default(); original.rig.channels()];
    for (channel, (_, kind)) in original.rig.channel_kinds().into_iter().enumerate() {
        let wrap = |off: f64| if kind.is_rotation() { off - 360.0 * (off / 360.0).round() } else { off };
        let off = |frame: usize| wrap(other.values[channel][frame] - original.values[channel][frame]);
        let bend = |frame: usize| wrap(off(frame) + off(frame - 2) - 2.0 * off(frame - 1));
        for frame in 0..original.frames {
            drift[channel].take(off(frame), bounds.greatest[channel], channel, frame);
            // The first two frames have no second difference: there the value counts.
            let held = if bounds.constraint == Constraint::Positions || frame < 2 { off(frame) } else { bend(frame) };
            report.worst.take(held, bounds.greatest[channel], channel, frame);
        }
    }
    drift.retain(|worst| worst.part > 0.0);
    drift.sort_by(|one, other| other.part.total_cmp(&one.part).then(one.channel.cmp(&other.channel)));
    Ok(Report { drift, ..report })
}

/// Channels that the sentence of a drift names.
const NAMED: usize = 6;

impl Report {
    /// `1.4178 cm (hips.Xposition at frame 159), 0.98 degrees (chest.Yrotation at frame 50)`: the worst channel of each unit, as a part of its bound, the
    /// worst of all first.
    pub(crate) fn by_unit(&self, motion: &Motion) -> String {
        let mut units = vec![];
        let mut is_new = |worst: &&Worst| {
            let unit = worst.in_unit(motion).1;
            let is_new = !units.contains(&unit);
            units.push(unit);
            is_new
        };
        let named: Vec<String> = self.drift.iter().filter(|worst| is_new(worst)).map(|worst| worst.sentence(motion)).collect();
        if named.is_empty() { self.worst.sentence(motion) } else { named.join(", ") }
    }

    /// `hips.Xposition 6.566 cm at frame 159, chest.Yrotation 3.125 degrees at frame 50 and 12 more`: the worst channels.
    pub fn drift_sentence(&self, motion: &Motion) -> String {
        let named: Vec<String> = self.drift.iter().map(|worst| worst.of_channel(motion)).collect();
        if named.is_empty() { "none".into() } else { first_of(&named, NAMED) }
    }
}

impl Worst {
    /// The error in the unit that people know, and the unit: cm of positions, degrees of rotations; none of scalars and of a quaternion's components.
    pub fn in_unit(&self, motion: &Motion) -> (f64, &'static str) {
        let kind = motion.rig.channel_kinds()[self.channel].1;
        if kind.is_position() { (self.error * motion.rig.cm_per_unit, "cm") } else { (self.error, unit(kind).trim_start()) }
    }

    fn of_channel(&self, motion: &Motion) -> String {
        let (error, unit) = self.in_unit(motion);
        let space = if unit.is_empty() { "" } else { " " };
        format!("{} {error:.3}{space}{unit} at frame {}", motion.rig.channel_name(self.channel), self.frame)
    }

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
        let (error, unit) = self.in_unit(motion);
        let space = if unit.is_empty() { "" } else { " " };
        format!("{error:.5}{space}{unit} ({} at frame {})", motion.rig.channel_name(self.channel), self.frame)
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
