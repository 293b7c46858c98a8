//! How far a motion is from another: world-space distances of joints, by forward kinematics in f64 on both files.

use std::path::Path;

use anyhow::{Result, ensure};
use pantin_tools::fk;
use pantin_tools::import::{self, Options};

/// Distances in cm over all frames.
#[derive(Clone, Copy, Debug, Default)]
pub struct Distance {
    /// Greatest, End Sites included.
    pub greatest: f64,
    /// Greatest at joints alone: what peers are compared at.
    pub joints: f64,
    /// Mean at joints alone.
    pub mean: f64,
}

/// Compares two motion files of one figure.
pub fn between(original: &Path, other: &Path, cm_per_unit: Option<f64>) -> Result<Distance> {
    let load = |path| import::load(path, &Options { cm_per_unit, ..Options::default() }).map(|imported| imported.motion);
    let (original, mut other) = (load(original)?, load(other)?);
    other.rig.cm_per_unit = original.rig.cm_per_unit;
    ensure!(original.frames == other.frames, "{} frames became {}", original.frames, other.frames);
    ensure!(original.rig.joints.len() == other.rig.joints.len(), "the figure has other joints than before");
    let mut distance = Distance::default();
    let (mut sum, mut count) = (0.0, 0);
    for frame in 0..original.frames {
        let places = fk::positions(&original.rig, &original.values, frame);
        let others = fk::positions(&other.rig, &other.values, frame);
        for (joint, (p, q)) in original.rig.joints.iter().zip(places.iter().zip(&others)) {
            let off = (0..3).map(|axis| (p[axis] - q[axis]).powi(2)).sum::<f64>().sqrt();
            distance.greatest = distance.greatest.max(off);
            if !joint.end_site {
                distance.joints = distance.joints.max(off);
                (sum, count) = (sum + off, count + 1);
            }
        }
    }
    distance.mean = sum / f64::from(count.max(1));
    Ok(distance)
}
