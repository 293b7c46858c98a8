//! Chooses Euler angles or an exponential map for each joint, by what they cost (docs/METHOD.md 5).

use super::figure::exponential_near;
use super::raw;
use crate::fk::{local, quaternion};
use crate::motion::{Joint, Kind, Motion, Rig};
use crate::pose_bound::PoseBound;

/// How joints with three Euler angles about three axes are coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotations {
    /// Choose for each joint what seems smaller
    ByCost,
    /// Use the file's Euler angles
    Euler,
    /// Use exponential maps where they stay within half a turn
    Exponential,
    /// Use quaternions, four channels a joint; the rig has them instead of the angles
    Quaternion,
}

/// Exponential maps are chosen where they seem this much cheaper.
const WORTHWHILE: f64 = 0.9;
/// Their components stay inside half a turn, which an angle holds without wrapping.
const LARGEST_DEGREES: f64 = 179.0;

/// The same motion with quaternions instead of Euler angles at all joints with three of them, and a sign that keeps each component from jumping.
pub fn quaternions(motion: &Motion) -> Motion {
    const KINDS: [Kind; 4] = [Kind::Wquaternion, Kind::Xquaternion, Kind::Yquaternion, Kind::Zquaternion];
    let mut out = Motion { values: Vec::new(), keys: Vec::new(), ..motion.clone() };
    let firsts = motion.rig.first_channels();
    let turning = turning(&motion.rig);
    for (index, joint) in motion.rig.joints.iter().enumerate() {
        let turning = turning.iter().find(|turning| turning.joint == index);
        let mut kinds = Vec::new();
        for (slot, &kind) in joint.kinds.iter().enumerate() {
            match turning.filter(|turning| turning.slots.contains(&slot)) {
                None => {
                    kinds.push(kind);
                    out.values.push(motion.values[firsts[index] + slot].clone());
                    out.keys.push(motion.keys[firsts[index] + slot].clone());
                }
                Some(turning) if turning.slots[0] == slot => {
                    kinds.extend(KINDS);
                    out.values.extend(turning.quaternions(motion));
                    out.keys.extend([const { None }; 4]);
                }
                Some(_) => {}
            }
        }
        out.rig.joints[index].kinds = kinds;
    }
    out.values.extend_from_slice(&motion.values[motion.rig.joint_channels()..]);
    out.keys.extend_from_slice(&motion.keys[motion.rig.joint_channels()..]);
    out
}

/// How a clip codes the values of its rig. One figure renderer plays all clips whose rigs and codings are equal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coding {
    /// Positions are multiples of 2^length_exponent units.
    pub length_exponent: i8,
    /// Whether each joint with three rotation channels, in the rig's order, is coded as an exponential map.
    pub exponentials: Vec<bool>,
}

impl Coding {
    /// Positions are multiples of 2 to this power of the motion's units.
    pub fn length_exponent(&self) -> i8 {
        self.length_exponent
    }

    /// How many joints are coded as exponential maps.
    pub fn exponential_joints(&self) -> usize {
        self.exponentials.iter().filter(|exponential| **exponential).count()
    }

    /// The coding that the clips of `motions` share: motions of one rig, each with its bound. A joint is coded as an
    /// exponential map if all motions together cost less that way and each of them allows it.
    pub fn of(motions: &[(&Motion, PoseBound)], rotations: Rotations) -> Coding {
        let mut costs: Vec<Costs> = Vec::new();
        for (motion, bound) in motions {
            let of_motion = costs_of(motion, bound);
            costs.resize(of_motion.len(), Costs { euler: 0.0, exponential: 0.0, possible: true });
            costs.iter_mut().zip(of_motion).for_each(|(total, cost)| total.add(&cost));
        }
        let exponents = motions.iter().map(|(motion, _)| raw::clip_length_exponent(&motion.rig, &motion.values));
        Coding {
            length_exponent: exponents.max().unwrap_or(0),
            exponentials: costs.iter().map(|costs| costs.choose(rotations)).collect(),
        }
    }

    /// This coding, changed where it cannot hold `motion`: joints whose exponential maps leave half a turn become Euler angles, and positions beyond
    /// the range get coarser steps.
    pub fn widened_for(&self, motion: &Motion) -> Coding {
        let held =
            |(turning, exponential): (&Turning, &bool)| *exponential && turning.allows(motion, &turning.exponentials(motion));
        Coding {
            length_exponent: self.length_exponent.max(raw::clip_length_exponent(&motion.rig, &motion.values)),
            exponentials: turning(&motion.rig).iter().zip(&self.exponentials).map(held).collect(),
        }
    }

    /// `motion` with exponential maps instead of Euler angles at the joints that are coded so.
    pub fn apply(&self, motion: &Motion) -> Motion {
        let mut out = motion.clone();
        for (turning, _) in turning(&motion.rig).iter().zip(&self.exponentials).filter(|(_, exponential)| **exponential) {
            let components = [Kind::Xexponential, Kind::Yexponential, Kind::Zexponential];
            for ((&slot, values), kind) in turning.slots.iter().zip(turning.exponentials(motion)).zip(components) {
                out.values[turning.first + slot] = values;
                out.rig.joints[turning.joint].kinds[slot] = kind;
            }
        }
        out
    }
}

/// About how many bits a joint's rotations take in all motions, in both codings.
#[derive(Clone)]
struct Costs {
    euler: f64,
    exponential: f64,
    /// Whether an exponential map can hold the rotations.
    possible: bool,
}

impl Costs {
    fn add(&mut self, other: &Costs) {
        self.euler += other.euler;
        self.exponential += other.exponential;
        self.possible &= other.possible;
    }

    fn choose(&self, rotations: Rotations) -> bool {
        let wanted = match rotations {
            Rotations::ByCost => self.exponential < WORTHWHILE * self.euler,
            Rotations::Euler | Rotations::Quaternion => false,
            Rotations::Exponential => true,
        };
        wanted && self.possible
    }
}

/// The costs of each joint of [`turning`].
fn costs_of(motion: &Motion, bound: &PoseBound) -> Vec<Costs> {
    let reach = reach_cm(motion, bound);
    let bound_cm = bound.filled_cm();
    // Longer than the clip, it finds no bends.
    let stride = ((5.0 / 30.0 / motion.frame_time).round() as usize).clamp(1, motion.frames.max(1));
    let of = |turning: &Turning| {
        let scale = 1f64.to_radians() * reach[turning.joint] / (0.5 * bound_cm);
        let exponential = turning.exponentials(motion);
        Costs {
            euler: turning.slots.iter().map(|&slot| roughness(&motion.values[turning.first + slot], stride, scale)).sum(),
            exponential: exponential.iter().map(|values| roughness(values, stride, scale)).sum(),
            possible: turning.allows(motion, &exponential),
        }
    };
    turning(&motion.rig).iter().map(of).collect()
}

/// A joint with three rotation channels.
struct Turning {
    joint: usize,
    /// The joint's first channel.
    first: usize,
    /// Which of the joint's channels rotate it.
    slots: Vec<usize>,
}

/// Whether a joint has three rotations, which can be coded in several ways.
pub fn has_choice(rig: &Rig) -> bool {
    !turning(rig).is_empty()
}

fn turning(rig: &Rig) -> Vec<Turning> {
    let first = rig.first_channels();
    let of = |(joint, entry): (usize, &Joint)| {
        let slots: Vec<usize> = (0..entry.kinds.len()).filter(|&slot| entry.kinds[slot].is_rotation()).collect();
        (slots.len() == 3).then(|| Turning { joint, first: first[joint], slots })
    };
    rig.joints.iter().enumerate().filter_map(of).collect()
}

impl Turning {
    /// Whether a clip can hold these exponential maps of the joint: it turns about three axes, by less than half a turn.
    fn allows(&self, motion: &Motion, exponential: &[Vec<f64>; 3]) -> bool {
        let kinds = &motion.rig.joints[self.joint].kinds;
        let axes = self.slots.iter().filter_map(|&slot| kinds[slot].axis());
        let distinct = axes.fold(0, |seen, axis| seen | 1 << axis) == 7;
        distinct && exponential.iter().flatten().all(|x| x.abs() < LARGEST_DEGREES)
    }

    /// The joint's rotation at every frame as a quaternion w, x, y, z; of the two that turn alike, the one nearer to that of the frame before.
    fn quaternions(&self, motion: &Motion) -> [Vec<f64>; 4] {
        let joint = &motion.rig.joints[self.joint];
        let mut before = [1.0, 0.0, 0.0, 0.0];
        let mut out: [Vec<f64>; 4] = Default::default();
        for frame in 0..motion.frames {
            let (turn, _) = local(joint, |channel| motion.values[self.first + channel][frame]);
            let [x, y, z, w] = quaternion(&turn);
            let along = [w, x, y, z].iter().zip(&before).map(|(a, b)| a * b).sum::<f64>();
            before = [w, x, y, z].map(|component| if along < 0.0 { -component } else { component });
            (0..4).for_each(|component| out[component].push(before[component]));
        }
        out
    }

    /// The joint's rotation at every frame as an exponential map in degrees.
    fn exponentials(&self, motion: &Motion) -> [Vec<f64>; 3] {
        let joint = &motion.rig.joints[self.joint];
        let mut before = [0.0; 3];
        let mut out: [Vec<f64>; 3] = Default::default();
        for frame in 0..motion.frames {
            let (turn, _) = local(joint, |channel| motion.values[self.first + channel][frame]);
            before = exponential_near(&turn, before);
            (0..3).for_each(|axis| out[axis].push(before[axis]));
        }
        out
    }
}

/// Length of the longest chain below each joint, its shell included: what its rotations can move. A bound on rotations is as strict as
/// the bound on distances at the reach where both allow the same angle.
fn reach_cm(motion: &Motion, bound: &PoseBound) -> Vec<f64> {
    let joints = &motion.rig.joints;
    let shell = bound.shell_cm().unwrap_or(0.0);
    let mut reach: Vec<f64> = joints.iter().map(|joint| if joint.end_site { 0.0 } else { shell }).collect();
    for (index, joint) in joints.iter().enumerate().rev() {
        if let Some(parent) = joint.parent {
            let bone = joint.offset.iter().map(|x| x * x).sum::<f64>().sqrt() * motion.rig.cm_per_unit;
            reach[parent] = reach[parent].max(reach[index] + bone);
        }
    }
    let degrees = [bound.max_rotation_deg, bound.max_joint_deg].into_iter().flatten().fold(f64::INFINITY, f64::min);
    reach.iter().map(|reach| reach.max(bound.filled_cm() / degrees.to_radians())).collect()
}

/// About how many bits the bends of a curve take: second differences over a sixth of a second, in bounds.
fn roughness(values: &[f64], stride: usize, scale: f64) -> f64 {
    let bends = values.windows(2 * stride + 1).map(|w| (w[0] - 2.0 * w[stride] + w[2 * stride]) * scale);
    bends.map(|bend| (1.0 + bend * bend).log2()).sum()
}
