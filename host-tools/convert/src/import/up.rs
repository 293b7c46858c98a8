//! Which direction of the world is up, for sources that do not say.

use crate::fk::positions;
use crate::motion::{Motion, Up};

/// Poses that are looked at, at most.
const POSES: usize = 64;

/// Up as its axis' letter, with a minus sign if it is the negative direction.
pub fn text(up: Up) -> &'static str {
    let names = if up.is_negative() { ["-x", "-y", "-z"] } else { ["x", "y", "z"] };
    names[up.axis()]
}

/// The inverse of [`text`].
pub fn parse(text: &str) -> Option<Up> {
    let (negative, axis) = text.strip_prefix('-').map_or((false, text), |axis| (true, axis));
    Up::new(["x", "y", "z"].iter().position(|name| name.eq_ignore_ascii_case(axis))?, negative)
}

/// The axis along which the head is farthest from the feet, in the sum over some poses. A figure whose names tell neither head nor feet is taken to be as
/// tall as it is along y, or along z if that is more.
pub fn guess(motion: &Motion) -> Up {
    let joints = &motion.rig.joints;
    let lower: Vec<String> = joints.iter().map(|joint| joint.name.to_ascii_lowercase()).collect();
    let head = lower.iter().position(|name| name.contains("head"));
    let feet: Vec<usize> =
        (0..joints.len()).filter(|&joint| lower[joint].contains("foot") || lower[joint].contains("ankle")).collect();
    let step = motion.frames.div_ceil(POSES).max(1);
    let mut sum = [0.0; 3];
    for frame in (0..motion.frames).step_by(step) {
        let pose = positions(&motion.rig, &motion.values, frame);
        match head {
            Some(head) if !feet.is_empty() => {
                for (axis, sum) in sum.iter_mut().enumerate() {
                    let low = feet.iter().map(|&foot| pose[foot][axis]).sum::<f64>() / feet.len() as f64;
                    *sum += pose[head][axis] - low;
                }
            }
            // The root of a rig may stand on the floor below the figure.
            _ => {
                for axis in [1, 2] {
                    let along = pose.iter().skip(1).map(|place| place[axis]);
                    let (low, high) = along.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
                    sum[axis] += (high - low).max(0.0);
                }
            }
        }
    }
    let mut axis = if sum[2].abs() > sum[1].abs() { 2 } else { 1 };
    if sum[0].abs() > sum[axis].abs() {
        axis = 0;
    }
    Up::new(axis, sum[axis] < 0.0).unwrap_or_default()
}
