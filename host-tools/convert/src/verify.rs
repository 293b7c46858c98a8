//! The last step of every conversion: the bytes, played by the device's own decoder, against the motion.

use crate::expand::expand_made;
use crate::fk;
use crate::import::units::figure_height_cm;
use crate::motion::Motion;
use crate::pose_bound::{PoseBound, angle_deg, bounded, default_shell_cm, shell_distance_cm};
use anyhow::{Result, ensure};
use pantin::Clip;

/// The greatest error of one kind over all frames and joints, and where it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worst {
    /// The error, 0 or more.
    pub error: f64,
    /// The joint that has it: an End Site by its parent's name. Empty if nothing is off.
    pub joint: String,
    /// The frame, from 0.
    pub frame: usize,
}

/// How far a clip is from its motion over all frames and joints. Helper bones, and what hangs on them, are left out.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Greatest distance of a place, End Sites included, in cm.
    pub place_cm: Worst,
    /// Mean distance of places, End Sites included, in cm.
    pub mean_cm: f64,
    /// Mean distance of the joints' places, End Sites left out, in cm.
    pub mean_joint_cm: f64,
    /// The figure's height in cm in the original, in percent of which errors are shown; `None` where it has none.
    pub figure_height_cm: Option<f64>,
    /// The distance in cm of the shell's points from their joint.
    pub shell_radius_cm: f64,
    /// Greatest shell error in cm: of a joint's place and the three points along its axes, or of an End Site's place.
    pub shell_cm: Worst,
    /// Mean shell error of the joints, End Sites left out, in cm.
    pub mean_shell_cm: f64,
    /// Greatest angle in degrees between a joint's rotations in the world.
    pub rotation_deg: Worst,
    /// Greatest angle in degrees between a joint's rotations in its parent.
    pub joint_deg: Worst,
    /// Greatest error of a scalar, as a part of its full scale.
    pub max_scalar: f64,
    /// The scalar that has it.
    pub worst_scalar: String,
    /// When it has it.
    pub worst_scalar_frame: usize,
}

/// The greatest of errors so far: the error, the joint's index and the frame.
#[derive(Clone, Copy, Default)]
struct Greatest(f64, usize, usize);

impl Greatest {
    fn put(&mut self, error: f64, joint: usize, frame: usize) {
        // Not a number is greater than any bound.
        if error > self.0 || error.is_nan() {
            *self = Greatest(if error.is_nan() { f64::INFINITY } else { error }, joint, frame);
        }
    }

    fn named(self, motion: &Motion) -> Worst {
        let Greatest(error, joint, frame) = self;
        let joint = if error > 0.0 { motion.rig.joint_name(joint) } else { String::new() };
        Worst { error, joint, frame }
    }
}

/// The shell's radius in cm by which a motion's errors are measured if its bound names none.
pub fn shell_radius_cm(motion: &Motion) -> f64 {
    default_shell_cm(figure_height_cm(motion))
}

/// Compares two motions of the same figure; the shell's points are `shell_cm` from their joints.
pub fn compare(original: &Motion, other: &Motion, shell_cm: f64) -> Result<Report> {
    ensure!(original.frames == other.frames, "{} frames became {}", original.frames, other.frames);
    let mut report = compare_joints(original, other, shell_cm);
    for (index, scalar) in original.rig.scalars.iter().enumerate() {
        let channel = original.rig.joint_channels() + index;
        for (frame, (a, b)) in original.values[channel].iter().zip(&other.values[channel]).enumerate() {
            let part = (a - b).abs() / scalar.full_scale;
            if part > report.max_scalar {
                (report.max_scalar, report.worst_scalar_frame) = (part, frame);
                report.worst_scalar.clone_from(&scalar.name);
            }
        }
    }
    Ok(report)
}

fn compare_joints(original: &Motion, other: &Motion, shell_cm: f64) -> Report {
    let joints = &original.rig.joints;
    let bounded = bounded(&original.rig);
    let [mut place, mut shell, mut rotation, mut in_parent] = [Greatest::default(); 4];
    let [mut sum, mut sum_of_joints, mut sum_of_shells] = [0.0; 3];
    for frame in 0..original.frames {
        let a = fk::frame_pose(&original.rig, &original.values, frame);
        let b = fk::frame_pose(&other.rig, &other.values, frame);
        for joint in (0..joints.len()).filter(|&joint| bounded[joint]) {
            let (p, q) = (&a.worlds[joint], &b.worlds[joint]);
            let distance = fk::distance(p.1, q.1);
            place.put(distance, joint, frame);
            sum += distance;
            if joints[joint].end_site {
                shell.put(distance, joint, frame);
                continue;
            }
            let around = shell_distance_cm(p, q, shell_cm);
            shell.put(around, joint, frame);
            rotation.put(angle_deg(&p.0, &q.0), joint, frame);
            in_parent.put(angle_deg(&a.turns[joint], &b.turns[joint]), joint, frame);
            sum_of_joints += distance;
            sum_of_shells += around;
        }
    }
    let all = bounded.iter().filter(|bounded| **bounded).count();
    let turning = joints.iter().zip(&bounded).filter(|(joint, bounded)| **bounded && !joint.end_site).count();
    let mean = |sum: f64, joints: usize| sum / (joints * original.frames).max(1) as f64;
    Report {
        place_cm: place.named(original),
        mean_cm: mean(sum, all),
        mean_joint_cm: mean(sum_of_joints, turning),
        figure_height_cm: figure_height_cm(original),
        shell_radius_cm: shell_cm,
        shell_cm: shell.named(original),
        mean_shell_cm: mean(sum_of_shells, turning),
        rotation_deg: rotation.named(original),
        joint_deg: in_parent.named(original),
        ..Report::default()
    }
}

/// Opens `bytes` (with `rig` if they hold none), plays them, and refuses them if a bound is broken.
pub fn verify(bytes: &[u8], rig: &[u8], motion: &Motion, bound: &PoseBound, scalar_part: f64) -> Result<Report> {
    let clip = Clip::with_rig(bytes, rig)?;
    let shell_cm = bound.shell_cm().unwrap_or_else(|| shell_radius_cm(motion));
    let report = compare(motion, &expand_made(&clip)?, shell_cm)?;
    report.check(bound)?;
    ensure!(
        report.max_scalar <= scalar_part,
        "channel {} at frame {} is off by {:.3} % of its full scale; the bound is {:.3} %",
        report.worst_scalar,
        report.worst_scalar_frame,
        100.0 * report.max_scalar,
        100.0 * scalar_part
    );
    Ok(report)
}

impl Report {
    /// Whether distances are bounded in the shell, the greatest of those that are bounded.
    pub fn bounded_cm(&self, bound: &PoseBound) -> &Worst {
        if bound.shell_cm().is_some() { &self.shell_cm } else { &self.place_cm }
    }

    /// The mean that `mean_cm` of a bound is about, in cm.
    pub fn bounded_mean_cm(&self, bound: &PoseBound) -> f64 {
        if bound.shell_cm().is_some() { self.mean_shell_cm } else { self.mean_joint_cm }
    }

    /// Fails if a joint breaks the bound on distances or on rotations. The mean is an aim, which the caller checks.
    pub fn check(&self, bound: &PoseBound) -> Result<()> {
        let Worst { error, joint, frame } = self.bounded_cm(bound);
        let what = if bound.shell_cm().is_some() { "the shell of joint" } else { "joint" };
        ensure!(*error <= bound.max_cm, "{what} {joint} at frame {frame} is {error:.4} cm off; the bound is {} cm", bound.max_cm);
        let turned = |worst: &Worst, most: Option<f64>, whose: &str| {
            let Worst { error, joint, frame } = worst;
            let most = most.unwrap_or(f64::INFINITY);
            ensure!(
                *error <= most,
                "joint {joint} at frame {frame} is turned by {error:.4} degrees {whose}; the bound is {most}"
            );
            Ok(())
        };
        turned(&self.rotation_deg, bound.max_rotation_deg, "in the world")?;
        turned(&self.joint_deg, bound.max_joint_deg, "against its parent")
    }
}
