//! The figure's joints, set up once from the rig in the form that forward kinematics reads frame by frame.

use crate::body::{Limb, Limbs, length};
use crate::names::{contains, is_left_of};
use crate::rotation::{Vector, shift_right};
use crate::{Error, RIG_JOINTS};
use heapless::Vec;
use pantin::{Joint, Kind, Rig};

/// One channel, or group of channels, at work on a joint. Numbers are indices into a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Takes the place of the offset's x, y, z, where it is not [`NONE`].
    Offset([u16; 3]),
    /// Turns about an axis.
    Turn {
        /// 0, 1, 2 for x, y, z.
        axis: u8,
        /// The angle's channel.
        channel: u16,
    },
    /// Turns by an exponential map x, y, z.
    Exponential([u16; 3]),
    /// Turns by a quaternion w, x, y, z.
    Quaternion([u16; 4]),
}

/// What a joint is for the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The end of a bone from its parent.
    Bone,
    /// Where the figure stands, or a joint in the same place as its parent: no line leads to it.
    Hidden,
    /// The top of the head.
    Crown,
}

/// One joint of the skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Bone {
    /// Index of the parent in the skeleton, smaller than the joint's own; `None` for the root.
    pub parent: Option<u8>,
    /// Where it stands in its parent, in figure units.
    pub offset: Vector,
    /// What it is for the picture.
    pub part: Part,
    /// A joint that has a foot's name.
    pub foot: bool,
    /// Number of entries of [`Skeleton::drives`] that are this joint's; they follow those of the joint before.
    pub drives: u8,
    /// Whether it has position channels.
    pub moves: bool,
    /// Whether another joint hangs on it, so that its rotation matters.
    pub bears: bool,
}

/// The joints of a figure, at most `N`, and the channels that drive them.
///
/// Lengths are in figure units: the power of two of the source's unit in which the longest component of a bone lies within
/// 2^13 .. 2^14. A person is some 2^16 high.
#[derive(Clone, Debug)]
pub struct Skeleton<const N: usize> {
    /// Parents before children.
    pub bones: Vec<Bone, N>,
    /// The channels at work, joint by joint, in the order in which they apply; in fours, the last padded.
    drives: Vec<[Drive; DRIVES], N>,
    /// How many they are.
    driven: usize,
    /// Right shift that brings a position channel's value to figure units.
    pub position_shift: i32,
    /// One figure unit is 2^exponent source units.
    pub exponent: i32,
    /// Rough height of the figure.
    pub size: i32,
    /// The joint that the camera follows: the hips of a person.
    pub hips: usize,
    /// A joint of the left side and its counterpart: across them the figure faces forward.
    pub sides: Option<[u8; 2]>,
    /// Radius of the head.
    pub head_radius: i32,
}

/// In place of a channel: there is none.
pub const NONE: u16 = u16::MAX;

/// Room for drives, a joint: an offset and three turns. Joints with fewer leave room for others.
const DRIVES: usize = 4;

/// How much of the rig is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Every joint and End Site, at its index in the rig.
    Full,
    /// What makes a clear picture: no fingers, face or bones too short to see; a head always has a crown.
    Body,
}

impl<const N: usize> Skeleton<N> {
    /// Sets up a rig's figure. `pose` is any pose of the clip, `position_exponent` its step of positions (2^e source units),
    /// and `is_exponential` tells of a joint whether the clip codes its Euler angles as an exponential map.
    #[inline(never)]
    pub fn new(
        rig: &Rig,
        detail: Detail,
        pose: &[i32],
        position_exponent: i8,
        is_exponential: impl Fn(usize) -> bool,
    ) -> Result<Self, Error> {
        let mut limbs = Limbs::new(rig, pose, position_exponent)?;
        match detail {
            Detail::Body => limbs.prune(),
            Detail::Full => limbs.settle(0),
        }
        let mut skeleton = Skeleton {
            bones: Vec::new(),
            drives: Vec::new(),
            driven: 0,
            position_shift: limbs.exponent - i32::from(position_exponent),
            exponent: limbs.exponent,
            size: limbs.size,
            hips: limbs.hips,
            sides: None,
            head_radius: 0,
        };
        let mut kept: Vec<u8, RIG_JOINTS> = Vec::new();
        for ((index, joint), limb) in rig.joints().enumerate().zip(&limbs.limbs) {
            let _ = kept.push(skeleton.bones.len() as u8);
            if !limb.kept {
                continue;
            }
            let parent = kept.get(usize::from(limb.parent)).copied();
            let turns = limb.bears || limb.head;
            let drives = skeleton.drive(&joint, turns, is_exponential(index))?;
            let part = if limb.placement || limb.length == 0 { Part::Hidden } else { Part::Bone };
            let foot = contains(joint.name(), "foot") || contains(joint.name(), "ankle");
            let moves = { joint.kinds }.any(|kind| kind.is_position());
            let offset = match limb.placement {
                true => joint.offset.map(|raw| skeleton.figure_units(raw, rig.length_exponent())),
                false => limb.bone.map(i32::from),
            };
            skeleton.push(Bone { parent, offset, part, foot, drives, moves, bears: limb.bears })?;
            if limb.head && detail == Detail::Body {
                let parent = Some(skeleton.bones.len() as u8 - 1);
                let offset = crown(&limbs, index, limb);
                skeleton.head_radius = (length(offset) / 2).clamp(limbs.size / 22, limbs.size / 14);
                skeleton.push(Bone { parent, offset, part: Part::Crown, foot: false, drives: 0, moves: false, bears: false })?;
            }
        }
        skeleton.sides = sides(rig, &limbs).map(|pair| pair.map(|index| kept.get(index).copied().unwrap_or(0)));
        Ok(skeleton)
    }

    fn push(&mut self, bone: Bone) -> Result<(), Error> {
        if let Some(parent) = bone.parent.and_then(|parent| self.bones.get_mut(usize::from(parent))) {
            parent.bears = true;
        }
        self.bones.push(bone).map_err(|_| Error::TooManyJoints { most: N })
    }

    /// Adds what drives a joint, and counts it. What turns one that nothing hangs on is left out.
    fn drive(&mut self, joint: &Joint, turns: bool, exponential: bool) -> Result<u8, Error> {
        let before = self.driven;
        let (mut moved, mut grouped) = (false, !turns);
        for (kind, channel) in joint.kinds.zip(joint.first_channel..) {
            let axis = kind.axis().unwrap_or(0) as u8;
            let drive = match kind {
                Kind::Scalar => continue,
                _ if kind.is_position() && moved => continue,
                _ if kind.is_position() => {
                    moved = true;
                    Drive::Offset([Kind::Xposition, Kind::Yposition, Kind::Zposition].map(|kind| channel_of(joint, kind)))
                }
                _ if kind.is_rotation() && !exponential && turns => Drive::Turn { axis, channel },
                // The rest work as a group, in the place of its first channel.
                _ if grouped => continue,
                _ => {
                    grouped = true;
                    group(joint, kind)
                }
            };
            self.push_drive(drive)?;
        }
        Ok((self.driven - before) as u8)
    }

    fn push_drive(&mut self, drive: Drive) -> Result<(), Error> {
        let full = Error::TooManyChannels { most: DRIVES * N };
        if self.driven.is_multiple_of(DRIVES) {
            self.drives.push([drive; DRIVES]).map_err(|_| full)?;
        }
        *self.drives.as_flattened_mut().get_mut(self.driven).ok_or(full)? = drive;
        self.driven += 1;
        Ok(())
    }

    /// What drives the joints, all in one row.
    pub fn drives(&self) -> &[Drive] {
        self.drives.as_flattened()
    }

    /// The figure units of a length in the rig's or a clip's steps of 2^`exponent` source units.
    pub fn figure_units(&self, raw: i32, exponent: i8) -> i32 {
        shift_right(raw, self.exponent - i32::from(exponent))
    }
}

/// The first two joints, left and right, that are named as counterparts and whose bones are not the same.
fn sides(rig: &Rig, limbs: &Limbs) -> Option<[usize; 2]> {
    let joints = || rig.joints().zip(&limbs.limbs).enumerate().filter(|(_, (_, limb))| limb.kept);
    joints().find_map(|(index, (joint, limb))| {
        let mut apart = joints().filter(|(other, (_, other_limb))| *other > index && other_limb.bone != limb.bone);
        apart.find_map(|(other, (counterpart, _))| {
            let left = is_left_of(joint.name(), counterpart.name())?;
            Some(if left { [index, other] } else { [other, index] })
        })
    })
}

/// A joint's channel of a kind.
fn channel_of(joint: &Joint, wanted: Kind) -> u16 {
    let mut channels = joint.kinds.zip(joint.first_channel..);
    channels.find(|(kind, _)| *kind == wanted).map_or(NONE, |(_, channel)| channel)
}

/// A joint's quaternion or exponential map. Where a clip codes Euler angles as one, their slots hold x, y, z in turn.
fn group(joint: &Joint, kind: Kind) -> Drive {
    let channel_of = |kind| channel_of(joint, kind);
    if kind.is_quaternion() {
        Drive::Quaternion([Kind::Wquaternion, Kind::Xquaternion, Kind::Yquaternion, Kind::Zquaternion].map(channel_of))
    } else if kind.is_exponential() {
        Drive::Exponential([Kind::Xexponential, Kind::Yexponential, Kind::Zexponential].map(channel_of))
    } else {
        let mut slots = joint.kinds.zip(joint.first_channel..).filter(|(kind, _)| kind.is_rotation());
        Drive::Exponential([(); 3].map(|()| slots.next().map_or(NONE, |(_, channel)| channel)))
    }
}

/// The crown in the head's own frame: its End Site, or, if that is not worth the name, as much again in the direction of the
/// bone that leads to the head, a tenth of the figure.
fn crown(limbs: &Limbs, index: usize, head: &Limb) -> Vector {
    let tenth = limbs.size / 10;
    let own = limbs.limbs.iter().find(|limb| limb.end_site && usize::from(limb.parent) == index && limb.length > tenth / 3);
    match own {
        Some(end) => end.bone.map(i32::from),
        None => head.bone.map(|x| i32::from(x) * 64 / (head.length / 64).max(1) * (tenth / 64) / 64),
    }
}
