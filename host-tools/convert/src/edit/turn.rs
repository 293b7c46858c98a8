//! A motion turned about the vertical.

use super::display::{add, pose, subtract, transposed};
use super::rotation::write;
use crate::error::{Error, Setting, require};
use crate::fk::{IDENTITY, Matrix, about, apply, distance, local, product};
use crate::motion::Motion;
use anyhow::Result;

/// Farthest in cm that a joint may be from where the turn takes it.
const NEAR_CM: f64 = 1e-3;
/// Farthest that an element of a rotation's matrix may be from where the turn takes it.
const ALIKE: f64 = 1e-6;

/// A joint's rotation and place in the world.
type World = (Matrix, [f64; 3]);

/// Turns the whole motion by `degrees` to the figure's left, about the vertical line through the place of the root in the first frame.
///
/// The topmost joints that turn in the motion take the turn, and the joints with positions above them their part of the way: a root that only places the figure stays as it
/// is, since a player takes the direction of the joint that carries the figure for its heading, and gives each clip the heading of the one before. Where that cannot
/// be, the topmost joints that can turn take it. Fails if a joint cannot follow.
pub fn turn(motion: &Motion, degrees: f64) -> Result<Motion> {
    require!(degrees.is_finite(), Error::setting(Setting::Turn, "expected a number of degrees"));
    if motion.rig.joints.is_empty() || motion.frames == 0 {
        return Ok(motion.clone());
    }
    let firsts = motion.rig.first_channels();
    let turning = |index: usize| {
        let kinds = motion.rig.joints[index].kinds.iter().enumerate();
        let changes = |values: &[f64]| values.iter().any(|value| *value != values[0]);
        { kinds }.any(|(slot, kind)| !kind.is_position() && changes(&motion.values[firsts[index] + slot]))
    };
    turned(motion, degrees, &turning).or_else(|_| turned(motion, degrees, &|_| true))
}

/// The motion turned by joints that `takes` chooses.
fn turned(motion: &Motion, degrees: f64, takes: &dyn Fn(usize) -> bool) -> Result<Motion> {
    let mut out = motion.clone();
    let sign = if motion.rig.up.is_negative() { -1.0 } else { 1.0 };
    let by = about(motion.rig.up.axis(), sign * degrees.to_radians());
    let poses: Vec<Vec<World>> = (0..motion.frames).map(|frame| pose(motion, Some(frame))).collect();
    let centre = poses[0][0].1;
    let goal = |frame: usize, joint: usize| -> World {
        let (turned, place) = &poses[frame][joint];
        (product(&by, turned), add(centre, apply(&by, subtract(*place, centre))))
    };
    // Of joints that do not take the turn: where they are afterwards, at each frame. What hangs on others is carried.
    let mut above: Vec<Option<Vec<World>>> = vec![None; motion.rig.joints.len()];
    let firsts = motion.rig.first_channels();
    for (index, joint) in motion.rig.joints.iter().enumerate() {
        let parents = match joint.parent {
            None => vec![(IDENTITY, [0.0; 3]); motion.frames],
            Some(parent) => match &above[parent] {
                Some(worlds) => worlds.clone(),
                None => continue,
            },
        };
        let first = firsts[index];
        let kept: Vec<Vec<f64>> = out.values[first..first + joint.kinds.len()].to_vec();
        let world = |values: &[Vec<f64>], frame: usize| {
            let (turn, offset) = local(joint, |slot| values[first + slot][frame]);
            let (own, place) = &parents[frame];
            (product(own, &turn), add(*place, apply(own, offset)))
        };
        for (frame, (own, at)) in parents.iter().enumerate() {
            let (turned, place) = goal(frame, index);
            let back = transposed(own);
            let offset = apply(&back, subtract(place, *at));
            for (slot, kind) in joint.kinds.iter().enumerate().filter(|(_, kind)| kind.is_position()) {
                out.values[first + slot][frame] = offset[kind.axis().unwrap_or(0)];
            }
            if takes(index) {
                write(joint, first, &mut out.values, frame, &product(&back, &turned));
            }
        }
        let turned = |frame: usize| alike(&world(&out.values, frame).0, &goal(frame, index).0);
        let taken = (0..motion.frames).all(turned);
        if !taken {
            // What a joint with fewer angles could turn of it would tilt what it carries.
            let rotations = joint.kinds.iter().enumerate().filter(|(_, kind)| !kind.is_position());
            rotations.for_each(|(slot, _)| out.values[first + slot].clone_from(&kept[slot]));
        }
        let worlds: Vec<World> = (0..motion.frames).map(|frame| world(&out.values, frame)).collect();
        let far = (0..motion.frames).map(|frame| distance(worlds[frame].1, goal(frame, index).1)).fold(0.0, f64::max);
        let leaf = !motion.rig.joints.iter().any(|other| other.parent == Some(index));
        let hinge = leaf && !taken && joint.kinds.iter().any(|kind| !kind.is_position());
        let stuck = far * motion.rig.cm_per_unit > NEAR_CM || hinge;
        let why = || format!("{} has no channels by which it could follow", motion.rig.joint_name(index));
        require!(!stuck, Error::value(Setting::Turn, degrees, why()));
        above[index] = (!taken).then_some(worlds);
        for slot in (0..kept.len()).filter(|slot| out.values[first + slot] != kept[*slot]) {
            out.keys[first + slot] = None;
        }
    }
    Ok(out)
}

fn alike(a: &Matrix, b: &Matrix) -> bool {
    (0..9).all(|n| (a[n / 3][n % 3] - b[n / 3][n % 3]).abs() < ALIKE)
}
