//! The joints from a figure's root to one of its ends, for inverse kinematics: where they are in a pose, and how to turn them.

use crate::error::{Error, Name};
use crate::groups::{Group, Shape};
use crate::math;
use heapless::Vec;
use pantin::{Angle, Clip, Component, Kinds};
use pantin_math::rotation::{Rotation, Vector};
use pantin_math::vector::{add, transposed};

/// A joint of a chain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bone<'a> {
    /// Where it stands in its parent, in figure units.
    pub(crate) offset: Vector,
    place: [Option<u16>; 3],
    first: u16,
    len: u8,
    shape: Shape,
    kinds: Kinds<'a>,
    axes: [u8; 3],
}

/// Joints from the root down. A figure unit is the power of two of the source's unit in which the longest component of a bone lies within 2^13
/// to 2^14.
#[derive(Clone, Debug)]
pub(crate) struct Chain<'a, const N: usize> {
    pub(crate) bones: Vec<Bone<'a>, N>,
    /// Right shift from a position channel's raw value to figure units.
    pub(crate) shift: i32,
}

/// Where a joint is, and how what hangs on it is turned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint {
    pub(crate) place: Vector,
    pub(crate) rotation: Rotation,
}

impl Joint {
    const ROOT: Joint = Joint { place: [0; 3], rotation: Rotation::IDENTITY };
}

impl<'a, const N: usize> Chain<'a, N> {
    /// The chain to a joint by its name.
    pub(crate) fn to(clip: &Clip<'a>, groups: &[Group], name: &str) -> Result<Self, Error> {
        let end = clip.rig().find(name).ok_or_else(|| Error::NoSuchJoint(Name::new(name)))?.index();
        Chain::to_joint(clip, groups, end)
    }

    /// The chain to a joint by its index.
    pub(crate) fn to_joint(clip: &Clip<'a>, groups: &[Group], end: usize) -> Result<Self, Error> {
        let rig = clip.rig();
        let (down, shift) = units(clip);
        let mut chain = Chain { bones: Vec::new(), shift };
        let mut next = Some(end);
        while let Some((index, joint)) = next.and_then(|index| Some((index, rig.joint(index)?))) {
            let (bone, given) = (Bone::of(&joint, index, groups, down), N);
            chain.bones.push(bone).map_err(|_| Error::TooSmall { what: "joints of a chain", needed: N + 1, given })?;
            next = joint.parent.map(usize::from);
        }
        chain.bones.reverse();
        Ok(chain)
    }

    /// Where joint `count - 1` of the chain is in a pose.
    pub(crate) fn place(&self, pose: &[i32], count: usize) -> Joint {
        let mut joint = Joint::ROOT;
        for bone in self.bones.iter().take(count) {
            joint = bone.after(&joint, pose, self.shift);
        }
        joint
    }
}

/// Right shifts to figure units: of the rig's offsets, and of a position channel's raw value.
pub(crate) fn units(clip: &Clip<'_>) -> (i32, i32) {
    let rig = clip.rig();
    let largest = rig.joints().flat_map(|joint| joint.offset).fold(0, |largest, x| largest | x.unsigned_abs());
    let down = 18 - largest.leading_zeros() as i32;
    (down, i32::from(rig.length_exponent()) + down - i32::from(clip.length_exponent()))
}

impl<'a> Bone<'a> {
    /// The bone of the joint of an index; `down` is the offsets' shift to figure units.
    pub(crate) fn of(joint: &pantin::Joint<'a>, index: usize, groups: &[Group], down: i32) -> Bone<'a> {
        let mut bone = Bone {
            offset: joint.offset.map(|raw| shifted(raw, down)),
            place: [None; 3],
            first: 0,
            len: 0,
            shape: Shape::Free,
            kinds: joint.kinds,
            axes: [0; 3],
        };
        for (kind, channel) in joint.kinds.zip(joint.first_channel..) {
            let axis = kind.axis().unwrap_or(0);
            if kind.is_position() {
                if let Some(place) = bone.place.get_mut(axis) {
                    *place = Some(channel);
                }
                continue;
            }
            if bone.len == 0 {
                bone.first = channel;
                let own = groups.iter().find(|group| usize::from(group.bit) == index && group.first == channel);
                bone.shape = own.map_or(Shape::Free, |group| group.shape);
            }
            if let Some(own) = bone.axes.get_mut(usize::from(bone.len)) {
                *own = axis as u8;
            }
            bone.len += 1;
        }
        bone
    }
}

impl Bone<'_> {
    /// The channel of its place along an axis.
    pub(crate) fn position(&self, axis: usize) -> Option<u16> {
        self.place.get(axis).copied().flatten()
    }

    /// The joint that hangs on another.
    pub(crate) fn after(&self, parent: &Joint, pose: &[i32], shift: i32) -> Joint {
        let mut joint = Joint { place: self.place_in(parent, pose, shift), rotation: parent.rotation };
        self.turn(&mut joint.rotation, pose);
        joint
    }

    pub(crate) fn place_in(&self, parent: &Joint, pose: &[i32], shift: i32) -> Vector {
        let mut offset = self.offset;
        for (own, channel) in offset.iter_mut().zip(self.place) {
            if let Some(channel) = channel {
                *own = shifted(pose.get(usize::from(channel)).copied().unwrap_or(0), shift);
            }
        }
        add(parent.place, parent.rotation.apply_any(offset))
    }

    /// Whether it has fewer than three angles.
    pub(crate) fn is_hinge(&self) -> bool {
        self.shape == Shape::Free && self.len < 3
    }

    fn own<'p>(&self, pose: &'p [i32]) -> &'p [i32] {
        let first = usize::from(self.first);
        pose.get(first..first + usize::from(self.len)).unwrap_or_default()
    }

    /// Turns a rotation by the joint's channels.
    pub(crate) fn turn(&self, rotation: &mut Rotation, pose: &[i32]) {
        let own = self.own(pose);
        match self.shape {
            Shape::Map => {
                if let Some(pantin::Turn::Exponential(map)) = math::turn_of(self.shape, self.kinds, own) {
                    *rotation = rotation.then(&Rotation::of_exponential(map.map(Angle::to_bits)));
                }
            }
            Shape::Quaternion => {
                if let Some(pantin::Turn::Quaternion(q)) = math::turn_of(self.shape, self.kinds, own) {
                    *rotation = rotation.then(&Rotation::of_quaternion(q.map(Component::to_bits)));
                }
            }
            _ => {
                for (angle, axis) in own.iter().zip(self.axes) {
                    rotation.turn(axis.into(), *angle);
                }
            }
        }
    }

    /// Writes the rotation `world` of this joint, whose parent is turned by `parent`, into its channels. A joint with fewer than three angles
    /// takes those that it has.
    #[inline(never)]
    pub(crate) fn write(&self, parent: &Rotation, world: &Rotation, pose: &mut [i32]) {
        let local = transposed(parent).then(world);
        let first = usize::from(self.first);
        let Some(own) = pose.get_mut(first..first + usize::from(self.len)) else { return };
        match self.shape {
            Shape::Map | Shape::Quaternion => math::write(self.shape, self.kinds, local.quaternion(), own),
            _ => {
                let [first, second, third] = self.axes.map(usize::from);
                let axes = match self.len {
                    0 => return,
                    1 => [first, (first + 1) % 3, (first + 2) % 3],
                    2 => [first, second, (6 - first - second) % 3],
                    _ => [first, second, third],
                };
                let angles = local.euler(axes);
                // The triple that is nearest to what stood there.
                let mut near = angles;
                if let (Some(was), true) = (own.get(..3), self.shape == Shape::Euler) {
                    crate::groups::nearest(Shape::Euler, &mut near, was);
                }
                for (own, angle) in own.iter_mut().zip(near) {
                    *own = angle;
                }
            }
        }
    }
}

/// `value` / 2^`shift`, cut off at the range.
pub(crate) fn shifted(value: i32, shift: i32) -> i32 {
    if shift >= 0 {
        value >> shift.min(31)
    } else {
        (i64::from(value) << shift.unsigned_abs().min(31)).clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32
    }
}
