//! The bounded quantities of a joint as the fit sees them, all in cm: how far each is off, and how far one channel moves it.
//!
//! A rotation error counts as a distance too. With R the decoded and T the true rotation, the columns of R - T are three vectors the sum of
//! whose squares is 8 sin^2 of half the angle between R and T. Times a radius in cm they are one error vector of nine numbers,
//! which is as long as the bound where the angle is the greatest allowed. So every quantity has the same limit, and depends
//! on a small change of a channel alike: `rest + lever * change`.

use super::figure::{Figure, Poses, transposed};
use crate::fk::{Matrix, product};
use crate::number::Number;
use crate::pose_bound::{PoseBound, bounded};

/// What is bounded, and how it is weighed.
pub struct Measure {
    /// Greatest distance in cm.
    pub max_cm: f64,
    /// Distance of the shell's points from their joint, in cm; 0 for places alone.
    shell_cm: f64,
    /// The radius in cm that makes a rotation error in the world a distance.
    rotation_cm: Option<f64>,
    /// The same for rotations in the parent.
    joint_cm: Option<f64>,
    /// Whether each joint is bounded.
    pub bounded: Vec<bool>,
    /// The bounds of rotations, in degrees, for messages.
    degrees: [Option<f64>; 2],
}

/// A quantity's error as a function of a channel's change e: its square is `rr + 2 jr e + jj e^2`, and `ee` now.
#[derive(Clone, Copy, Default)]
pub struct Quadratic {
    /// The square of the error now, in cm^2.
    pub ee: f64,
    /// The square of the lever.
    pub jj: f64,
    /// The lever times the error at e = 0.
    pub jr: f64,
    /// The square of the error at e = 0.
    pub rr: f64,
}

impl Quadratic {
    /// Of an error vector, which a change of 1 moves by `lever`; the change is `now` at present.
    #[inline(always)]
    fn of(error: &[f64; 3], lever: &[f64; 3], now: f64) -> Quadratic {
        let rest: [f64; 3] = std::array::from_fn(|i| error[i] - lever[i] * now);
        Quadratic { ee: square(error), jj: dot(lever, lever), jr: dot(lever, &rest), rr: square(&rest) }
    }

    /// Whether all changes from `least` to `most` keep the square of the error within `limit`: takes no root, unlike [`Self::within`].
    #[inline(always)]
    pub fn holds(&self, limit: f64, least: f64, most: f64) -> bool {
        let square = |change: f64| self.rr + change * (2.0 * self.jr + change * self.jj);
        // A parabola that opens upward is greatest at an end.
        square(least) <= limit && square(most) <= limit
    }

    /// The changes, `now` among them, that keep the square of the error within `limit`.
    #[inline(always)]
    pub fn within(&self, limit: f64, now: f64) -> (f64, f64) {
        if self.jj <= 0.0 {
            return (f64::MIN, f64::MAX);
        }
        let root = self.jr * self.jr - self.jj * (self.rr - limit);
        if root <= 0.0 {
            return (now, now);
        }
        let root = root.sqrt();
        (((-self.jr - root) / self.jj).min(now), ((-self.jr + root) / self.jj).max(now))
    }

    #[inline(always)]
    fn plus(self, other: Quadratic) -> Quadratic {
        Quadratic { ee: self.ee + other.ee, jj: self.jj + other.jj, jr: self.jr + other.jr, rr: self.rr + other.rr }
    }
}

/// How a channel moves the joints below it at one frame.
pub struct Motion<'a> {
    /// The world axis of its rotation in radians for a raw unit, or of its translation in cm for one.
    pub axis: [f64; 3],
    /// Whether it translates.
    pub translates: bool,
    /// The place of the channel's joint in cm.
    pub center: &'a [f64; 3],
    /// The channel's error in raw units.
    pub now: f64,
}

impl Measure {
    /// The quantities of a bound.
    pub fn of(bound: &PoseBound, figure: &Figure) -> Measure {
        let radius = |degrees: f64| bound.max_cm / (8f64.sqrt() * (degrees.to_radians() / 2.0).sin());
        Measure {
            max_cm: bound.max_cm,
            shell_cm: bound.shell_cm().unwrap_or(0.0),
            rotation_cm: bound.max_rotation_deg.map(radius),
            joint_cm: bound.max_joint_deg.map(radius),
            bounded: bounded(&figure.rig),
            degrees: [bound.max_rotation_deg, bound.max_joint_deg],
        }
    }

    /// The bounds of rotations as a clause behind a distance: ` and 2 degrees a joint`.
    pub fn rotation_bounds(&self) -> String {
        let [world, joint] = self.degrees.map(|degrees| degrees.map(Number));
        let world = world.map_or_else(String::new, |degrees| format!(" and {degrees} degrees in the world"));
        let joint = joint.map_or_else(String::new, |degrees| format!(" and {degrees} degrees a joint"));
        world + &joint
    }

    /// Whether a joint's own rotation counts.
    fn sees_rotations(&self) -> bool {
        self.shell_cm > 0.0 || self.rotation_cm.is_some() || self.joint_cm.is_some()
    }

    /// The bounded joints of which a channel moves a quantity.
    pub fn moved(&self, figure: &Figure, channel: usize) -> Vec<usize> {
        let (Some(joint), kind, _) = figure.channels[channel] else { return Vec::new() };
        let own = (kind.is_position() || self.sees_rotations()).then_some(joint);
        own.into_iter().chain(figure.below[joint].iter().copied()).filter(|&joint| self.bounded[joint]).collect()
    }

    /// The number of bounded points of these joints.
    pub fn points(&self, figure: &Figure, joints: &[usize]) -> usize {
        let of = |joint: &usize| if self.has_shell(figure, *joint) { 4 } else { 1 };
        joints.iter().map(of).sum()
    }

    fn has_shell(&self, figure: &Figure, joint: usize) -> bool {
        self.shell_cm > 0.0 && !figure.rig.joints[joint].end_site
    }

    /// The greatest shell distance of a joint, in cm.
    pub fn distance_cm(&self, figure: &Figure, poses: &Poses, original: &Poses, joint: usize, frame: usize) -> f64 {
        self.distance_square(figure, poses, original, joint, frame).sqrt()
    }

    fn distance_square(&self, figure: &Figure, poses: &Poses, original: &Poses, joint: usize, frame: usize) -> f64 {
        let error = difference(&poses.places[joint][frame], &original.places[joint][frame]);
        let place = square(&error);
        if !self.has_shell(figure, joint) {
            return place;
        }
        let (turn, truth) = (&poses.turns[joint][frame], &original.turns[joint][frame]);
        let point = |axis: usize| {
            let off: [f64; 3] = std::array::from_fn(|row| error[row] + self.shell_cm * (turn[row][axis] - truth[row][axis]));
            square(&off)
        };
        (0..3).map(point).fold(place, f64::max)
    }

    /// The square of the greatest error of a joint, rotations included, in cm. `own` is whether its rotation in its parent counts.
    pub fn worst_square(&self, figure: &Figure, poses: &Poses, original: &Poses, joint: usize, frame: usize, own: bool) -> f64 {
        let mut worst = self.distance_square(figure, poses, original, joint, frame);
        if figure.rig.joints[joint].end_site {
            return worst;
        }
        let apart = |truth: &Matrix| {
            let turn = &poses.turns[joint][frame];
            (0..9).map(|i| (turn[i / 3][i % 3] - truth[i / 3][i % 3]).powi(2)).sum::<f64>()
        };
        if let Some(radius) = self.rotation_cm {
            worst = worst.max(radius * radius * apart(&original.turns[joint][frame]));
        }
        if let Some(radius) = self.joint_cm.filter(|_| own) {
            worst = worst.max(radius * radius * apart(&true_in_parent(figure, poses, original, joint, frame)));
        }
        worst
    }

    /// Calls `each` with every quantity of a joint that the channel `motion` of the joint `mover` moves.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub fn each(
        &self,
        figure: &Figure,
        poses: &Poses,
        original: &Poses,
        [joint, mover]: [usize; 2],
        frame: usize,
        motion: &Motion<'_>,
        mut each: impl FnMut(Quadratic),
    ) {
        let place = &poses.places[joint][frame];
        let error = difference(place, &original.places[joint][frame]);
        let lever = lever(&motion.axis, motion.translates, motion.center, place);
        if motion.translates || joint != mover {
            each(Quadratic::of(&error, &lever, motion.now));
        }
        if figure.rig.joints[joint].end_site || !self.sees_rotations() {
            return;
        }
        let turn = &poses.turns[joint][frame];
        if self.shell_cm > 0.0 {
            let truth = &original.turns[joint][frame];
            for axis in 0..3 {
                let point = |row: usize| self.shell_cm * turn[row][axis];
                let off = std::array::from_fn(|row| error[row] + point(row) - self.shell_cm * truth[row][axis]);
                let along = std::array::from_fn(point);
                let turned = if motion.translates { [0.0; 3] } else { cross(&motion.axis, &along) };
                let moves = std::array::from_fn(|i| lever[i] + turned[i]);
                each(Quadratic::of(&off, &moves, motion.now));
            }
        }
        if motion.translates {
            return;
        }
        if let Some(radius) = self.rotation_cm {
            each(rotation(turn, &original.turns[joint][frame], radius, motion));
        }
        if let Some(radius) = self.joint_cm.filter(|_| joint == mover) {
            each(rotation(turn, &true_in_parent(figure, poses, original, joint, frame), radius, motion));
        }
    }
}

/// The error of a rotation as one quantity.
fn rotation(turn: &Matrix, truth: &Matrix, radius: f64, motion: &Motion<'_>) -> Quadratic {
    let of = |axis: usize| {
        let along = std::array::from_fn(|row| radius * turn[row][axis]);
        let off = std::array::from_fn(|row| radius * (turn[row][axis] - truth[row][axis]));
        Quadratic::of(&off, &cross(&motion.axis, &along), motion.now)
    };
    of(0).plus(of(1)).plus(of(2))
}

/// The rotation that a joint would have in the world if it had its true rotation in its parent, whose own may be off.
fn true_in_parent(figure: &Figure, poses: &Poses, original: &Poses, joint: usize, frame: usize) -> Matrix {
    let truth = &original.turns[joint][frame];
    let Some(parent) = figure.rig.joints[joint].parent else { return *truth };
    let local = product(&transposed(&original.turns[parent][frame]), truth);
    product(&poses.turns[parent][frame], &local)
}

/// How a joint at `place` moves by one unit of a channel with this axis whose joint is at `center`: cm.
#[inline(always)]
fn lever(axis: &[f64; 3], translates: bool, center: &[f64; 3], place: &[f64; 3]) -> [f64; 3] {
    if translates { *axis } else { cross(axis, &difference(place, center)) }
}

#[inline(always)]
fn difference(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn cross(a: &[f64; 3], [x, y, z]: &[f64; 3]) -> [f64; 3] {
    [a[1] * z - a[2] * y, a[2] * x - a[0] * z, a[0] * y - a[1] * x]
}

#[inline(always)]
fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn square(a: &[f64; 3]) -> f64 {
    dot(a, a)
}
