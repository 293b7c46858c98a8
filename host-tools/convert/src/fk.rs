//! Forward kinematics in floating point: where a motion puts every joint.

use crate::memory::Memory;
use crate::motion::{Joint, Kind, Rig};
use anyhow::Result;

pub(crate) type Matrix = [[f64; 3]; 3];

pub(crate) const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// World positions of all joints at every frame; refused where they take more memory than the limit.
pub fn all_positions(rig: &Rig, values: &[Vec<f64>], frames: usize, memory: Memory) -> Result<Vec<Vec<[f64; 3]>>> {
    memory.check_numbers(3 * frames * rig.joints.len(), "the places of all joints")?;
    Ok((0..frames).map(|frame| positions(rig, values, frame)).collect())
}

/// The distance between two places.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

/// World positions in cm of all joints, End Sites included, at `frame`. `values[channel][frame]` are in the rig's units.
///
/// A joint's rotations multiply in the order of its channels; position channels replace its offset, axis by axis.
pub fn positions(rig: &Rig, values: &[Vec<f64>], frame: usize) -> Vec<[f64; 3]> {
    worlds(locals(rig, values, frame)).into_iter().map(|(_, place)| place.map(|x| x * rig.cm_per_unit)).collect()
}

/// How all joints are turned at a frame.
pub(crate) struct FramePose {
    /// Each joint's rotation in its parent.
    pub turns: Vec<Matrix>,
    /// Each joint's rotation, and its place in cm, in the world.
    pub worlds: Vec<(Matrix, [f64; 3])>,
}

/// Rotations and places of all joints at `frame`, as for [`positions`].
pub(crate) fn frame_pose(rig: &Rig, values: &[Vec<f64>], frame: usize) -> FramePose {
    let locals: Vec<_> = locals(rig, values, frame).collect();
    let turns = locals.iter().map(|(_, (turn, _))| *turn).collect();
    let mut worlds = worlds(locals.into_iter());
    worlds.iter_mut().for_each(|(_, place)| *place = place.map(|x| x * rig.cm_per_unit));
    FramePose { turns, worlds }
}

/// Each joint's parent, and its rotation and place in the parent.
fn locals<'a>(
    rig: &'a Rig,
    values: &'a [Vec<f64>],
    frame: usize,
) -> impl ExactSizeIterator<Item = (Option<usize>, (Matrix, [f64; 3]))> + 'a {
    let mut next = 0;
    rig.joints.iter().map(move |joint| {
        let channels = &values[next..next + joint.kinds.len()];
        next += joint.kinds.len();
        (joint.parent, local(joint, |channel| channels[channel][frame]))
    })
}

/// Rotations and places in the world of joints, parents first, each with its parent's index and with its rotation and place in the parent.
#[inline(always)]
pub(crate) fn worlds(joints: impl ExactSizeIterator<Item = (Option<usize>, (Matrix, [f64; 3]))>) -> Vec<(Matrix, [f64; 3])> {
    let mut world: Vec<(Matrix, [f64; 3])> = Vec::with_capacity(joints.len());
    for (parent, (rotation, offset)) in joints {
        world.push(match parent {
            None => (rotation, offset),
            Some(parent) => {
                let (turned, place) = &world[parent];
                let moved = apply(turned, offset);
                (product(turned, &rotation), std::array::from_fn(|axis| place[axis] + moved[axis]))
            }
        });
    }
    world
}

/// Rotations of all joints in their parents at `frame`, as quaternions w, x, y, z of length 1; End Sites turn nothing.
pub fn rotations(rig: &Rig, values: &[Vec<f64>], frame: usize) -> Vec<[f64; 4]> {
    let mut next = 0;
    let turn = |joint: &Joint| {
        let channels = &values[next..next + joint.kinds.len()];
        next += joint.kinds.len();
        let [x, y, z, w] = quaternion(&local(joint, |channel| channels[channel][frame]).0);
        [w, x, y, z]
    };
    rig.joints.iter().map(turn).collect()
}

/// Rotation and place of a joint in its parent; `value` gives its channels.
pub(crate) fn local(joint: &Joint, value: impl Fn(usize) -> f64) -> (Matrix, [f64; 3]) {
    let mut offset = joint.offset;
    let mut rotation = IDENTITY;
    let mut quaternion = None;
    let mut exponential = None;
    for (channel, &kind) in joint.kinds.iter().enumerate() {
        let value = value(channel);
        match kind.axis() {
            Some(axis) if kind.is_position() => offset[axis] = value,
            Some(axis) if kind.is_rotation() => rotation = product(&rotation, &about(axis, value.to_radians())),
            Some(axis) if kind.is_exponential() => exponential.get_or_insert([0.0; 3])[axis] = value.to_radians(),
            Some(axis) => quaternion.get_or_insert([0.0; 4])[axis + 1] = value,
            None if kind == Kind::Wquaternion => quaternion.get_or_insert([0.0; 4])[0] = value,
            None => {}
        }
    }
    if let Some(components) = quaternion {
        rotation = product(&rotation, &from_quaternion(components));
    }
    if let Some(vector) = exponential {
        rotation = product(&rotation, &from_exponential(vector));
    }
    (rotation, offset)
}

pub(crate) fn about(axis: usize, angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = IDENTITY;
    matrix[j][j] = c;
    matrix[j][k] = -s;
    matrix[k][j] = s;
    matrix[k][k] = c;
    matrix
}

/// w, x, y, z of any length but 0, which turns nothing.
pub(crate) fn from_quaternion(components: [f64; 4]) -> Matrix {
    let length = components.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return IDENTITY;
    }
    let [w, x, y, z] = components.map(|component| component / length);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// x, y, z, w of a rotation, of length 1.
pub(crate) fn quaternion(m: &Matrix) -> [f64; 4] {
    let trace = m[0][0] + m[1][1] + m[2][2];
    let squares = [2.0 * m[0][0] - trace, 2.0 * m[1][1] - trace, 2.0 * m[2][2] - trace, trace];
    let largest = (0..4).max_by(|&a, &b| squares[a].total_cmp(&squares[b])).unwrap_or(3);
    let anti = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
    let mut q = [0.0; 4];
    q[largest] = 1.0 + squares[largest];
    for i in (0..3).filter(|&i| i != largest) {
        q[i] = if largest == 3 { anti[i] } else { m[largest][i] + m[i][largest] };
    }
    if largest < 3 {
        q[3] = anti[largest];
    }
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

/// Axis times angle in radians.
pub(crate) fn from_exponential(vector: [f64; 3]) -> Matrix {
    let angle = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scale = if angle == 0.0 { 0.5 } else { (angle / 2.0).sin() / angle };
    let [x, y, z] = vector.map(|component| component * scale);
    from_quaternion([(angle / 2.0).cos(), x, y, z])
}

pub(crate) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..3).map(|k| a[row][k] * b[k][column]).sum()))
}

pub(crate) fn apply(matrix: &Matrix, vector: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| (0..3).map(|k| matrix[row][k] * vector[k]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use Kind::*;

    /// Where a bone of length 1 along `axis` ends after a joint with `channels` has turned it.
    fn turned(channels: &[(Kind, f64)], axis: usize) -> [f64; 3] {
        let mut bone = [0.0; 3];
        bone[axis] = 1.0;
        let kinds = channels.iter().map(|&(kind, _)| kind).collect();
        let root = Joint { name: "root".into(), parent: None, offset: [0.0; 3], kinds, end_site: false, helper: false };
        let end = Joint { name: String::new(), parent: Some(0), offset: bone, kinds: Vec::new(), end_site: true, helper: false };
        let rig = Rig { joints: vec![root, end], scalars: Vec::new(), cm_per_unit: 2.0, ..Rig::default() };
        let values: Vec<Vec<f64>> = channels.iter().map(|&(_, value)| vec![value]).collect();
        positions(&rig, &values, 0)[1].map(|x| x / 2.0)
    }

    fn same(a: [f64; 3], b: [f64; 3]) {
        assert!((0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-12), "{a:?} is not {b:?}");
    }

    #[test]
    fn rotations_apply_in_the_order_of_channels() {
        same(turned(&[(Xrotation, 90.0)], 1), [0.0, 0.0, 1.0]);
        same(turned(&[(Xrotation, 90.0), (Yrotation, 90.0)], 0), [0.0, 1.0, 0.0]);
        same(turned(&[(Yrotation, 90.0), (Xrotation, 90.0)], 0), [0.0, 0.0, -1.0]);
    }

    #[test]
    fn positions_replace_the_offset_axis_by_axis() {
        same(turned(&[(Yposition, 3.0), (Yposition, 4.0)], 0), [1.0, 4.0, 0.0]);
    }

    #[test]
    fn quaternions_and_exponential_maps_turn_like_the_angle_they_stand_for() {
        let (half, length) = (20_f64.to_radians(), 7.0);
        for (axis, [euler, exponential, component]) in [
            [Xrotation, Xexponential, Xquaternion],
            [Yrotation, Yexponential, Yquaternion],
            [Zrotation, Zexponential, Zquaternion],
        ]
        .into_iter()
        .enumerate()
        {
            let bone = (axis + 1) % 3;
            let expected = turned(&[(euler, 40.0)], bone);
            same(turned(&[(exponential, 40.0)], bone), expected);
            same(turned(&[(Wquaternion, half.cos() * length), (component, half.sin() * length)], bone), expected);
        }
        same(turned(&[(Wquaternion, 0.0), (Xquaternion, 0.0)], 1), [0.0, 1.0, 0.0]);
        // Half a turn about the diagonal of x and y swaps them.
        let side = 180.0 / 2_f64.sqrt();
        same(turned(&[(Xexponential, side), (Yexponential, side), (Zexponential, 0.0)], 0), [0.0, 1.0, 0.0]);
    }
}
