//! Forward kinematics: from a pose to where every joint is.

use crate::rotation::{Rotation, RotationBackend, Vector, shift_right};
use crate::skeleton::{Act, Bone, Drive, Part, SLOTS, Skeleton};
use heapless::Vec;

/// Most joints one below the other whose rotation [`Kinematics::turned`] finds.
const DEEPEST: usize = 40;

/// The joints of one frame, in figure units of the world or of a camera. Positions in the world are within 0.05 % of the figure's height of what real numbers give.
#[derive(Clone, Debug)]
pub struct Kinematics<const N: usize, R: RotationBackend = Rotation> {
    /// In the skeleton's order.
    positions: Vec<Vector, N>,
    /// Those that joints wait for.
    rotations: [R; SLOTS],
}

impl<const N: usize, R: RotationBackend> Kinematics<N, R> {
    /// Nothing placed yet.
    #[inline(always)]
    pub const fn new() -> Self {
        Kinematics { positions: Vec::new(), rotations: [R::NONE; SLOTS] }
    }

    /// Places every joint of the skeleton in the world. Channels that the pose lacks are 0.
    pub fn set_pose(&mut self, skeleton: &Skeleton<N>, pose: &[i32]) {
        self.place_in(skeleton, pose, &R::NONE, [0; 3], skeleton.bones.len());
    }

    /// Places the first `count` joints about `origin`, turned by `view`: a camera's target and its axes.
    #[inline(never)]
    pub fn place_in(&mut self, skeleton: &Skeleton<N>, pose: &[i32], view: &R, origin: Vector, count: usize) {
        self.positions.clear();
        let (drives, mut at) = (skeleton.drives(), 0);
        for bone in &skeleton.bones {
            let own = drives.get(at..at + usize::from(bone.drives)).unwrap_or_default();
            at += own.len();
            let turned = self.rotations.get(usize::from(bone.parent_slot)).unwrap_or(view);
            let parent = bone.parent.and_then(|parent| self.positions.get(usize::from(parent)));
            let position = match parent {
                Some(parent) if !bone.moves => {
                    let [x, y, z] = bone.offset;
                    let reach = turned.rotate([x.into(), y.into(), z.into()]);
                    [parent[0].wrapping_add(reach[0]), parent[1].wrapping_add(reach[1]), parent[2].wrapping_add(reach[2])]
                }
                _ => {
                    let offset = offset(skeleton, bone, self.positions.len(), own, pose);
                    moved(parent, turned, offset, origin)
                }
            };
            // The skeleton has at most N bones.
            let _ = self.positions.push(position);
            if self.positions.len() >= count {
                break;
            }
            if bone.slot != bone.parent_slot {
                let place = usize::from(bone.slot);
                match usize::from(bone.parent_slot) {
                    // The view, where nothing is above.
                    parent if parent >= SLOTS => self.rotations.get_mut(place).into_iter().for_each(|own| own.become_as(view)),
                    parent => {
                        if let Ok([own, above]) = self.rotations.get_disjoint_mut([place, parent]) {
                            own.become_as(above);
                        }
                    }
                }
            }
            if let Some(rotation) = self.rotations.get_mut(usize::from(bone.slot)) {
                rotate(rotation, own, pose);
            }
        }
    }

    /// Where one of the first joints is in the world, and the joints above it; others are not placed.
    pub fn place_one(&mut self, skeleton: &Skeleton<N>, pose: &[i32], joint: usize) -> Vector {
        match skeleton.bones.first() {
            Some(root) if joint == 0 => offset(skeleton, root, 0, skeleton.drives(), pose),
            _ => {
                self.place_in(skeleton, pose, &R::NONE, [0; 3], joint + 1);
                self.position(joint)
            }
        }
    }

    /// How one joint is turned: `view` after the rotations of the joints from the root down to it, at most [`DEEPEST`].
    pub(crate) fn turned<V: RotationBackend>(&self, skeleton: &Skeleton<N>, pose: &[i32], view: &V, joint: u8) -> V {
        let mut way: Vec<u8, DEEPEST> = Vec::new();
        let mut next = Some(joint);
        while let Some(joint) = next {
            if way.push(joint).is_err() {
                break;
            }
            next = skeleton.bones.get(usize::from(joint)).and_then(|bone| bone.parent);
        }
        let (mut turned, mut at) = (*view, 0);
        for (index, bone) in skeleton.bones.iter().enumerate() {
            let own = skeleton.drives().get(at..at + usize::from(bone.drives)).unwrap_or_default();
            at += own.len();
            if way.last() == Some(&(index as u8)) {
                way.pop();
                rotate(&mut turned, own, pose);
            }
        }
        turned
    }

    /// Where the joints are, in the skeleton's order.
    pub fn positions(&self) -> &[Vector] {
        &self.positions
    }

    /// A joint's position; the origin if there is none.
    pub fn position(&self, joint: usize) -> Vector {
        self.positions.get(joint).copied().unwrap_or([0; 3])
    }
}

impl<const N: usize, R: RotationBackend> Default for Kinematics<N, R> {
    fn default() -> Self {
        Self::new()
    }
}

/// The place of a joint that is itself moved, or that has no parent: its offset is from the origin of the world then.
#[inline(never)]
fn moved<R: RotationBackend>(parent: Option<&Vector>, turned: &R, offset: Vector, origin: Vector) -> Vector {
    match parent {
        None => turned.rotate_any(core::array::from_fn(|axis| offset[axis].wrapping_sub(origin[axis]))),
        Some(parent) => {
            let reach = turned.rotate_any(offset);
            core::array::from_fn(|axis| parent[axis].wrapping_add(reach[axis]))
        }
    }
}

/// The offset of a joint that may have position channels.
#[inline(never)]
fn offset<const N: usize>(skeleton: &Skeleton<N>, bone: &Bone, index: usize, drives: &[Drive], pose: &[i32]) -> Vector {
    let mut offset = bone.offset.map(i32::from);
    if let Some(place) = skeleton.places.get(index).filter(|_| index <= skeleton.hips && bone.part == Part::Hidden) {
        offset = *place;
    }
    for drive in drives.iter().take(bone.drives.into()).filter(|drive| drive.act() == Act::Offset) {
        for (index, component) in offset.iter_mut().enumerate() {
            if let Some(channel) = drive.member(index) {
                *component = shift_right(value(pose, channel), skeleton.position_shift);
            }
        }
    }
    offset
}

/// Turns a rotation by everything that turns the joint.
#[inline(always)]
fn rotate<R: RotationBackend>(rotation: &mut R, drives: &[Drive], pose: &[i32]) {
    let member = |drive: &Drive, index| drive.member(index).map_or(0, |channel| value(pose, channel));
    for drive in drives {
        match drive.act() {
            Act::Turn(axis) => rotation.turn(axis, value(pose, drive.channel())),
            Act::Offset => {}
            Act::Exponential => rotation.turn_exponential(core::array::from_fn(|index| member(drive, index))),
            Act::Quaternion => rotation.turn_quaternion(core::array::from_fn(|index| member(drive, index))),
        }
    }
}

fn value(pose: &[i32], channel: usize) -> i32 {
    pose.get(channel).copied().unwrap_or(0)
}
