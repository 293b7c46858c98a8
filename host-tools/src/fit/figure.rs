//! Computes where every joint is at every frame, and how a channel moves the joints below it.

use crate::fk::{IDENTITY, Matrix, about, apply, local, product};
use crate::motion::{Joint, Kind, Rig};

/// Where every joint is, in cm: `[joint][frame]`.
pub type Places = Vec<Vec<[f64; 3]>>;

/// Rotations and places of every joint at every frame, `[joint][frame]`; places in cm. Joints with nothing below them have no rotations.
#[derive(Clone)]
pub struct Poses {
    /// Rotations in the parent.
    locals: Vec<Vec<Matrix>>,
    /// Places in the parent: one for all frames where no channel moves the joint.
    offsets: Places,
    turns: Vec<Vec<Matrix>>,
    /// Where every joint is, in cm.
    pub places: Places,
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

    /// Joints that a channel moves.
    pub fn moved(&self, channel: usize) -> Vec<usize> {
        let (Some(joint), kind, _) = self.channels[channel] else { return Vec::new() };
        let mut moved = self.below[joint].clone();
        if kind.is_position() {
            moved.insert(0, joint);
        }
        moved
    }

    /// All joints at all frames.
    pub fn poses(&self, values: &[Vec<f64>]) -> Poses {
        let joints = self.rig.joints.len();
        let turns: Vec<Vec<Matrix>> =
            self.below.iter().map(|below| vec![IDENTITY; if below.is_empty() { 0 } else { self.frames }]).collect();
        let moves = |joint: &Joint| joint.kinds.iter().any(|kind| kind.is_position());
        let offsets = self.rig.joints.iter().map(|joint| vec![[0.0; 3]; if moves(joint) { self.frames } else { 1 }]).collect();
        let mut poses = Poses { locals: turns.clone(), offsets, turns, places: vec![vec![[0.0; 3]; self.frames]; joints] };
        for joint in 0..joints {
            self.place_local(joint, values, &mut poses);
            self.place(joint, &mut poses);
        }
        poses
    }

    /// Joint `joint` after its channels changed, and all below it.
    pub fn update(&self, joint: usize, values: &[Vec<f64>], poses: &mut Poses) {
        self.place_local(joint, values, poses);
        self.place(joint, poses);
        for &below in &self.below[joint] {
            self.place(below, poses);
        }
    }

    fn place_local(&self, joint: usize, values: &[Vec<f64>], poses: &mut Poses) {
        let entry = &self.rig.joints[joint];
        let first = self.first[joint];
        let cm = self.rig.cm_per_unit;
        let of = |frame: usize| local(entry, |channel| values[first + channel][frame]);
        poses.locals[joint].iter_mut().enumerate().for_each(|(frame, turn)| *turn = of(frame).0);
        poses.offsets[joint].iter_mut().enumerate().for_each(|(frame, offset)| *offset = of(frame).1.map(|x| x * cm));
    }

    fn place(&self, joint: usize, poses: &mut Poses) {
        let Poses { locals, offsets, turns, places } = poses;
        let (locals, offsets) = (&locals[joint], &offsets[joint]);
        let offset = |frame: usize| offsets.get(frame).unwrap_or(&offsets[0]);
        let Some(parent) = self.rig.joints[joint].parent else {
            turns[joint].clone_from(locals);
            places[joint].iter_mut().enumerate().for_each(|(frame, place)| *place = *offset(frame));
            return;
        };
        // Parents come first.
        let ((above, turns), (from, places)) = (turns.split_at_mut(joint), places.split_at_mut(joint));
        let (above, from) = (&above[parent], &from[parent]);
        for (frame, place) in places[0].iter_mut().enumerate() {
            let [dx, dy, dz] = apply(&above[frame], *offset(frame));
            let [x, y, z] = from[frame];
            *place = [x + dx, y + dy, z + dz];
        }
        for ((turn, above), local) in turns[0].iter_mut().zip(above).zip(locals) {
            *turn = product(above, local);
        }
    }

    /// At each frame, the world axis about which a channel turns (radians a degree, or a unit), or along which it moves (cm a unit).
    pub fn axes(&self, channel: usize, values: &[Vec<f64>], poses: &Poses) -> Vec<[f64; 3]> {
        let (Some(joint), kind, _) = self.channels[channel] else { return Vec::new() };
        let parent = self.rig.joints[joint].parent;
        let cm = self.rig.cm_per_unit;
        let of = |frame: usize| {
            let in_parent =
                self.local_axis(channel, joint, kind, values, frame).map(|x| if kind.is_position() { x * cm } else { x });
            parent.map_or(in_parent, |parent| apply(&poses.turns[parent][frame], in_parent))
        };
        (0..self.frames).map(of).collect()
    }

    fn local_axis(&self, channel: usize, joint: usize, kind: Kind, values: &[Vec<f64>], frame: usize) -> [f64; 3] {
        let first = self.first[joint];
        let unit = |axis: usize| std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
        if kind.is_position() {
            return unit(kind.axis().unwrap_or(0));
        }
        if kind.is_rotation() {
            let before =
                self.rig.joints[joint].kinds[..channel - first].iter().enumerate().filter(|(_, kind)| kind.is_rotation());
            let turn = before.fold(IDENTITY, |turn, (i, kind)| {
                product(&turn, &about(kind.axis().unwrap_or(0), values[first + i][frame].to_radians()))
            });
            return apply(&turn, unit(kind.axis().unwrap_or(0))).map(f64::to_radians);
        }
        // Exponential maps and quaternions: how a small change of the channel turns the joint.
        let small = if kind.is_quaternion() { 1e-5 } else { 1e-3 };
        let turn_at = |delta: f64| {
            let value = |i: usize| values[first + i][frame] + if first + i == channel { delta } else { 0.0 };
            local(&self.rig.joints[joint], value).0
        };
        let (less, more) = (turn_at(-small), turn_at(small));
        let across: Matrix =
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| more[i][k] * less[j][k]).sum::<f64>()));
        let scale = 0.25 / small;
        [(across[2][1] - across[1][2]) * scale, (across[0][2] - across[2][0]) * scale, (across[1][0] - across[0][1]) * scale]
    }

    /// Whether a channel translates.
    pub fn translates(&self, channel: usize) -> bool {
        self.channels[channel].1.is_position()
    }
}

/// How a joint at `place` moves by one unit of a channel with this axis whose joint is at `center`: cm.
#[inline]
pub fn lever(axis: &[f64; 3], translates: bool, center: &[f64; 3], place: &[f64; 3]) -> [f64; 3] {
    if translates {
        return *axis;
    }
    let [x, y, z] = [place[0] - center[0], place[1] - center[1], place[2] - center[2]];
    [axis[1] * z - axis[2] * y, axis[2] * x - axis[0] * z, axis[0] * y - axis[1] * x]
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
    let trace = m[0][0] + m[1][1] + m[2][2];
    let squares = [trace, 2.0 * m[0][0] - trace, 2.0 * m[1][1] - trace, 2.0 * m[2][2] - trace];
    let largest = (0..4).max_by(|&a, &b| squares[a].total_cmp(&squares[b])).unwrap_or(0);
    let double = (1.0 + squares[largest]).max(0.0).sqrt();
    let part = 0.5 / double;
    let mut q = [0.0; 4];
    q[largest] = 0.5 * double;
    let anti = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
    if largest == 0 {
        (0..3).for_each(|i| q[i + 1] = anti[i] * part);
    } else {
        let i = largest - 1;
        q[0] = anti[i] * part;
        for j in (0..3).filter(|&j| j != i) {
            q[j + 1] = (m[i][j] + m[j][i]) * part;
        }
    }
    if q[0] < 0.0 {
        q = q.map(|x| -x);
    }
    let sine = (q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
    let angle = 2.0 * sine.atan2(q[0]).to_degrees();
    let scale = if sine > 1e-12 { angle / sine } else { 2f64.to_degrees() };
    [q[1] * scale, q[2] * scale, q[3] * scale]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::from_exponential;

    #[test]
    fn an_exponential_map_comes_back_from_its_rotation() {
        for vector in [[0.0, 0.0, 0.0], [1e-6, 0.0, 2e-6], [10.0, -20.0, 30.0], [0.0, 179.9, 0.0], [120.0, 100.0, -70.0]] {
            let turn = from_exponential(vector.map(f64::to_radians));
            let back = exponential_near(&turn, vector);
            assert!((0..3).all(|i| (back[i] - vector[i]).abs() < 1e-6), "{vector:?} became {back:?}");
        }
    }
}
