//! Forward kinematics in fixed point: from a pose to where every joint is.

use crate::rotation::{Rotation, Vector, shift_right};
use crate::skeleton::{Bone, Drive, Skeleton};
use heapless::Vec;

/// Where a joint is and how it is turned, in the world.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// In figure units.
    pub position: Vector,
    /// Of the joint's own axes.
    pub rotation: Rotation,
}

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
        self.placed.clear();
        let mut drives = skeleton.drives.as_slice();
        for bone in &skeleton.bones {
            let (own, rest) = drives.split_at_checked(usize::from(bone.drives)).unwrap_or((drives, &[]));
            drives = rest;
            let parent = bone.parent.and_then(|parent| self.placed.get(usize::from(parent)));
            let placed = place(parent, bone, own, skeleton.position_shift, pose);
            // The skeleton has at most N bones.
            let _ = self.placed.push(placed);
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

fn place(parent: Option<&Placed>, bone: &Bone, drives: &[Drive], position_shift: i32, pose: &[i32]) -> Placed {
    let mut offset = bone.offset;
    let mut wide = false;
    for drive in drives {
        if let Drive::Offset { axis, channel } = *drive
            && let Some(component) = offset.get_mut(usize::from(axis))
        {
            *component = shift_right(value(pose, channel), position_shift);
            wide = true;
        }
    }
    let Some(parent) = parent else {
        let rotation = if bone.bears { rotated(Rotation::IDENTITY, drives, pose) } else { Rotation::IDENTITY };
        return Placed { position: offset.map(limited), rotation };
    };
    let reach = if wide { parent.rotation.apply_wide(offset) } else { parent.rotation.apply(offset) };
    let position = core::array::from_fn(|axis| limited(parent.position[axis] + reach[axis]));
    let rotation = if bone.bears { rotated(parent.rotation, drives, pose) } else { parent.rotation };
    Placed { position, rotation }
}

/// `rotation` after everything that turns the joint.
fn rotated(mut rotation: Rotation, drives: &[Drive], pose: &[i32]) -> Rotation {
    for drive in drives {
        match *drive {
            Drive::Offset { .. } => {}
            Drive::Turn { axis, channel } => rotation.turn(usize::from(axis), value(pose, channel)),
            Drive::Exponential(channels) => {
                rotation = rotation.then(&Rotation::of_exponential(channels.map(|channel| value(pose, channel))));
            }
            Drive::Quaternion(channels) => {
                rotation = rotation.then(&Rotation::of_quaternion(channels.map(|channel| value(pose, channel))));
            }
        }
    }
    rotation
}

fn value(pose: &[i32], channel: u16) -> i32 {
    pose.get(usize::from(channel)).copied().unwrap_or(0)
}

/// Keeps a place within 2^29, some 8000 figures away, so that adding a bone never overflows.
fn limited(x: i32) -> i32 {
    x.clamp(-(1 << 29), 1 << 29)
}
