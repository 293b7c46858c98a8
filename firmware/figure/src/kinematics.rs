//! Forward kinematics in fixed point: from a pose to where every joint is.

use crate::rotation::{Rotation, Vector, shift_right};
use crate::skeleton::{Bone, Drive, NONE, Skeleton};
use heapless::Vec;

/// Where a joint is and how it is turned, in the world.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// In figure units.
    pub position: Vector,
    /// Of the joint's own axes; only kept for joints that others hang on.
    pub rotation: Rotation,
}

impl Placed {
    const ORIGIN: Placed = Placed { position: [0; 3], rotation: Rotation::IDENTITY };
}

/// Places stay within 2^29, some 8000 figures away, so that adding a bone never overflows.
const FARTHEST: i32 = 1 << 29;

/// The joints of one frame. Positions are within 0.05 % of the figure's height of what real numbers give.
#[derive(Clone, Debug, Default)]
pub struct Kinematics<const N: usize> {
    placed: Vec<Placed, N>,
}

impl<const N: usize> Kinematics<N> {
    /// Nothing placed yet.
    pub const fn new() -> Self {
        Kinematics { placed: Vec::new() }
    }

    /// Places every joint of the skeleton. Channels that the pose lacks are 0.
    pub fn place(&mut self, skeleton: &Skeleton<N>, pose: &[i32]) {
        // The skeleton has at most N bones.
        let _ = self.placed.resize(skeleton.bones.len(), Placed::ORIGIN);
        let mut drives = skeleton.drives();
        for (index, bone) in skeleton.bones.iter().enumerate() {
            let (own, rest) = drives.split_at_checked(usize::from(bone.drives)).unwrap_or((drives, &[]));
            drives = rest;
            let Some((before, [placed, ..])) = self.placed.split_at_mut_checked(index) else { return };
            let parent = bone.parent.and_then(|parent| before.get(usize::from(parent))).unwrap_or(&Placed::ORIGIN);
            placed.position = position(parent, bone, own, skeleton.position_shift, pose);
            if bone.bears {
                placed.rotation = parent.rotation;
                rotate(&mut placed.rotation, own, pose);
            }
        }
    }

    /// Joints in the skeleton's order.
    pub fn joints(&self) -> &[Placed] {
        &self.placed
    }

    /// A joint's position; the origin if there is none.
    pub fn position(&self, joint: usize) -> Vector {
        self.placed.get(joint).map_or([0; 3], |placed| placed.position)
    }
}

fn position(parent: &Placed, bone: &Bone, drives: &[Drive], position_shift: i32, pose: &[i32]) -> Vector {
    let reach = if bone.moves {
        let mut offset = bone.offset;
        for drive in drives {
            let Drive::Offset(channels) = drive else { continue };
            for (component, &channel) in offset.iter_mut().zip(channels).filter(|(_, channel)| **channel != NONE) {
                *component = shift_right(value(pose, channel), position_shift);
            }
        }
        parent.rotation.apply_any(offset)
    } else {
        parent.rotation.apply(bone.offset)
    };
    core::array::from_fn(|axis| (parent.position[axis] + reach[axis]).clamp(-FARTHEST, FARTHEST))
}

/// Turns a rotation by everything that turns the joint.
fn rotate(rotation: &mut Rotation, drives: &[Drive], pose: &[i32]) {
    for drive in drives {
        match *drive {
            Drive::Offset(_) => {}
            Drive::Turn { axis, channel } => rotation.turn(usize::from(axis), value(pose, channel)),
            Drive::Exponential(channels) => {
                *rotation = rotation.then(&Rotation::of_exponential(channels.map(|channel| value(pose, channel))));
            }
            Drive::Quaternion(channels) => {
                *rotation = rotation.then(&Rotation::of_quaternion(channels.map(|channel| value(pose, channel))));
            }
        }
    }
}

fn value(pose: &[i32], channel: u16) -> i32 {
    pose.get(usize::from(channel)).copied().unwrap_or(0)
}
