//! The display's body: 15 joints with ends at the crown, the hands and the toes, in the proportions of a source's rest pose.

use super::display_names::DISPLAY;
use crate::fk::{Matrix, apply, local, product};
use crate::motion::{Joint, Kind, Motion, Rig};

/// World turns and places, in the source's units, of all joints in one pose.
pub(crate) type Pose = Vec<(Matrix, [f64; 3])>;

/// Channels of a display's joint: twist last.
const TURNS: [Kind; 3] = [Kind::Zrotation, Kind::Xrotation, Kind::Yrotation];
const PLACES: [Kind; 3] = [Kind::Xposition, Kind::Yposition, Kind::Zposition];
/// A hand or a head that ends nowhere in the source ends this part of the bone before it farther on.
const STUMP: f64 = 0.4;
/// The display's joints whose bones end in End Sites, as they stand in [`DISPLAY`]: head, hands, feet.
const TIPS: [usize; 5] = [2, 5, 8, 11, 14];

/// The display's rig and where its joints stand at rest, in the world.
pub(crate) struct Body {
    pub rig: Rig,
    /// Place of each of the 15 at rest.
    pub rest: [[f64; 3]; 15],
    /// World turn of each source joint at rest.
    pub turns: [Matrix; 15],
}

/// The pose of `motion` in `frame`; without a frame, all turns at 0 and the joints that `offset` holds at their offsets.
pub(crate) fn pose(motion: &Motion, frame: Option<usize>) -> Pose {
    let mut pose: Pose = Vec::with_capacity(motion.rig.joints.len());
    for (joint, first) in motion.rig.joints.iter().zip(motion.rig.first_channels()) {
        let placed = joint.offset == [0.0; 3];
        let at_rest = |slot: usize| match joint.kinds[slot] {
            kind if kind.is_position() && placed => motion.values[first + slot][0],
            kind if kind.is_position() => kind.axis().map_or(0.0, |axis| joint.offset[axis]),
            Kind::Wquaternion => 1.0,
            _ => 0.0,
        };
        let (turn, offset) = match frame {
            Some(frame) => local(joint, |slot| motion.values[first + slot][frame]),
            None => local(joint, at_rest),
        };
        pose.push(match joint.parent {
            None => (turn, offset),
            Some(parent) => {
                let (above, place) = &pose[parent];
                (product(above, &turn), add(*place, apply(above, offset)))
            }
        });
    }
    pose
}

/// The body by the rest pose of `motion`: all turns at 0 if the figure then stands upright, which it does in BVH and ASF, else the first frame.
pub(crate) fn body(motion: &Motion, sources: &[usize; 15]) -> Body {
    let zero = pose(motion, None);
    let rest = if stands(&zero, sources) { zero } else { pose(motion, Some(0)) };
    let places = sources.map(|source| rest[source].1);
    let mut joints: Vec<Joint> = Vec::new();
    let mut indices = [0; 15];
    for (index, &(name, parent, _)) in DISPLAY.iter().enumerate() {
        indices[index] = joints.len();
        let offset = parent.map_or([0.0; 3], |parent| subtract(places[index], places[parent]));
        let placing: &[Kind] = if parent.is_none() { &PLACES } else { &[] };
        let kinds = [placing, &TURNS].concat();
        joints.push(Joint {
            name: name.into(),
            parent: parent.map(|parent| indices[parent]),
            offset,
            kinds,
            end_site: false,
            helper: false,
        });
        let bone = offset.map(|x| x * STUMP);
        let tip = TIPS.contains(&index).then(|| tip(&motion.rig, &rest, sources[index]));
        // A foot without toes points nowhere that is known.
        let tip = tip.and_then(|tip| tip.or((!name.ends_with("Foot")).then_some(bone)));
        if let Some(offset) = tip {
            joints.push(Joint {
                name: String::new(),
                parent: Some(indices[index]),
                offset,
                kinds: Vec::new(),
                end_site: true,
                helper: false,
            });
        }
    }
    let rig = Rig { joints, scalars: motion.rig.scalars.clone(), cm_per_unit: motion.rig.cm_per_unit, up: motion.rig.up };
    Body { rig, rest: places, turns: sources.map(|source| rest[source].0) }
}

/// Whether the head is beyond the chest, and the feet on the other side of the hips.
pub(crate) fn stands(pose: &Pose, sources: &[usize; 15]) -> bool {
    let at = |index: usize| pose[sources[index]].1;
    let spine = subtract(at(1), at(0));
    let along = |a: usize, b: usize| dot(subtract(at(b), at(a)), spine);
    let length = dot(spine, spine);
    along(1, 2) > 0.1 * length && along(9, 11) < -length && along(12, 14) < -length
}

/// From a joint to where it ends at rest: its farthest child, thumbs aside.
fn tip(rig: &Rig, rest: &Pose, joint: usize) -> Option<[f64; 3]> {
    let children = (0..rig.joints.len()).filter(|&child| rig.joints[child].parent == Some(joint));
    let fingers = children.filter(|&child| !rig.joints[child].name.to_lowercase().contains("thumb"));
    let vectors = fingers.map(|child| subtract(rest[child].1, rest[joint].1));
    vectors.filter(|&vector| dot(vector, vector) > 0.0).max_by(|&a, &b| dot(a, a).total_cmp(&dot(b, b)))
}

/// The turn nearest to `start` that takes `from` to `to` as well as a turn can, by least squares.
///
/// Each step turns about the axis that takes the columns of the one nearer to the other (Mueller et al. 2016): it also works
/// where one vector alone says nothing of the twist, which then stays that of `start`.
pub(crate) fn aim(start: Matrix, from: &[[f64; 3]], to: &[[f64; 3]]) -> Matrix {
    let mut turn = start;
    for _ in 0..AIM_STEPS {
        let turned: Vec<[f64; 3]> = from.iter().map(|&vector| apply(&turn, vector)).collect();
        let pairs = || turned.iter().zip(to);
        let weight: f64 = pairs().map(|(&a, &b)| dot(a, b)).sum::<f64>().abs() + 1e-12;
        let sideways = pairs().fold([0.0; 3], |sum, (&a, &b)| add(sum, cross(a, b)));
        let vector = sideways.map(|x| x / weight);
        turn = product(&crate::fk::from_exponential(vector), &turn);
        if dot(vector, vector) < 1e-20 {
            break;
        }
    }
    turn
}

/// Far more than it takes: the angle left falls by a factor each step, and starts small.
const AIM_STEPS: usize = 60;

pub(crate) fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

pub(crate) fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn norm(vector: [f64; 3]) -> f64 {
    dot(vector, vector).sqrt()
}

pub(crate) fn transposed(matrix: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::{IDENTITY, about};

    #[test]
    fn aiming_finds_a_turn_from_afar() {
        let turn = product(&about(0, 2.0), &about(2, -1.3));
        let from = [[1.0, 0.2, 0.0], [0.0, 3.0, 0.1], [0.3, 0.0, 1.5]];
        let to = from.map(|vector| apply(&turn, vector));
        let found = aim(IDENTITY, &from, &to);
        assert!((0..9).all(|n| (found[n / 3][n % 3] - turn[n / 3][n % 3]).abs() < 1e-6));
        // One vector is met without twist.
        let found = aim(IDENTITY, &[[0.0, 2.0, 0.0]], &[[1.0, 1.0, 0.0]]);
        let expected = about(2, -std::f64::consts::FRAC_PI_4);
        assert!((0..9).all(|n| (found[n / 3][n % 3] - expected[n / 3][n % 3]).abs() < 1e-6));
    }
}
