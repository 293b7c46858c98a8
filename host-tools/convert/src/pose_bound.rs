//! The bound on a figure's poses that a conversion guarantees at every frame, and the errors that it bounds.
//!
//! The place of a joint does not show how the joint is turned: the yaw of a head or the twist of a forearm moves no other joint.
//! The *shell* of a joint does: its place and the three points at a distance along the joint's own axes. The shell error of a joint
//! is the greatest distance of these four points from where the source has them. An End Site has no rotation; its shell is its place.

use crate::fk::{self, Matrix};
use crate::motion::Rig;

/// The default distance of the shell's points from their joint, in cm, for figures of 1 m or more: ACL's.
pub const SHELL_CM: f64 = 3.0;
/// The same for smaller figures, as a part of their height.
const SHELL_PART_OF_HEIGHT: f64 = 0.03;
/// The height in cm from which on [`SHELL_CM`] holds.
const HEIGHT_OF_SHELL_CM: f64 = 100.0;

/// The points of a joint to which the bound on distances applies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shell {
    /// The joint's place alone: enough for figures that are drawn as lines between joints.
    Places,
    /// The place and three points at this distance in cm, above 0, along the joint's axes.
    Cm(f64),
}

/// What a conversion keeps to at every frame. Helper bones, and what hangs on them, are not bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseBound {
    /// Greatest distance in cm, above 0, of any bounded point from where the source has it.
    pub max_cm: f64,
    /// The points that are bounded.
    pub shell: Shell,
    /// Greatest angle in degrees, above 0 and at most 180, between a joint's true and decoded rotation in the world.
    pub max_rotation_deg: Option<f64>,
    /// Greatest angle in degrees, above 0 and at most 180, between a joint's true and decoded rotation in its parent, as a skinned mesh's local pose has
    /// it. This bounds the whole rotation: single Euler angles can differ by more.
    pub max_joint_deg: Option<f64>,
    /// The mean distance in cm to aim at within the bound: the mean over joints and frames, End Sites left out, of the shell error, or
    /// of the distance of places if they alone are bounded. Without it the bound is filled.
    pub mean_cm: Option<f64>,
}

/// Codes that fill a bound have a mean this many times smaller.
const MEAN_OF_FILLED: f64 = 2.2;

impl PoseBound {
    /// A bound on the shell, whose points are `shell_cm` from their joints.
    pub const fn shell(max_cm: f64, shell_cm: f64) -> PoseBound {
        PoseBound { shell: Shell::Cm(shell_cm), ..PoseBound::places(max_cm) }
    }

    /// A bound on the places of joints and End Sites alone.
    pub const fn places(max_cm: f64) -> PoseBound {
        PoseBound { max_cm, shell: Shell::Places, max_rotation_deg: None, max_joint_deg: None, mean_cm: None }
    }

    /// The distance of the shell's points from their joint in cm; `None` if places alone are bounded.
    pub fn shell_cm(&self) -> Option<f64> {
        match self.shell {
            Shell::Places => None,
            Shell::Cm(cm) => Some(cm),
        }
    }

    /// Whether rotations that move no joint count.
    pub fn sees_rotations(&self) -> bool {
        self.shell != Shell::Places || self.max_rotation_deg.is_some() || self.max_joint_deg.is_some()
    }

    /// The bound in cm that a code with these errors would fill.
    pub fn filled_cm(&self) -> f64 {
        self.mean_cm.map_or(self.max_cm, |mean| MEAN_OF_FILLED * mean)
    }
}

/// The default distance of a shell's points from their joint, in cm, for a figure of this height in cm.
pub fn default_shell_cm(height_cm: Option<f64>) -> f64 {
    match height_cm {
        Some(height) if height > 0.0 && height < HEIGHT_OF_SHELL_CM => SHELL_PART_OF_HEIGHT * height,
        _ => SHELL_CM,
    }
}

/// Whether each joint is bounded: helper bones are not, nor is what hangs on them.
pub fn bounded(rig: &Rig) -> Vec<bool> {
    let mut bounded: Vec<bool> = Vec::with_capacity(rig.joints.len());
    for joint in &rig.joints {
        bounded.push(!joint.helper && joint.parent.is_none_or(|parent| bounded[parent]));
    }
    bounded
}

/// A joint's rotation, and its place in cm, in the world.
pub(crate) type Pose = (Matrix, [f64; 3]);

/// The greatest distance in cm of a joint's four shell points between two poses; `shell_cm` is their distance from the joint, 0 for
/// an End Site or for places alone.
pub(crate) fn shell_distance_cm((turn_a, a): &Pose, (turn_b, b): &Pose, shell_cm: f64) -> f64 {
    let along = |axis: usize| {
        let square = |row: usize| (a[row] - b[row] + shell_cm * (turn_a[row][axis] - turn_b[row][axis])).powi(2);
        (0..3).map(square).sum::<f64>().sqrt()
    };
    let place = fk::distance(*a, *b);
    if shell_cm > 0.0 { (0..3).map(along).fold(place, f64::max) } else { place }
}

/// The angle between two rotations in degrees, 0 to 180.
pub(crate) fn angle_deg(a: &Matrix, b: &Matrix) -> f64 {
    // The squared distance of two rotation matrices is 8 sin^2 of half the angle between them.
    let square: f64 = (0..9).map(|i| (a[i / 3][i % 3] - b[i / 3][i % 3]).powi(2)).sum();
    2.0 * (square / 8.0).sqrt().min(1.0).asin().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::{IDENTITY, about};

    #[test]
    fn a_shell_sees_what_a_place_does_not() {
        let (still, turned) = ((IDENTITY, [1.0, 2.0, 3.0]), (about(1, 60f64.to_radians()), [1.0, 2.0, 3.0]));
        assert_eq!(shell_distance_cm(&still, &turned, 0.0), 0.0);
        // The points across the axis are on a circle of the shell's radius, 60 degrees apart.
        assert!((shell_distance_cm(&still, &turned, 3.0) - 3.0).abs() < 1e-12);
        assert!((angle_deg(&still.0, &turned.0) - 60.0).abs() < 1e-9);
        assert!((angle_deg(&still.0, &about(0, std::f64::consts::PI)) - 180.0).abs() < 1e-6);
    }

    #[test]
    fn small_figures_have_small_shells() {
        assert_eq!([Some(170.0), Some(100.0), None].map(default_shell_cm), [SHELL_CM; 3]);
        assert!((default_shell_cm(Some(20.0)) - 0.6).abs() < 1e-12);
    }
}
