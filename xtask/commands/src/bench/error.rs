//! How far a motion is from another: world-space distances of joints, by forward kinematics in f64 on both files.

use std::path::Path;

use anyhow::{Result, ensure};
use pantin_convert::fk;
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::motion::{Joint, Motion, Rig};

/// Distances in cm over all frames.
#[derive(Clone, Copy, Debug, Default)]
pub struct Distance {
    /// Greatest, End Sites included.
    pub greatest: f64,
    /// Greatest at joints alone.
    pub joints: f64,
    /// Mean shell error of joints: of each, the greatest distance of its place and its three points.
    pub mean: f64,
    /// Greatest shell error, which peers are compared at: of all places, and of the points [`SHELL_CM`] from each joint along its own axes, as ACL
    /// measures.
    pub shell: f64,
}

/// The distance of ACL's shell from a joint, in cm.
pub const SHELL_CM: f64 = 3.0;

/// Compares two motion files of one figure.
pub fn between(original: &Path, other: &Path, cm_per_unit: Option<f64>) -> Result<Distance> {
    let load = |path| import::load(path, &ImportOptions::new().cm_per_unit(cm_per_unit)).map(|imported| imported.motion);
    let (original, mut other) = (load(original)?, load(other)?);
    other.rig.cm_per_unit = original.rig.cm_per_unit;
    ensure!(original.frames == other.frames, "{} frames became {}", original.frames, other.frames);
    ensure!(original.rig.joints.len() == other.rig.joints.len(), "the figure has other joints than before");
    Ok(of(&original, &other))
}

/// Compares two motions of one figure and length.
fn of(original: &Motion, other: &Motion) -> Distance {
    let mut distance = Distance::default();
    let [shell, other_shell] = [original, other].map(|motion| with_shell(&motion.rig));
    let (mut sum, mut count, mut shells) = (0.0, 0, Vec::new());
    for frame in 0..original.frames {
        let places = fk::positions(&shell, &original.values, frame);
        let others = fk::positions(&other_shell, &other.values, frame);
        for (joint, (p, q)) in original.rig.joints.iter().zip(places.iter().zip(&others)) {
            let off = (0..3).map(|axis| (p[axis] - q[axis]).powi(2)).sum::<f64>().sqrt();
            distance.greatest = distance.greatest.max(off);
            if !joint.end_site {
                distance.joints = distance.joints.max(off);
                shells.push(off);
            }
        }
        // The three points of a joint follow each other.
        let points = places.iter().zip(&others).skip(original.rig.joints.len()).map(|(p, q)| fk::distance(*p, *q));
        for (point, off) in points.enumerate() {
            shells[point / 3] = shells[point / 3].max(off);
        }
        distance.shell = shells.iter().fold(distance.shell.max(distance.greatest), |most, shell| most.max(*shell));
        (sum, count) = (sum + shells.iter().sum::<f64>(), count + shells.len());
        shells.clear();
    }
    distance.mean = sum / count.max(1) as f64;
    distance
}

/// The rig with three more End Sites at each joint.
fn with_shell(rig: &Rig) -> Rig {
    let mut shell = rig.clone();
    let end = |parent: usize, axis: usize| {
        let mut offset = [0.0; 3];
        offset[axis] = SHELL_CM / rig.cm_per_unit;
        Joint { name: String::new(), parent: Some(parent), offset, kinds: Vec::new(), end_site: true, helper: false }
    };
    let joints = (0..rig.joints.len()).filter(|&joint| !rig.joints[joint].end_site);
    shell.joints.extend(joints.flat_map(|joint| (0..3).map(move |axis| end(joint, axis))));
    shell
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_convert::motion::Kind;

    #[test]
    fn the_last_joints_turn_is_in_the_shell_alone() {
        let joint = |parent: Option<usize>, kinds: &[Kind]| Joint {
            name: "joint".into(),
            parent,
            offset: [0.0, 10.0, 0.0],
            kinds: kinds.to_vec(),
            end_site: false,
            helper: false,
        };
        let rig = Rig { joints: vec![joint(None, &[]), joint(Some(0), &[Kind::Zrotation])], cm_per_unit: 2.0, ..Rig::default() };
        let turned = |angle: f64| Motion {
            rig: rig.clone(),
            frame_time: 0.1,
            frames: 1,
            values: vec![vec![angle]],
            keys: vec![None],
            looped: false,
            origin: Default::default(),
            events: vec![],
        };
        let distance = of(&turned(0.0), &turned(60.0));
        assert_eq!((distance.greatest, distance.joints), (0.0, 0.0));
        // The chord of 60 degrees is as long as the radius.
        assert!((distance.shell - SHELL_CM).abs() < 1e-12, "{}", distance.shell);
        // The other joint does not turn.
        assert!((distance.mean - SHELL_CM / 2.0).abs() < 1e-12, "{}", distance.mean);
    }
}
