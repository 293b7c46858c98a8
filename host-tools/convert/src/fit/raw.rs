//! Raw values of a pose against values of a motion.

use crate::encode::rig::{length_exponent, rest_offset, scalar_exponent};
use crate::motion::{Kind, Rig};

/// What one raw unit of each channel is worth in the motion's units; `length_exponent` is the clip's.
pub fn scales(rig: &Rig, length_exponent: i8) -> Vec<f64> {
    let joint_channels = rig.joint_channels();
    let kinds = rig.channel_kinds();
    let of = |(channel, &(_, kind)): (usize, &(Option<usize>, Kind))| {
        if kind.is_position() {
            f64::from(length_exponent).exp2()
        } else if kind.is_quaternion() {
            (-30f64).exp2()
        } else if kind == Kind::Scalar {
            f64::from(scalar_exponent(rig.scalars[channel - joint_channels].full_scale) - 31).exp2()
        } else {
            360.0 / 32f64.exp2()
        }
    };
    kinds.iter().enumerate().map(of).collect()
}

/// A channel's values in raw units. Euler angles begin within half a turn of 0: whole turns are all one to the decoder.
pub fn target(values: &[f64], kind: Kind, scale: f64) -> Vec<f64> {
    let range = 32f64.exp2();
    let first = values.first().map_or(0.0, |first| first / scale);
    let turns = if kind.is_rotation() { (first / range).round() * range } else { 0.0 };
    values.iter().map(|x| x / scale - turns).collect()
}

/// The exponent that gives a clip's positions the finest step with all of them inside half of the range.
pub fn clip_length_exponent(rig: &Rig, values: &[Vec<f64>]) -> i8 {
    let kinds = rig.channel_kinds();
    let moving = kinds.iter().zip(values).filter(|((_, kind), _)| kind.is_position());
    let farthest = moving.flat_map(|(_, values)| values).fold(0f64, |farthest, x| farthest.max(x.abs()));
    let rests = (0..rig.joints.len()).flat_map(|joint| rest_offset(rig, joint)).fold(0f64, |farthest, x| farthest.max(x.abs()));
    let farthest = farthest.max(rests);
    if farthest == 0.0 { 0 } else { (farthest.log2().floor() as i32 + 1 - 30).clamp(-63, 31) as i8 }
}

/// The raw value of each channel where the rig has it at rest.
pub fn rests(rig: &Rig, clip_exponent: i8) -> Vec<i32> {
    let shift = i32::from(length_exponent(rig)) - i32::from(clip_exponent);
    let step = f64::from(length_exponent(rig)).exp2();
    let kinds = rig.channel_kinds();
    let of = |&(joint, kind): &(Option<usize>, Kind)| match (joint, kind.axis()) {
        (Some(joint), Some(axis)) if kind.is_position() => {
            let rest = (rest_offset(rig, joint)[axis] / step).round() as i32;
            if shift >= 0 { rest.wrapping_shl(shift as u32) } else { rest >> (-shift).min(31) }
        }
        _ => 0,
    };
    kinds.iter().map(of).collect()
}
