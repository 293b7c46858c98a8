//! Joints out of a node tree that something else has evaluated: world transforms on the frames become rotations and places.
//!
//! A rig's joints turn and move but do not stretch. A node's rotation is the one nearest to its linear part with columns of length 1, so
//! scales go into the places of the joints below, and every joint stands where the evaluation puts it. A scale that changes becomes scalars, too.

use super::grid::Grid;
use super::{angles, ends, scales};
use crate::error::with_remedy;
use crate::fk::{IDENTITY, Matrix, apply, distance, positions, product};
use crate::memory::Memory;
use crate::motion::{Joint, Kind, Motion, Rig, Scalar};
use crate::note::{Note, Remedy};
use anyhow::{Context, Result, ensure};
use pantin::codec::layout::MAX_JOINTS;

/// Part of the figure's extent by which a place may waver and still be constant: places are written in f32, whose steps are up to 1.2e-7 of them.
const STANDS: f64 = 2e-7;

/// Three rows; the last column is the place.
pub type Affine = [[f64; 4]; 3];

/// Changes nothing.
pub const UNMOVED: Affine = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// The transform `own` in what `above` transforms.
pub fn chained(above: &Affine, own: &Affine) -> Affine {
    let entry =
        |i: usize, j: usize| (0..3).map(|k| above[i][k] * own[k][j]).sum::<f64>() + if j == 3 { above[i][3] } else { 0.0 };
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// No place of a real figure comes near it.
const LARGEST: f64 = 1e9;
/// Columns shorter than this part of the longest turn nothing.
const FLAT: f64 = 1e-9;

/// One thing in the tree, before it is known whether it becomes a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Role {
    /// The node above, which has a smaller index.
    pub parent: Option<usize>,
    /// Whether the source says that it is a joint, or moves it.
    pub joint: bool,
    /// Whether it moves in its parent.
    pub moves: bool,
    /// Whether it becomes a joint where a joint carries it.
    pub carried: bool,
}

/// The nodes that become joints: joints, what is above them, and what they carry. Nodes above all others that stand still and carry one
/// node each only say where the figure stands, and are left out.
pub fn figure(nodes: &[Role]) -> Result<Vec<usize>> {
    let mut kept: Vec<bool> = nodes.iter().map(|node| node.joint).collect();
    let mut carries = kept.clone();
    for (index, node) in nodes.iter().enumerate() {
        carries[index] |= node.carried && node.parent.is_some_and(|parent| carries[parent]);
        kept[index] |= carries[index];
    }
    for (index, node) in nodes.iter().enumerate().rev() {
        if let (true, Some(parent)) = (kept[index], node.parent) {
            kept[parent] = true;
        }
    }
    let mut children = vec![0; nodes.len()];
    let parents = nodes.iter().zip(&kept).filter(|(_, kept)| **kept).filter_map(|(node, _)| node.parent);
    parents.for_each(|parent| children[parent] += 1);
    let mut order: Vec<usize> = (0..nodes.len()).filter(|&node| kept[node]).collect();
    let only_one_root = order.iter().filter(|&&node| nodes[node].parent.is_none()).count() == 1;
    let still = |node: &&usize| only_one_root && !nodes[**node].moves && !nodes[**node].joint && children[**node] == 1;
    let under = order.iter().take_while(still).count();
    order.drain(..under);
    ensure!(order.len() < MAX_JOINTS, "{} nodes make the figure; a rig holds fewer than {MAX_JOINTS}", order.len());
    Ok(order)
}

/// A node that becomes a joint.
pub struct Node {
    /// Its name.
    pub name: String,
    /// Index of the joint above.
    pub parent: Option<usize>,
    /// World transform at each frame.
    pub worlds: Vec<Affine>,
    /// Its own scale at each frame, if something changes it, else nothing.
    pub scales: Vec<[f64; 3]>,
}

/// What node trees become.
pub struct Figure {
    /// The motion.
    pub motion: Motion,
    /// The greatest distance of a joint from where its node's world transform has it, in the source's unit.
    pub error: f64,
    /// What was odd.
    pub notes: Vec<Note>,
}

/// Refuses a motion that would fill the memory: two keys a year apart are a small file.
pub fn check_size(joints: usize, scalars: usize, grid: &Grid, memory: Memory) -> Result<()> {
    let numbers = (24 * joints + scalars + 1).saturating_mul(grid.frames);
    memory
        .check_numbers(numbers, "the joints' places")
        .and_then(|()| memory.check(grid.frames, 3 * joints + scalars))
        .with_context(|| format!("{} frames are too many for this figure", grid.frames))
        .map_err(|error| with_remedy(&error, Remedy::LowerFrameRate))
}

/// The motion of `nodes` (parents before children) and `scalars`.
pub fn motion(nodes: Vec<Node>, mut scalars: Vec<(Scalar, Vec<f64>)>, grid: &Grid) -> Result<Figure> {
    for node in &nodes {
        let sound = node.worlds.iter().flatten().flatten().all(|x| x.abs() <= LARGEST);
        ensure!(sound, "`{}` is moved beyond {LARGEST:e}", node.name);
    }
    let nodes = joined(nodes, grid.frames);
    let scaled: Vec<&Node> = nodes.iter().filter(|node| !scales::changing(&node.scales).is_empty()).collect();
    scalars.extend(scaled.iter().flat_map(|node| scales::scalars(&node.name, &node.scales)));
    let scaled: Vec<&str> = scaled.into_iter().map(|node| node.name.as_str()).collect();
    let mut notes: Vec<Note> = scales::warning(&scaled).into_iter().collect();
    let wavers = STANDS * extent(&nodes);
    let turns: Vec<Vec<Matrix>> = nodes.iter().map(|node| rotations(&node.worlds)).collect();
    let mut joints = Vec::new();
    let mut values = Vec::new();
    let mut sites = Vec::new();
    for (index, node) in nodes.iter().enumerate() {
        let above = node.parent.map(|parent| (&nodes[parent], &turns[parent]));
        let (offset, places) = places(node, above, wavers);
        let local = |frame: usize| above.map_or(turns[index][frame], |(_, up)| product(&back(&up[frame]), &turns[index][frame]));
        let locals: Vec<Matrix> = (0..grid.frames).map(local).collect();
        let rotations = angles::channels(&locals);
        let leaf = nodes.iter().all(|other| other.parent != Some(index));
        if leaf && !rotations.is_empty() && node.parent.is_some() && offset != [0.0; 3] {
            sites.push(end(index, offset));
        }
        let (kinds, channels): (Vec<Kind>, Vec<Vec<f64>>) = places.into_iter().chain(rotations).unzip();
        values.extend(channels);
        joints.push(Joint { name: node.name.clone(), parent: node.parent, offset, kinds, end_site: false, helper: false });
    }
    joints.extend(sites);
    notes.extend(ends::complete(&mut joints));
    let (scalars, of_scalars): (Vec<_>, Vec<_>) = scalars.into_iter().unzip();
    values.extend(of_scalars);
    let keys = vec![None; values.len()];
    let rig = Rig { joints, scalars, cm_per_unit: 1.0, ..Rig::default() };
    let motion = Motion {
        rig,
        frame_time: grid.frame_time,
        frames: grid.frames,
        values,
        keys,
        looped: false,
        events: Vec::new(),
        origin: Default::default(),
    };
    let error = error(&motion, &nodes.iter().map(|node| node.worlds.as_slice()).collect::<Vec<_>>());
    Ok(Figure { motion, error, notes })
}

/// The greatest distance of the first joints of `motion` from the places of `worlds`, in the motion's unit.
pub fn error(motion: &Motion, worlds: &[&[Affine]]) -> f64 {
    let at = |frame: usize| {
        let places = positions(&motion.rig, &motion.values, frame);
        let far = worlds.iter().zip(places).map(|(worlds, found)| {
            let expected = place(&worlds[frame]).map(|x| x * motion.rig.cm_per_unit);
            distance(found, expected)
        });
        far.fold(0.0, f64::max)
    };
    (0..motion.frames).map(at).fold(0.0, f64::max) / motion.rig.cm_per_unit
}

/// An End Site for a joint that turns and carries no other, as a bound on places would not see its rotation: half as far as the bone before
/// it, in the same direction.
fn end(parent: usize, bone: [f64; 3]) -> Joint {
    let offset = bone.map(|x| x / 2.0);
    Joint { name: String::new(), parent: Some(parent), offset, kinds: Vec::new(), end_site: true, helper: false }
}

/// Several figures hang from one joint that stands in the middle of the world.
fn joined(mut nodes: Vec<Node>, frames: usize) -> Vec<Node> {
    if nodes.iter().filter(|node| node.parent.is_none()).count() > 1 {
        nodes.iter_mut().for_each(|node| node.parent = Some(node.parent.map_or(0, |parent| parent + 1)));
        nodes.insert(0, Node { name: "root".into(), parent: None, worlds: vec![UNMOVED; frames], scales: Vec::new() });
    }
    nodes
}

fn place(world: &Affine) -> [f64; 3] {
    world.map(|row| row[3])
}

/// How far joints are apart at frame 0 along an axis, at most.
fn extent(nodes: &[Node]) -> f64 {
    let along = |axis: usize| {
        let places = nodes.iter().map(|node| place(&node.worlds[0])[axis]);
        let (low, high) = places.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    if nodes.is_empty() { 0.0 } else { (0..3).map(along).fold(0.0, f64::max) }
}

/// The offset, and the position channels along the axes on which it wavers.
fn places(node: &Node, above: Option<(&Node, &Vec<Matrix>)>, wavers: f64) -> ([f64; 3], Vec<(Kind, Vec<f64>)>) {
    const KINDS: [Kind; 3] = [Kind::Xposition, Kind::Yposition, Kind::Zposition];
    let local = |(frame, world): (usize, &Affine)| match above {
        None => place(world),
        Some((parent, turns)) => {
            let from = place(&parent.worlds[frame]);
            let bone = std::array::from_fn(|axis| world[axis][3] - from[axis]);
            apply(&back(&turns[frame]), bone)
        }
    };
    let places: Vec<[f64; 3]> = node.worlds.iter().enumerate().map(local).collect();
    let mut offset = [0.0; 3];
    let mut channels = Vec::new();
    for (axis, kind) in KINDS.into_iter().enumerate() {
        let values: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
        offset[axis] = (low + high) / 2.0;
        if high - low > 2.0 * wavers {
            channels.push((kind, values));
        }
    }
    (offset, channels)
}

fn back(turn: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| turn[column][row]))
}

/// A rotation a frame; a node of no size keeps the one that it had.
fn rotations(worlds: &[Affine]) -> Vec<Matrix> {
    let mut before = IDENTITY;
    let turn = |world: &Affine| {
        before = rotation(world).unwrap_or(before);
        before
    };
    worlds.iter().map(turn).collect()
}

/// The rotation nearest to the linear part, or, if that mirrors, to its opposite, of which no axis is preferred.
fn rotation(world: &Affine) -> Option<Matrix> {
    let length = |column: usize| world.iter().map(|row| row[column] * row[column]).sum::<f64>().sqrt();
    let lengths = [0, 1, 2].map(length);
    let longest = lengths.into_iter().fold(0.0, f64::max);
    if longest <= 0.0 || lengths.iter().any(|&length| length < FLAT * longest) {
        return None;
    }
    let mut m: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| world[row][column] / lengths[column]));
    // Newton's iteration for the polar decomposition converges quadratically; from columns of length 1 a few rounds do.
    for _ in 0..40 {
        let inverse = cofactors(&m)?;
        let next: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| (m[i][j] + inverse[i][j]) / 2.0));
        let change = (0..9).map(|n| (next[n / 3][n % 3] - m[n / 3][n % 3]).abs()).fold(0.0, f64::max);
        m = next;
        if change < 1e-15 {
            break;
        }
    }
    let sign = determinant(&m).signum();
    Some(m.map(|row| row.map(|x| x * sign)))
}

fn cofactor(m: &Matrix, i: usize, j: usize) -> f64 {
    let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
    m[a][c] * m[b][d] - m[a][d] * m[b][c]
}

fn determinant(m: &Matrix) -> f64 {
    (0..3).map(|j| m[0][j] * cofactor(m, 0, j)).sum()
}

/// The transposed inverse; `None` for columns that lie in a plane.
fn cofactors(m: &Matrix) -> Option<Matrix> {
    let determinant = determinant(m);
    let inverse = std::array::from_fn(|i| std::array::from_fn(|j| cofactor(m, i, j) / determinant));
    (determinant.abs() > FLAT).then_some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::{about, positions};

    fn affine(linear: Matrix, place: [f64; 3]) -> Affine {
        std::array::from_fn(|i| [linear[i][0], linear[i][1], linear[i][2], place[i]])
    }

    #[test]
    fn what_stretches_keeps_its_rotation() {
        for scale in [[1.0, 1.0, 1.0], [25.0, 40.0, 0.1], [-1.0, 1.0, 1.0]] {
            let turn = product(&about(0, 0.4), &about(2, 2.5));
            let stretched = std::array::from_fn(|i| std::array::from_fn(|j| turn[i][j] * scale[j]));
            let found = rotation(&affine(stretched, [0.0; 3])).unwrap();
            let square = product(&found, &back(&found));
            assert!((0..9).all(|n| (square[n / 3][n % 3] - IDENTITY[n / 3][n % 3]).abs() < 1e-14));
            assert!(determinant(&found) > 0.0);
            let same = (0..9).all(|n| (found[n / 3][n % 3] - turn[n / 3][n % 3]).abs() < 1e-14);
            assert_eq!(same, scale[0] > 0.0, "{scale:?}");
        }
        assert_eq!(rotation(&affine([[0.0; 3]; 3], [1.0; 3])), None);
        assert_eq!(rotation(&affine([[1.0; 3]; 3], [1.0; 3])), None);
    }

    #[test]
    fn joints_stand_where_the_worlds_are() {
        // A sheared and a growing node above one that moves on its own.
        let grid = super::super::grid::over(0.0, 1.0, 20.0, "").unwrap();
        let world = |frame: usize, joint: usize| {
            let t = frame as f64 / 10.0;
            let turn = product(&about(0, t + joint as f64), &[[1.0 + t, 0.3, 0.0], [0.0, 2.0, 0.0], [0.0, 0.1, 3.0]]);
            affine(turn, [joint as f64 * t.sin(), 5.0 * joint as f64, -t])
        };
        let node = |joint: usize| Node {
            name: joint.to_string(),
            parent: joint.checked_sub(1),
            worlds: (0..grid.frames).map(|frame| world(frame, joint)).collect(),
            scales: Vec::new(),
        };
        let Figure { motion, error, .. } = motion((0..3).map(node).collect(), Vec::new(), &grid).unwrap();
        assert!(error < 1e-10, "{error}");
        for frame in 0..grid.frames {
            for (joint, found) in positions(&motion.rig, &motion.values, frame)[..3].iter().enumerate() {
                let expected = place(&world(frame, joint));
                assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-10), "{joint} at {frame}: {found:?}");
            }
        }
        assert!(motion.rig.joints[3].end_site);
    }

    #[test]
    fn the_figure_is_what_moves_and_what_it_carries() {
        let node = |parent, joint, carried| Role { parent, joint, moves: joint, carried };
        let axes = node(None, false, true);
        let nodes = [
            axes,
            node(Some(0), true, true),
            node(Some(1), false, true),
            node(Some(1), false, false),
            node(Some(0), false, true),
        ];
        assert_eq!(figure(&nodes).unwrap(), [1, 2]);
        let two = [axes, node(Some(0), true, true), node(Some(0), true, true)];
        assert_eq!(figure(&two).unwrap(), [0, 1, 2]);
    }
}
