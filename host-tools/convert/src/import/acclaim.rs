//! Acclaim's figure (ASF and AMC) and what becomes of its bones: joints whose frames at rest are all parallel to the world's.
//!
//! A bone begins where its parent ends, and becomes a joint there; one without children gets an End Site at its own end. With
//! C the bone's axes and R the turns by its values (about fixed axes, in their order), it turns by C R C^-1 in its parent.
//! Where C takes the axes of R to axes of the world, that is the same turns about those, and the values are kept as they are
//! but for signs: the root, spine, neck, clavicles, wrists and fingers of CMU's figures. Else the turn is written as three
//! angles, however many values the bone has; the middle one, which must stay away from 90 degrees, is about the axis nearest
//! to the bone, so its twist. Both depend on the skeleton alone: clips of one figure have one rig.
//!
//! The root turns so too, with its orientation as C; its position adds to its translation. A bone's translation (rare) is along
//! C's axes; its length value (`l`, not seen in any file) is left out.

use crate::euler;
use crate::fk::{IDENTITY, Matrix, about, apply, product};
use crate::motion::{Joint, Kind, Motion, Rig};
use crate::note::{Note, NoteKind};

/// A value that a motion gives a bone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dof {
    /// Along an axis: 0, 1, 2 for x, y, z.
    Translation(usize),
    /// About an axis.
    Rotation(usize),
    /// Along the bone.
    Length,
}

/// A bone.
#[derive(Clone, Debug)]
pub struct Bone {
    pub name: String,
    /// Smaller than the bone's own index; `None` for the root.
    pub parent: Option<usize>,
    /// From the bone's start to its end in the rest pose, in units of length.
    pub vector: [f64; 3],
    /// The frame in which its values turn it, in the world of the rest pose.
    pub axes: Matrix,
    /// In the order of the values, which is the order of the turns about fixed axes.
    pub dofs: Vec<Dof>,
}

/// A figure at rest.
#[derive(Clone, Debug)]
pub struct Skeleton {
    /// Parents before children; the root first.
    pub bones: Vec<Bone>,
    /// What is added to the root's translation.
    pub position: [f64; 3],
    /// Length of the unit, where it is stated.
    pub cm_per_unit: Option<f64>,
    /// Whether angles are in radians.
    pub radians: bool,
    /// What could not be used, a sentence each.
    pub notes: Vec<Note>,
}

const POSITIONS: [Kind; 3] = [Kind::Xposition, Kind::Yposition, Kind::Zposition];
const ROTATIONS: [Kind; 3] = [Kind::Xrotation, Kind::Yrotation, Kind::Zrotation];

/// Sine up to which an axis is one of the world's: far below what a text file's angles say, far above their rounding.
const PARALLEL: f64 = 1e-9;

/// The motion of `skeleton` by `values[value][frame]`, bone by bone, rotations in degrees.
pub fn motion(skeleton: &Skeleton, values: &[Vec<f64>], frames: usize, frame_time: f64, notes: &mut Vec<Note>) -> Motion {
    let bones = &skeleton.bones;
    let mut rig = Rig { cm_per_unit: skeleton.cm_per_unit.unwrap_or(1.0), ..Rig::default() };
    let mut channels = Vec::new();
    let mut joints = Vec::new();
    let mut next = 0;
    for (index, bone) in bones.iter().enumerate() {
        let (offset, frame) = match bone.parent {
            None => (skeleton.position, &IDENTITY),
            Some(parent) => (bones[parent].vector, &bone.axes),
        };
        let own = &values[next..next + bone.dofs.len()];
        next += bone.dofs.len();
        let moves = translations(bone, own, frames, offset, frame).into_iter().chain(rotations(bone, own, frames));
        let (kinds, moves): (Vec<Kind>, Vec<Vec<f64>>) = moves.unzip();
        channels.extend(moves);
        joints.push(rig.joints.len());
        let parent = bone.parent.map(|parent| joints[parent]);
        rig.joints.push(Joint { name: bone.name.clone(), parent, offset, kinds, end_site: false, helper: false });
        if !bones.iter().any(|other| other.parent == Some(index)) {
            let parent = Some(rig.joints.len() - 1);
            rig.joints.push(Joint {
                name: String::new(),
                parent,
                offset: bone.vector,
                kinds: Vec::new(),
                end_site: true,
                helper: false,
            });
        }
        if bone.dofs.contains(&Dof::Length) {
            let text = format!("the bone `{}` changes its length, which is left out", bone.name);
            notes.push(Note::warning(NoteKind::Joints, text).of_joint(&bone.name));
        }
    }
    let keys = vec![None; channels.len()];
    Motion { rig, frame_time, frames, values: channels, keys, looped: false, events: Vec::new(), origin: Default::default() }
}

/// The position channels of a bone that has translations: all three, as they replace its `offset`.
fn translations(bone: &Bone, values: &[Vec<f64>], frames: usize, offset: [f64; 3], frame: &Matrix) -> Vec<(Kind, Vec<f64>)> {
    let own: Vec<(usize, &[f64])> = bone.dofs.iter().zip(values).filter_map(translation).collect();
    if own.is_empty() {
        return Vec::new();
    }
    let mut out = POSITIONS.map(|kind| (kind, Vec::with_capacity(frames)));
    for at in 0..frames {
        let mut moved = [0.0; 3];
        own.iter().for_each(|(axis, values)| moved[*axis] = values[at]);
        let moved = apply(frame, moved);
        (0..3).for_each(|axis| out[axis].1.push(offset[axis] + moved[axis]));
    }
    out.into()
}

fn translation<'a>((dof, values): (&Dof, &'a Vec<f64>)) -> Option<(usize, &'a [f64])> {
    if let &Dof::Translation(axis) = dof { Some((axis, values)) } else { None }
}

fn rotation<'a>((dof, values): (&Dof, &'a Vec<f64>)) -> Option<(usize, &'a [f64])> {
    if let &Dof::Rotation(axis) = dof { Some((axis, values)) } else { None }
}

fn rotations(bone: &Bone, values: &[Vec<f64>], frames: usize) -> Vec<(Kind, Vec<f64>)> {
    // As factors from the left: the last turn about fixed axes comes first.
    let own: Vec<(usize, &[f64])> = bone.dofs.iter().zip(values).filter_map(rotation).rev().collect();
    let to_world = |&(axis, values): &(usize, &[f64])| {
        let (axis, sign) = world_axis(&bone.axes, axis)?;
        Some((ROTATIONS[axis], values.iter().map(|value| value * sign).collect()))
    };
    own.iter().map(to_world).collect::<Option<Vec<_>>>().unwrap_or_else(|| resolved(bone, &own, frames))
}

/// The world's axis, and 1 or -1 for its direction, to which `axes` takes `axis`.
fn world_axis(axes: &Matrix, axis: usize) -> Option<(usize, f64)> {
    let along: Vec<usize> = (0..3).filter(|&row| axes[row][axis].abs() > PARALLEL).collect();
    match along.as_slice() {
        &[row] => Some((row, axes[row][axis].signum())),
        _ => None,
    }
}

/// Three angles for the turn C R C^-1 of every frame.
fn resolved(bone: &Bone, own: &[(usize, &[f64])], frames: usize) -> Vec<(Kind, Vec<f64>)> {
    let middle = (0..3).max_by(|&a, &b| bone.vector[a].abs().total_cmp(&bone.vector[b].abs())).unwrap_or(1);
    let order = [[2, 0, 1], [2, 1, 0], [1, 2, 0]][middle];
    let back: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| bone.axes[column][row]));
    let mut out = order.map(|axis| (ROTATIONS[axis], Vec::with_capacity(frames)));
    let mut angles = [0.0; 3];
    for at in 0..frames {
        let turns = own.iter().map(|(axis, values)| about(*axis, values[at].to_radians()));
        let turned = turns.fold(bone.axes, |turned, turn| product(&turned, &turn));
        angles = euler::near(&product(&turned, &back), order, angles);
        out.iter_mut().zip(angles).for_each(|((_, values), angle)| values.push(angle));
    }
    out.into()
}
