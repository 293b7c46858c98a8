//! The figure's joints, set up once from the rig in the form that forward kinematics reads frame by frame.

use crate::ink::BodyPart;
use crate::joint_info::{JointInfo, JointTable, flag, length};
use crate::names::is_left_of;
use crate::rotation::{Vector, shift_right};
use crate::{Error, RIG_JOINTS};
use heapless::Vec;
use pantin::{Form, Joint, Kind, Pose, Rig, Up};

/// One channel, or group of channels, at work on a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drive {
    /// The group's channel that comes first in a pose.
    first: u16,
    /// What it does in the lowest three bits; above them, for a group, how far behind the first each member is, in three
    /// bits: w, x, y, z of a quaternion, x, y, z of an offset or an exponential map. [`ABSENT`] where there is none.
    what: u16,
}

/// What a [`Drive`] does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Act {
    /// Turns about an axis: 0, 1, 2 for x, y, z.
    Turn(usize),
    /// Takes the place of the offset's components.
    Offset,
    /// Turns by an exponential map.
    Exponential,
    /// Turns by a quaternion.
    Quaternion,
}

const ABSENT: u16 = 7;

impl Drive {
    const NOTHING: Drive = Drive { first: 0, what: 6 };

    /// Of one channel.
    fn turn(axis: u16, channel: u16) -> Drive {
        Drive { first: channel, what: axis }
    }

    /// Of a group of up to four; `None` if its members are farther apart than there is room for.
    fn group(act: u16, members: &[Option<u16>]) -> Option<Drive> {
        let first = members.iter().flatten().copied().min().unwrap_or(0);
        let mut what = act;
        for (index, member) in members.iter().enumerate() {
            let behind = member.map_or(ABSENT, |channel| channel - first);
            if member.is_some() && behind >= ABSENT {
                return None;
            }
            what |= behind << (3 + 3 * index);
        }
        Some(Drive { first, what })
    }

    /// What it does.
    #[inline(always)]
    pub fn act(self) -> Act {
        match self.what & 7 {
            axis @ 0..3 => Act::Turn(usize::from(axis)),
            3 => Act::Offset,
            4 => Act::Exponential,
            _ => Act::Quaternion,
        }
    }

    /// The channel that turns.
    #[inline(always)]
    pub fn channel(self) -> usize {
        usize::from(self.first)
    }

    /// The channel of a group's member, counted from 0.
    #[inline(always)]
    pub fn member(self, index: usize) -> Option<usize> {
        let behind = (self.what >> (3 + 3 * index)) & 7;
        (behind != ABSENT).then_some(usize::from(self.first + behind))
    }
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
    /// Where it stands in its parent, in figure units; of a placement, see [`Skeleton::places`].
    pub offset: [i16; 3],
    /// Index of the parent in the skeleton, smaller than the joint's own; `None` for the root.
    pub parent: Option<u8>,
    /// Its index in the rig; a crown has that of its head.
    pub joint: u8,
    /// What it is for the picture.
    pub part: Part,
    /// Which side's.
    pub body_part: BodyPart,
    /// Number of entries of [`Skeleton::drives`] that are this joint's; they follow those of the joint before.
    pub drives: u8,
    /// Where its rotation is kept while joints that hang on it wait; [`NOWHERE`] if none does.
    pub slot: u8,
    /// Where its parent's is; [`NOWHERE`] for the root's.
    pub parent_slot: u8,
    /// Whether it has position channels.
    pub moves: bool,
}

/// In place of a slot.
pub const NOWHERE: u8 = u8::MAX;

/// Rotations that wait at a time: 2^k joints or more are needed to keep k waiting.
pub const SLOTS: usize = 9;

/// The joints of a figure, at most `N`, and the channels that drive them.
///
/// Lengths are in figure units: the power of two of the source's unit in which the longest component of a bone lies within
/// 2^13 .. 2^14. A person is some 2^16 high.
#[derive(Clone, Debug)]
pub struct Skeleton<const N: usize> {
    /// The form of the poses that it takes.
    form: Form,
    /// Parents before children, in an order in which few rotations wait at a time.
    pub bones: Vec<Bone, N>,
    /// The channels at work, joint by joint, in the order in which they apply; in fours, the last padded.
    drives: Vec<[Drive; DRIVES], N>,
    /// How many they are.
    driven: usize,
    /// Where the joints that only place the figure stand in their parents: at most the first two.
    pub places: [Vector; PLACES],
    /// Right shift that brings a position channel's value to figure units.
    pub position_shift: i32,
    /// One figure unit is 2^exponent source units.
    pub exponent: i32,
    /// Rough height of the figure.
    pub size: i32,
    /// The joint that the camera follows: the hips of a person.
    pub hips: usize,
    /// The direction of the world that is vertical.
    pub up: Up,
    /// A joint of the left side and its counterpart: across them the figure faces forward.
    pub sides: Option<[u8; 2]>,
    /// Radius of the head.
    pub head_radius: i32,
}

/// Joints that may place a figure.
pub const PLACES: usize = 2;

/// Room for drives, a joint: an offset and three turns. Joints with fewer leave room for others.
const DRIVES: usize = 4;

/// How much of the rig is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Detail {
    /// Every joint and End Site, at its index in the rig.
    Full,
    /// What makes a clear picture: no fingers, face or bones too short to see; a head always has a crown.
    Body,
}

impl<const N: usize> Skeleton<N> {
    /// No joints.
    #[inline(always)]
    pub const fn empty() -> Self {
        Skeleton {
            form: Form::NONE,
            bones: Vec::new(),
            drives: Vec::new(),
            driven: 0,
            places: [[0; 3]; PLACES],
            position_shift: 0,
            exponent: 0,
            size: 1,
            hips: 0,
            up: Up::Y,
            sides: None,
            head_radius: 0,
        }
    }

    /// The form of the poses that it takes.
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// The skeleton of a rig of up to 192 joints, for poses of the form of `pose`, which is any pose of the clip.
    pub fn new(rig: &Rig, detail: Detail, pose: Pose<'_>) -> Result<Self, Error> {
        let mut skeleton = Skeleton::empty();
        skeleton.set_up(rig, detail, pose, &mut [JointInfo::default(); RIG_JOINTS])?;
        Ok(skeleton)
    }

    /// [`Skeleton::new`] in place. `scratch` needs an element for each joint of the rig, End Sites included.
    #[inline(never)]
    pub fn set_up(&mut self, rig: &Rig, detail: Detail, pose: Pose<'_>, scratch: &mut [JointInfo]) -> Result<(), Error> {
        let position_exponent = pose.form.length_exponent();
        let mut table = JointTable::new(rig, pose.values, position_exponent, scratch)?;
        copy(&pose.form.to_form(), &mut self.form);
        match detail {
            Detail::Body => table.prune(),
            Detail::Full => table.settle(0),
        }
        self.clear(&table, table.exponent - i32::from(position_exponent));
        self.up = rig.up();
        let mut before = None;
        while let Some(index) = table.after(before) {
            self.add(rig, detail, &mut table, index, pose.form.is_exponential(rig, index))?;
            before = Some(index);
        }
        self.hips = table.table.get(self.hips).map_or(0, |hips| usize::from(hips.link));
        self.find_sides(rig, &table);
        self.keep_rotations();
        Ok(())
    }

    fn clear(&mut self, table: &JointTable, position_shift: i32) {
        self.bones.clear();
        self.drives.clear();
        self.driven = 0;
        self.position_shift = position_shift;
        self.exponent = table.exponent;
        self.size = table.size;
        self.hips = table.hips;
        self.head_radius = 0;
    }

    /// Adds a joint of the rig.
    fn add(&mut self, rig: &Rig, detail: Detail, table: &mut JointTable, index: usize, exponential: bool) -> Result<(), Error> {
        let (Some(joint), Some(&info)) = (rig.joint(index), table.table.get(index)) else { return Ok(()) };
        let (placement, head) = (info.is(flag::PLACEMENT), info.is(flag::HEAD));
        let parent = table.table.get(usize::from(info.parent)).map(|parent| parent.link);
        let drives = self.drive(&joint, info.is(flag::BEARS) || head, exponential)?;
        if placement && let Some(place) = self.places.get_mut(index) {
            *place = joint.offset.map(|raw| shift_right(raw, table.exponent - i32::from(rig.length_exponent())));
        }
        let bone = Bone {
            offset: info.bone,
            parent,
            joint: index as u8,
            part: if placement || info.length == 0 { Part::Hidden } else { Part::Bone },
            body_part: BodyPart::Middle,
            drives,
            slot: NOWHERE,
            parent_slot: NOWHERE,
            moves: { joint.kinds }.any(|kind| kind.is_position()),
        };
        let at = self.push(bone)?;
        if let Some(info) = table.table.get_mut(index) {
            info.link = at;
        }
        if head && detail == Detail::Body {
            let offset = crown(table, index, &info);
            self.head_radius = (length(offset.map(i32::from)) / 2).max(table.size / 22).min(table.size / 14);
            self.push(Bone { offset, parent: Some(at), part: Part::Crown, drives: 0, moves: false, ..bone })?;
        }
        Ok(())
    }

    fn push(&mut self, bone: Bone) -> Result<u8, Error> {
        self.bones.push(bone).map_err(|_| Error::TooManyJoints { needed: N + 1, given: N })?;
        Ok(self.bones.len() as u8 - 1)
    }

    /// Adds what drives a joint, and counts it. What turns one that nothing hangs on is left out.
    fn drive(&mut self, joint: &Joint, turns: bool, exponential: bool) -> Result<u8, Error> {
        use Kind::*;
        let before = self.driven;
        let mut moved = false;
        // The first channels of `count` consecutive kinds.
        let of = |first: Kind, count: usize, act| {
            let mut members = [None; 4];
            for (kind, channel) in joint.kinds.zip(joint.first_channel..) {
                if let Some(member @ None) = members.get_mut((kind as usize).wrapping_sub(first as usize)) {
                    *member = Some(channel);
                }
            }
            Drive::group(act, members.get(..count).unwrap_or(&[]))
        };
        // What works as a group turns after all Euler angles: the map in their place, the quaternion, the joint's own map (FORMAT.md 11).
        let [mut coded, mut quaternion, mut map] = [false; 3];
        for (kind, channel) in joint.kinds.zip(joint.first_channel..) {
            let drive = match kind {
                _ if kind.is_position() && moved => continue,
                _ if kind.is_position() => {
                    moved = true;
                    of(Xposition, 3, 3)
                }
                _ if kind.is_rotation() && !exponential && turns => Some(Drive::turn(kind.axis().unwrap_or(0) as u16, channel)),
                _ => {
                    coded |= kind.is_rotation();
                    quaternion |= kind.is_quaternion();
                    map |= kind.is_exponential();
                    continue;
                }
            };
            self.push_drive(drive)?;
        }
        if coded && turns {
            self.push_drive(angles(joint))?;
        }
        if quaternion && turns {
            self.push_drive(of(Wquaternion, 4, 5))?;
        }
        if map && turns {
            self.push_drive(of(Xexponential, 3, 4))?;
        }
        Ok((self.driven - before) as u8)
    }

    fn push_drive(&mut self, drive: Option<Drive>) -> Result<(), Error> {
        let full = Error::TooManyChannels { needed: DRIVES * N + 1, given: DRIVES * N };
        if self.driven.is_multiple_of(DRIVES) {
            self.drives.push([Drive::NOTHING; DRIVES]).map_err(|_| full)?;
        }
        *self.drives.as_flattened_mut().get_mut(self.driven).ok_or(full)? = drive.ok_or(full)?;
        self.driven += 1;
        Ok(())
    }

    /// What drives the joints, all in one row.
    pub fn drives(&self) -> &[Drive] {
        self.drives.as_flattened()
    }

    /// Which bones are of which side: by joints whose names are counterparts, and all that hangs on them. The first pair whose
    /// bones differ tells where the figure faces.
    fn find_sides(&mut self, rig: &Rig, table: &JointTable) {
        let mut best = usize::MAX;
        self.sides = None;
        for at in 0..self.bones.len() {
            let Some(&bone) = self.bones.get(at) else { return };
            let above = bone
                .parent
                .and_then(|parent| self.bones.get(usize::from(parent)))
                .map_or(BodyPart::Middle, |bone| bone.body_part);
            let mut body_part = above;
            let joint = usize::from(bone.joint);
            if let Some((left, other)) = counterpart(rig, table, joint)
                && let (Some(own), Some(theirs)) = (table.table.get(joint), table.table.get(other))
            {
                body_part = if left { BodyPart::Left } else { BodyPart::Right };
                // Indices are below 2^8.
                let pair = joint.min(other) << 8 | joint.max(other);
                if own.bone != theirs.bone && pair < best {
                    best = pair;
                    self.sides = Some(if left { [own.link, theirs.link] } else { [theirs.link, own.link] });
                }
            }
            if let Some(bone) = self.bones.get_mut(at) {
                bone.body_part = body_part;
            }
        }
    }

    /// Gives every joint that others hang on a place for its rotation until the last of those has been placed.
    fn keep_rotations(&mut self) {
        // A bit a place; there is always a free one: the order sees to it. The shift takes NOWHERE for 31, which is none.
        let mut used = 0u32;
        for at in 0..self.bones.len() {
            let Some(parent) = self.bones.get(at).map(|bone| bone.parent) else { return };
            let parent_slot = parent.and_then(|parent| self.bones.get(usize::from(parent))).map_or(NOWHERE, |bone| bone.slot);
            let (mut last, mut bears) = (parent.is_some(), false);
            for bone in self.bones.get(at + 1..).unwrap_or(&[]) {
                last &= bone.parent != parent;
                bears |= bone.parent == Some(at as u8);
            }
            if last {
                used &= !1u32.wrapping_shl(parent_slot.into());
            }
            let mut slot = NOWHERE;
            if bears {
                slot = (0..SLOTS as u8).find(|slot| used >> slot & 1 == 0).unwrap_or(NOWHERE);
                used |= 1u32.wrapping_shl(slot.into());
            }
            if let Some(bone) = self.bones.get_mut(at) {
                (bone.slot, bone.parent_slot) = (slot, parent_slot);
            }
        }
    }
}

/// The kept joint whose name is the counterpart of a joint's, and whether the joint is the left one of them.
fn counterpart(rig: &Rig, table: &JointTable, index: usize) -> Option<(bool, usize)> {
    let own = rig.joint(index)?;
    let mut others =
        rig.joints().zip(table.table.iter()).enumerate().filter(|(other, (_, info))| *other != index && info.is(flag::KEPT));
    others.find_map(|(other, (joint, _))| Some((is_left_of(own.name_bytes(), joint.name_bytes())?, other)))
}

/// Euler angles that a clip codes as an exponential map: their slots hold x, y, z in turn.
fn angles(joint: &Joint) -> Option<Drive> {
    let mut slots = joint.kinds.zip(joint.first_channel..).filter(|(kind, _)| kind.is_rotation());
    Drive::group(4, &[(); 3].map(|()| slots.next().map(|(_, channel)| channel)))
}

/// The crown in the head's own frame: its End Site, or, if that is not worth the name, as much again in the direction of the
/// bone that leads to the head, a tenth of the figure.
fn crown(table: &JointTable, index: usize, head: &JointInfo) -> [i16; 3] {
    let tenth = table.size / 10;
    let worth =
        |info: &&JointInfo| info.is(flag::END_SITE) && usize::from(info.parent) == index && i32::from(info.length) > tenth / 3;
    match table.table.iter().find(worth) {
        Some(end) => end.bone,
        None => head.bone.map(|x| (i32::from(x) * 64 / (i32::from(head.length) / 64).max(1) * (tenth / 64) / 64) as i16),
    }
}

/// Copies a form. In a function of its own the compiler knows that the two do not overlap, and does not link `memmove` for it: 1.6 KB.
#[inline(never)]
fn copy(from: &Form, to: &mut Form) {
    *to = *from;
}
