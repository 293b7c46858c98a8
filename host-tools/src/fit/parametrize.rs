//! Euler angles or exponential map, joint by joint, by what they cost (docs/METHOD.md 5).

use super::figure::exponential_near;
use crate::fk::local;
use crate::motion::{Joint, Kind, Motion};

/// How joints with three Euler angles about three axes are coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Rotations {
    /// Choose for each joint what seems smaller
    ByCost,
    /// Use the file's Euler angles
    Euler,
    /// Use exponential maps where they stay within half a turn
    Exponential,
}

/// Exponential maps are chosen where they seem this much cheaper.
const WORTHWHILE: f64 = 0.9;
/// Their components stay inside half a turn, which an angle holds without wrapping.
const LARGEST_DEGREES: f64 = 179.0;

/// The motion with some joints' Euler angles replaced by exponential maps, and which of those that may choose were.
pub fn parametrize(motion: &Motion, bound_cm: f64, rotations: Rotations) -> (Motion, Vec<bool>) {
    let mut out = motion.clone();
    let reach = reach_cm(motion);
    let first = motion.rig.first_channels();
    let mut chosen = Vec::new();
    for (index, joint) in motion.rig.joints.iter().enumerate() {
        if joint.kinds.iter().filter(|kind| kind.is_rotation()).count() != 3 {
            continue;
        }
        let slots: Vec<usize> =
            (0..joint.kinds.len()).filter(|&i| joint.kinds[i].is_rotation()).map(|i| first[index] + i).collect();
        let exponential = exponentials(joint, motion, first[index]);
        let scale = 1f64.to_radians() * reach[index] / (0.5 * bound_cm);
        let stride = ((5.0 / 30.0 / motion.frame_time).round() as usize).max(1);
        let euler: f64 = slots.iter().map(|&slot| roughness(&motion.values[slot], stride, scale)).sum();
        let other: f64 = exponential.iter().map(|values| roughness(values, stride, scale)).sum();
        let fits = exponential.iter().flatten().all(|x| x.abs() < LARGEST_DEGREES);
        let axes = joint.kinds.iter().filter(|kind| kind.is_rotation()).filter_map(|kind| kind.axis());
        let distinct = axes.fold(0, |seen, axis| seen | 1 << axis) == 7;
        let wanted = match rotations {
            Rotations::ByCost => other < WORTHWHILE * euler,
            Rotations::Euler => false,
            Rotations::Exponential => true,
        };
        let better = distinct && fits && wanted;
        chosen.push(better);
        if better {
            for ((slot, values), kind) in
                slots.iter().zip(exponential).zip([Kind::Xexponential, Kind::Yexponential, Kind::Zexponential])
            {
                out.values[*slot] = values;
                out.rig.joints[index].kinds[slot - first[index]] = kind;
            }
        }
    }
    (out, chosen)
}

/// The joint's rotation at every frame as an exponential map in degrees.
fn exponentials(joint: &Joint, motion: &Motion, first: usize) -> [Vec<f64>; 3] {
    let mut before = [0.0; 3];
    let mut out: [Vec<f64>; 3] = Default::default();
    for frame in 0..motion.frames {
        let (turn, _) = local(joint, |channel| motion.values[first + channel][frame]);
        before = exponential_near(&turn, before);
        (0..3).for_each(|axis| out[axis].push(before[axis]));
    }
    out
}

/// Length of the longest chain below each joint: what its rotations can move.
fn reach_cm(motion: &Motion) -> Vec<f64> {
    let joints = &motion.rig.joints;
    let mut reach = vec![0f64; joints.len()];
    for (index, joint) in joints.iter().enumerate().rev() {
        if let Some(parent) = joint.parent {
            let bone = joint.offset.iter().map(|x| x * x).sum::<f64>().sqrt() * motion.rig.cm_per_unit;
            reach[parent] = reach[parent].max(reach[index] + bone);
        }
    }
    reach
}

/// About how many bits the bends of a curve take: second differences over a sixth of a second, in bounds.
fn roughness(values: &[f64], stride: usize, scale: f64) -> f64 {
    let bends = values.windows(2 * stride + 1).map(|w| (w[0] - 2.0 * w[stride] + w[2 * stride]) * scale);
    bends.map(|bend| (1.0 + bend * bend).log2()).sum()
}
