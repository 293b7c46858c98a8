//! Computes where every joint is at every frame, and how a channel moves the joints below it.

use crate::fk::{IDENTITY, Matrix, about, apply, local, product, quaternion};
use crate::motion::{Kind, Rig};

/// Where every joint is, in cm: `[joint][frame]`.
pub type Places = Vec<Vec<[f64; 3]>>;

/// Rotations and places of every joint at every frame, `[joint][frame]`; places in cm. End Sites have no rotations.
#[derive(Clone, Default)]
pub struct Poses {
    /// How every joint is turned in the world.
    pub(super) turns: Vec<Vec<Matrix>>,
    /// Where every joint is, in cm.
    pub places: Places,
}

impl Poses {
    /// Takes what a joint's channels change, the joint and all below it, with a copy of what that depends on: its parent. The rest is empty.
    pub fn take(&mut self, figure: &Figure, joint: usize) -> Poses {
        let joints = figure.rig.joints.len();
        let mut part = Poses { turns: vec![Vec::new(); joints], places: vec![Vec::new(); joints] };
        if let Some(parent) = figure.rig.joints[joint].parent {
            part.turns[parent].clone_from(&self.turns[parent]);
            part.places[parent].clone_from(&self.places[parent]);
        }
        self.exchange(&mut part, figure, joint);
        part
    }

    /// Exchanges a joint and all below it.
    pub fn exchange(&mut self, other: &mut Poses, figure: &Figure, joint: usize) {
        for joint in std::iter::once(joint).chain(figure.below[joint].iter().copied()) {
            std::mem::swap(&mut self.turns[joint], &mut other.turns[joint]);
            std::mem::swap(&mut self.places[joint], &mut other.places[joint]);
        }
    }
}

/// A rig, and what depends on what.
pub struct Figure {
    /// Joints and channels as the clip codes them.
    pub rig: Rig,
    /// Number of frames.
    pub frames: usize,
    /// Each joint's first channel.
    pub first: Vec<usize>,
    /// Joint, kind and place among the joint's channels of every channel.
    pub channels: Vec<(Option<usize>, Kind, usize)>,
    /// Joints below each joint.
    pub below: Vec<Vec<usize>>,
}

impl Figure {
    /// Prepares `rig`.
    pub fn new(rig: Rig, frames: usize) -> Figure {
        let mut below = vec![Vec::new(); rig.joints.len()];
        for joint in 0..rig.joints.len() {
            let mut above = rig.joints[joint].parent;
            while let Some(parent) = above {
                below[parent].push(joint);
                above = rig.joints[parent].parent;
            }
        }
        let first = rig.first_channels();
        let channels = rig.channel_kinds().into_iter().enumerate();
        let channels = channels.map(|(c, (joint, kind))| (joint, kind, joint.map_or(0, |joint| c - first[joint]))).collect();
        Figure { rig, frames, first, channels, below }
    }

    /// All joints at all frames. `value` has each channel at each frame.
    pub fn poses(&self, value: impl Fn(usize, usize) -> f64) -> Poses {
        let turns =
            (0..self.rig.joints.len()).map(|joint| vec![IDENTITY; if self.turns(joint) { self.frames } else { 0 }]).collect();
        let mut poses = Poses { turns, places: vec![vec![[0.0; 3]; self.frames]; self.rig.joints.len()] };
        for joint in 0..self.rig.joints.len() {
            for frame in 0..self.frames {
                let (turn, place) = self.pose(joint, frame, &value, &poses);
                poses.places[joint][frame] = place;
                poses.turns[joint].get_mut(frame).into_iter().for_each(|slot| *slot = turn);
            }
        }
        poses
    }

    /// Whether a joint has rotations: an End Site has none.
    fn turns(&self, joint: usize) -> bool {
        !self.rig.joints[joint].end_site || !self.below[joint].is_empty()
    }

    /// Joint `joint` after its channels changed, and all below it, which turn and move with it.
    pub fn update(&self, joint: usize, value: impl Fn(usize, usize) -> f64, poses: &mut Poses) {
        let mut changes = Vec::with_capacity(if self.below[joint].is_empty() { 0 } else { self.frames });
        for frame in 0..self.frames {
            let (turn, place) = self.pose(joint, frame, &value, poses);
            let from = std::mem::replace(&mut poses.places[joint][frame], place);
            if let Some(slot) = poses.turns[joint].get_mut(frame) {
                let before = std::mem::replace(slot, turn);
                changes.push((orthonormal(&product(&turn, &transposed(&before))), from, place));
            }
        }
        for &below in &self.below[joint] {
            for (at, (change, from, to)) in poses.places[below].iter_mut().zip(&changes) {
                let [x, y, z] = apply(change, [at[0] - from[0], at[1] - from[1], at[2] - from[2]]);
                *at = [to[0] + x, to[1] + y, to[2] + z];
            }
            for (turn, (change, ..)) in poses.turns[below].iter_mut().zip(&changes) {
                *turn = product(change, turn);
            }
        }
    }

    /// Rotation and place of a joint at a frame, where its parent's are known.
    fn pose(&self, joint: usize, frame: usize, value: &impl Fn(usize, usize) -> f64, poses: &Poses) -> (Matrix, [f64; 3]) {
        let first = self.first[joint];
        let (turn, offset) = local(&self.rig.joints[joint], |channel| value(first + channel, frame));
        let offset = offset.map(|x| x * self.rig.cm_per_unit);
        let Some(parent) = self.rig.joints[joint].parent else { return (turn, offset) };
        let above = &poses.turns[parent][frame];
        let ([dx, dy, dz], [x, y, z]) = (apply(above, offset), poses.places[parent][frame]);
        (product(above, &turn), [x + dx, y + dy, z + dz])
    }

    /// At each frame, the world axis about which a channel turns (radians a degree, or a unit), or along which it moves (cm a unit).
    pub fn axes(&self, channel: usize, value: impl Fn(usize, usize) -> f64, poses: &Poses) -> Vec<[f64; 3]> {
        let (Some(joint), kind, _) = self.channels[channel] else { return Vec::new() };
        let parent = self.rig.joints[joint].parent;
        let cm = self.rig.cm_per_unit;
        let of = |frame: usize| {
            let in_parent = self
                .local_axis(channel, joint, kind, |channel| value(channel, frame))
                .map(|x| if kind.is_position() { x * cm } else { x });
            parent.map_or(in_parent, |parent| apply(&poses.turns[parent][frame], in_parent))
        };
        (0..self.frames).map(of).collect()
    }

    fn local_axis(&self, channel: usize, joint: usize, kind: Kind, value: impl Fn(usize) -> f64) -> [f64; 3] {
        let first = self.first[joint];
        let unit = |axis: usize| std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
        if kind.is_position() {
            return unit(kind.axis().unwrap_or(0));
        }
        if kind.is_rotation() {
            let before =
                self.rig.joints[joint].kinds[..channel - first].iter().enumerate().filter(|(_, kind)| kind.is_rotation());
            let turn = before.fold(IDENTITY, |turn, (i, kind)| {
                product(&turn, &about(kind.axis().unwrap_or(0), value(first + i).to_radians()))
            });
            return apply(&turn, unit(kind.axis().unwrap_or(0))).map(f64::to_radians);
        }
        // Exponential maps and quaternions: how a small change of the channel turns the joint.
        let small = if kind.is_quaternion() { 1e-5 } else { 1e-3 };
        let turn_at = |delta: f64| {
            let at = |i: usize| value(first + i) + if first + i == channel { delta } else { 0.0 };
            local(&self.rig.joints[joint], at).0
        };
        let (less, more) = (turn_at(-small), turn_at(small));
        let across: Matrix =
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| more[i][k] * less[j][k]).sum::<f64>()));
        let scale = 0.25 / small;
        [(across[2][1] - across[1][2]) * scale, (across[0][2] - across[2][0]) * scale, (across[1][0] - across[0][1]) * scale]
    }

    /// Whether no joint moves with two joints at once.
    pub fn apart(&self, one: usize, other: usize) -> bool {
        one != other && !self.below[one].contains(&other) && !self.below[other].contains(&one)
    }

    /// Whether a channel translates.
    pub fn translates(&self, channel: usize) -> bool {
        self.channels[channel].1.is_position()
    }
}

/// The rotation that a matrix is up to rounding: without it, rounding doubles from joint to joint along a chain.
fn orthonormal(m: &Matrix) -> Matrix {
    let square = product(m, &product(&transposed(m), m));
    std::array::from_fn(|row| std::array::from_fn(|column| 1.5 * m[row][column] - 0.5 * square[row][column]))
}

pub(super) fn transposed(m: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| m[column][row]))
}

/// The exponential map, in degrees, of a rotation; of all those that turn alike, the one nearest to `before`.
pub fn exponential_near(turn: &Matrix, before: [f64; 3]) -> [f64; 3] {
    let vector = exponential(turn);
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let about = |turns: i32| {
        // A rotation by no angle turns alike by whole turns about any axis: take the one that it had.
        let scale = if length > 1e-9 { (length + 360.0 * f64::from(turns)) / length } else { 1.0 };
        vector.map(|x| x * scale)
    };
    let far = |v: &[f64; 3]| (0..3).map(|i| (v[i] - before[i]).powi(2)).sum::<f64>();
    (-2..=2).map(about).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(vector)
}

fn exponential(m: &Matrix) -> [f64; 3] {
    // By the quaternion, whose largest component is never small: exact near no turn and near half a turn.
    let q = quaternion(m);
    let [x, y, z, w] = if q[3] < 0.0 { q.map(|x| -x) } else { q };
    let sine = (x * x + y * y + z * z).sqrt();
    let angle = 2.0 * sine.atan2(w).to_degrees();
    let scale = if sine > 1e-12 { angle / sine } else { 2f64.to_degrees() };
    [x, y, z].map(|x| x * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::{from_exponential, positions};
    use crate::motion::Joint;

    #[test]
    fn rounding_does_not_grow_along_a_chain() {
        let joint = |index: usize| Joint {
            name: index.to_string(),
            parent: index.checked_sub(1),
            offset: [1.0, 2.0, 3.0],
            kinds: vec![Kind::Zrotation, Kind::Xrotation],
            end_site: false,
            helper: false,
        };
        let rig = Rig { joints: (0..100).map(joint).collect(), cm_per_unit: 1.0, ..Rig::default() };
        let mut values: Vec<Vec<f64>> = (0..200).map(|channel| vec![f64::from(channel), 3.0]).collect();
        let figure = Figure::new(rig, 2);
        let mut poses = figure.poses(|channel, frame| values[channel][frame]);
        for update in 0..400 {
            let channel = update * 7 % 200;
            values[channel].iter_mut().for_each(|value| *value += 0.3);
            figure.update(channel / 2, |channel, frame| values[channel][frame], &mut poses);
        }
        let expected = positions(&figure.rig, &values, 1);
        for (places, expected) in poses.places.iter().zip(expected) {
            assert!((0..3).all(|axis| (places[1][axis] - expected[axis]).abs() < 1e-9));
        }
    }

    #[test]
    fn joints_follow_the_changes_of_those_above_them() {
        let joint = |parent: Option<usize>, kinds: &[Kind]| Joint {
            name: format!("{parent:?}"),
            parent,
            offset: [3.0, 4.0, 5.0],
            kinds: kinds.to_vec(),
            end_site: false,
            helper: false,
        };
        use Kind::{Xexponential, Xrotation, Yexponential, Yposition, Yrotation, Zexponential};
        let joints = vec![
            joint(None, &[Yposition, Xrotation, Yrotation]),
            joint(Some(0), &[Xexponential, Yexponential, Zexponential]),
            joint(Some(1), &[Yposition, Yrotation]),
            joint(Some(2), &[]),
            joint(Some(0), &[]),
        ];
        let rig = Rig { joints, cm_per_unit: 2.0, ..Rig::default() };
        let mut values: Vec<Vec<f64>> =
            (0..8).map(|channel| (0..9).map(|frame| f64::from(channel * 7 + frame * 11 % 50)).collect()).collect();
        let figure = Figure::new(rig, 9);
        let mut poses = figure.poses(|channel, frame| values[channel][frame]);
        for (channel, joint) in [0, 0, 0, 1, 1, 1, 2, 2].into_iter().enumerate() {
            values[channel].iter_mut().enumerate().for_each(|(frame, value)| *value -= 3.0 * frame as f64);
            figure.update(joint, |channel, frame| values[channel][frame], &mut poses);
            for frame in 0..9 {
                let expected = positions(&figure.rig, &values, frame);
                for (places, expected) in poses.places.iter().zip(expected) {
                    assert!((0..3).all(|axis| (places[frame][axis] - expected[axis]).abs() < 1e-9));
                }
            }
        }
    }

    #[test]
    fn an_exponential_map_comes_back_from_its_rotation() {
        for vector in [[0.0, 0.0, 0.0], [1e-6, 0.0, 2e-6], [10.0, -20.0, 30.0], [0.0, 179.9, 0.0], [120.0, 100.0, -70.0]] {
            let turn = from_exponential(vector.map(f64::to_radians));
            let back = exponential_near(&turn, vector);
            assert!((0..3).all(|i| (back[i] - vector[i]).abs() < 1e-6), "{vector:?} became {back:?}");
        }
    }
}
