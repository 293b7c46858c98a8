//! The last step of every conversion: the bytes, played by the device's own decoder, against the motion.

use crate::expand::expand_made;
use crate::fk;
use crate::motion::{Joint, Motion, Rig};
use anyhow::{Result, ensure};
use pantin::Clip;

/// How far a clip is from its motion: world-space distances in cm over all frames and joints, End Sites included.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Greatest distance.
    pub max_cm: f64,
    /// Mean distance.
    pub mean_cm: f64,
    /// Mean distance of the joints, End Sites left out.
    pub mean_joint_cm: f64,
    /// Where the greatest is.
    pub worst_joint: String,
    /// When the greatest is.
    pub worst_frame: usize,
    /// Greatest error of a scalar, as a part of its full scale.
    pub max_scalar: f64,
    /// The scalar that has it.
    pub worst_scalar: String,
    /// When it has it.
    pub worst_scalar_frame: usize,
    /// Greatest error in degrees of a rotation that moves no joint and no End Site, which a bound on places does not see.
    pub max_unseen_degrees: f64,
    /// The joint that has it.
    pub unseen_joint: String,
    /// When it has it.
    pub unseen_frame: usize,
}

/// Compares two motions of the same figure.
pub fn compare(original: &Motion, other: &Motion) -> Result<Report> {
    ensure!(original.frames == other.frames, "{} frames became {}", original.frames, other.frames);
    let mut report = Report::default();
    let (mut sum, mut sum_of_joints) = (0.0, 0.0);
    let joints = original.rig.joints.iter().filter(|joint| !joint.end_site).count();
    for frame in 0..original.frames {
        let places = fk::positions(&original.rig, &original.values, frame);
        for (joint, (p, q)) in places.iter().zip(fk::positions(&other.rig, &other.values, frame)).enumerate() {
            let distance = (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt();
            sum += distance;
            if !original.rig.joints[joint].end_site {
                sum_of_joints += distance;
            }
            if distance > report.max_cm {
                (report.max_cm, report.worst_frame) = (distance, frame);
                report.worst_joint = original.rig.joint_name(joint);
            }
        }
    }
    report.mean_joint_cm = sum_of_joints / (original.frames * joints).max(1) as f64;
    report.mean_cm = sum / (original.frames * original.rig.joints.len()).max(1) as f64;
    let first = original.rig.joint_channels();
    for (scalar, channel) in original.rig.scalars.iter().zip(first..) {
        for (frame, (a, b)) in original.values[channel].iter().zip(&other.values[channel]).enumerate() {
            let part = (a - b).abs() / scalar.full_scale;
            if part > report.max_scalar {
                (report.max_scalar, report.worst_scalar_frame) = (part, frame);
                report.worst_scalar.clone_from(&scalar.name);
            }
        }
    }
    unseen_rotations(original, other, &mut report);
    Ok(report)
}

/// Joints that turn and carry nothing that stands away from them.
pub fn unseen(rig: &Rig) -> Vec<usize> {
    let mut carries = vec![false; rig.joints.len()];
    for (index, joint) in rig.joints.iter().enumerate().rev() {
        let stands = joint.offset != [0.0; 3] || joint.kinds.iter().any(|kind| kind.is_position());
        if let Some(parent) = joint.parent {
            carries[parent] |= stands || carries[index];
        }
    }
    let turns = |joint: &Joint| joint.kinds.iter().any(|kind| !kind.is_position());
    (0..rig.joints.len()).filter(|&joint| !carries[joint] && turns(&rig.joints[joint])).collect()
}

fn unseen_rotations(original: &Motion, other: &Motion, report: &mut Report) {
    let firsts = original.rig.first_channels();
    for index in unseen(&original.rig) {
        let joint = &original.rig.joints[index];
        for frame in 0..original.frames {
            let turn = |motion: &Motion| fk::local(joint, |channel| motion.values[firsts[index] + channel][frame]).0;
            let (a, b) = (turn(original), turn(other));
            // The squared distance of two rotation matrices is 8 sin^2 of half the angle between them.
            let far: f64 = (0..9).map(|i| (a[i / 3][i % 3] - b[i / 3][i % 3]).powi(2)).sum();
            let degrees = 2.0 * (far / 8.0).sqrt().min(1.0).asin().to_degrees();
            if degrees > report.max_unseen_degrees {
                (report.max_unseen_degrees, report.unseen_frame) = (degrees, frame);
                report.unseen_joint = original.rig.joint_name(index);
            }
        }
    }
}

/// Opens `bytes` (with `rig` if they hold none), plays them, and refuses them if a bound is broken.
pub fn verify(bytes: &[u8], rig: &[u8], motion: &Motion, bound_cm: f64, scalar_part: f64) -> Result<Report> {
    let clip = Clip::with_rig(bytes, rig)?;
    let report = compare(motion, &expand_made(&clip)?)?;
    ensure!(
        report.max_cm <= bound_cm,
        "joint {} at frame {} is {:.4} cm off; the bound is {bound_cm} cm",
        report.worst_joint,
        report.worst_frame,
        report.max_cm
    );
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
