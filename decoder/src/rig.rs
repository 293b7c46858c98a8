//! The rig: joints, their parents and offsets, and what each channel of a pose means.
//!
//! A rig's bytes depend on nothing but the figure, so that many clips may share one by its [`Rig::id`].

use crate::bytes::Bytes;
use crate::layout::{LISTED, MAX_CHANNELS, MAX_JOINTS};
use crate::{OpenError, crc, names};

/// What one channel of a joint drives. A joint applies its channels in the order of its list, as BVH does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Replaces the x of the joint's offset.
    Xposition,
    /// Replaces the y of the joint's offset.
    Yposition,
    /// Replaces the z of the joint's offset.
    Zposition,
    /// Turns about the joint's x axis.
    Xrotation,
    /// Turns about the joint's y axis.
    Yrotation,
    /// Turns about the joint's z axis.
    Zrotation,
    /// Component w (the real part) of a rotation given as a quaternion, which the figure normalizes.
    Wquaternion,
    /// Component x of a quaternion.
    Xquaternion,
    /// Component y of a quaternion.
    Yquaternion,
    /// Component z of a quaternion.
    Zquaternion,
    /// Component x of a rotation given as an exponential map (axis times angle).
    Xexponential,
    /// Component y of an exponential map.
    Yexponential,
    /// Component z of an exponential map.
    Zexponential,
    /// A number that moves no joint: a morph weight, a servo, a light.
    Scalar,
}

impl Kind {
    /// Every kind, at the index that stands for it in a rig's bytes.
    pub const ALL: [Kind; 14] = [
        Kind::Xposition,
        Kind::Yposition,
        Kind::Zposition,
        Kind::Xrotation,
        Kind::Yrotation,
        Kind::Zrotation,
        Kind::Wquaternion,
        Kind::Xquaternion,
        Kind::Yquaternion,
        Kind::Zquaternion,
        Kind::Xexponential,
        Kind::Yexponential,
        Kind::Zexponential,
        Kind::Scalar,
    ];

    /// A translation along an axis of the parent.
    pub const fn is_position(self) -> bool {
        matches!(self, Kind::Xposition | Kind::Yposition | Kind::Zposition)
    }

    /// An Euler angle about one axis.
    pub const fn is_rotation(self) -> bool {
        matches!(self, Kind::Xrotation | Kind::Yrotation | Kind::Zrotation)
    }

    /// A component of a quaternion.
    pub const fn is_quaternion(self) -> bool {
        matches!(self, Kind::Wquaternion | Kind::Xquaternion | Kind::Yquaternion | Kind::Zquaternion)
    }

    /// A component of an exponential map.
    pub const fn is_exponential(self) -> bool {
        matches!(self, Kind::Xexponential | Kind::Yexponential | Kind::Zexponential)
    }

    /// The axis of a position, rotation, exponential map or of a quaternion's imaginary part: 0, 1, 2 for x, y, z.
    pub const fn axis(self) -> Option<usize> {
        match self {
            Kind::Xposition | Kind::Xrotation | Kind::Xquaternion | Kind::Xexponential => Some(0),
            Kind::Yposition | Kind::Yrotation | Kind::Yquaternion | Kind::Yexponential => Some(1),
            Kind::Zposition | Kind::Zrotation | Kind::Zquaternion | Kind::Zexponential => Some(2),
            Kind::Wquaternion | Kind::Scalar => None,
        }
    }

    pub(crate) fn from_code(code: u8) -> Result<Kind, OpenError> {
        Kind::ALL.get(usize::from(code)).copied().ok_or(OpenError::Malformed)
    }
}

/// The channels of one joint, in the order in which they apply: two to a byte, low half first.
#[derive(Clone, Copy, Debug)]
pub struct Kinds<'a> {
    halves: &'a [u8],
    next: u8,
    len: u8,
}

impl Iterator for Kinds<'_> {
    type Item = Kind;

    fn next(&mut self) -> Option<Kind> {
        if self.next >= self.len {
            return None;
        }
        let byte = *self.halves.get(usize::from(self.next / 2))?;
        let code = if self.next.is_multiple_of(2) { byte & 0xf } else { byte >> 4 };
        self.next += 1;
        Kind::from_code(code).ok()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::from(self.len - self.next);
        (left, Some(left))
    }
}

impl ExactSizeIterator for Kinds<'_> {}

/// One joint, or an End Site (a joint without channels that only gives a bone its length).
#[derive(Clone, Copy, Debug)]
pub struct Joint<'a> {
    name: &'a [u8],
    /// Index of the parent, always smaller than the joint's own; `None` for the root.
    pub parent: Option<u16>,
    /// Where it stands in its parent, in steps of [`Rig::length_exponent`].
    pub offset: [i32; 3],
    /// Whether this is an End Site.
    pub end_site: bool,
    /// Index of its first channel in a pose.
    pub first_channel: u16,
    /// Its channels.
    pub kinds: Kinds<'a>,
}

impl<'a> Joint<'a> {
    /// Its name; empty for an End Site, and for a name that is not UTF-8 (opening a rig does not look into names).
    pub fn name(&self) -> &'a str {
        core::str::from_utf8(self.name).unwrap_or("")
    }

    /// Its name's bytes as they stand.
    pub fn name_bytes(&self) -> &'a [u8] {
        self.name
    }
}

/// In place of the index of a name in a list: the rig has the name's bytes.
const SPELLED: u8 = 255;

/// One channel that moves no joint.
#[derive(Clone, Copy, Debug)]
pub struct Scalar<'a> {
    name: &'a [u8],
    /// Its name's index in the list, where it has no bytes.
    listed: u8,
    /// A pose's value times 2^(exponent - 31) is the scalar: it lies within -2^exponent .. 2^exponent.
    pub exponent: i8,
}

impl<'a> Scalar<'a> {
    /// Its name; empty for one that is not UTF-8, or that no list has.
    pub fn name(&self) -> &'a str {
        let bytes = if self.listed == SPELLED { self.name } else { names::nth(names::LIVE_LINK, self.listed) };
        core::str::from_utf8(bytes).unwrap_or("")
    }

    /// [`names::hash`] of its name's bytes; of none for one that no list has.
    pub fn name_hash(&self) -> u32 {
        if self.listed == SPELLED {
            return names::hash(self.name);
        }
        names::HASHES.get(usize::from(self.listed)).copied().unwrap_or(names::HASH_OF_NOTHING)
    }
}

/// A checked rig.
#[derive(Clone, Copy, Debug)]
pub struct Rig<'a> {
    /// All bytes but the CRC.
    body: &'a [u8],
    /// Where the joints begin in them: 12 at most.
    joints_at: u8,
    joints: u16,
    scalars: u16,
    joint_channels: u16,
    cm_per_unit: u32,
    length_exponent: i8,
}

impl<'a> Rig<'a> {
    /// Checks `bytes`, all of them one rig with its CRC.
    #[inline(never)]
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, OpenError> {
        let (body, stored) = bytes.split_last_chunk::<2>().ok_or(OpenError::Truncated)?;
        if crc::of(body) != u16::from_le_bytes(*stored) {
            return Err(OpenError::BadCrc);
        }
        let mut reader = Bytes(body);
        let cm_per_unit = reader.varint()?;
        let length_exponent = reader.byte()? as i8;
        let joints = reader.varint()?;
        let scalars = reader.varint()?;
        if cm_per_unit == 0 || !(-31..=31).contains(&length_exponent) {
            return Err(OpenError::Malformed);
        }
        if joints > MAX_JOINTS as u32 || scalars > MAX_CHANNELS as u32 {
            return Err(OpenError::Malformed);
        }
        let mut rig = Rig {
            body,
            joints_at: (body.len() - reader.0.len()) as u8,
            joints: joints as u16,
            scalars: scalars as u16,
            joint_channels: 0,
            cm_per_unit,
            length_exponent,
        };
        let mut walk = rig.joints();
        for index in 0..rig.joints {
            let mut kinds = Kinds { halves: &[], next: 0, len: 0 };
            let (_, parent, _) = walk.fields(&mut kinds, &mut [0; 3])?;
            let len = usize::from(kinds.len);
            // A kind that is none ends the walk early; a scalar belongs to no joint.
            let known = kinds.take_while(|&kind| kind != Kind::Scalar).count() == len;
            if parent.map_or(index != 0, |parent| parent >= index) || !known {
                return Err(OpenError::Malformed);
            }
        }
        rig.joint_channels = walk.first_channel;
        let mut walk = Scalars::new(walk.bytes, rig.scalars);
        for _ in 0..rig.scalars {
            walk.parse()?;
        }
        if !walk.bytes.0.is_empty() || rig.channels() > MAX_CHANNELS {
            return Err(OpenError::Malformed);
        }
        Ok(rig)
    }

    /// Names the rig in clips that do not carry it.
    pub fn id(&self) -> u32 {
        self.body.iter().fold(Id::default(), |id, &byte| id.and(byte)).0
    }

    /// Joints, End Sites included. The root comes first, and every parent before its children.
    #[inline(never)]
    pub fn joints(&self) -> Joints<'a> {
        Joints { bytes: Bytes(self.body.get(usize::from(self.joints_at)..).unwrap_or(&[])), left: self.joints, first_channel: 0 }
    }

    /// One of the joints.
    #[inline(never)]
    pub fn joint(&self, index: usize) -> Option<Joint<'a>> {
        self.joints().nth(index)
    }

    /// Channels that move no joint. In a pose they follow the joints' channels.
    pub fn scalars(&self) -> Scalars<'a> {
        let mut joints = self.joints();
        joints.by_ref().for_each(drop);
        Scalars::new(joints.bytes, self.scalars)
    }

    /// Number of joints, End Sites included.
    pub fn joint_count(&self) -> usize {
        usize::from(self.joints)
    }

    /// Channels of a pose that belong to joints; scalars follow them.
    pub fn joint_channels(&self) -> usize {
        usize::from(self.joint_channels)
    }

    /// Length of a pose.
    pub fn channels(&self) -> usize {
        usize::from(self.joint_channels) + usize::from(self.scalars)
    }

    /// Length of the source's unit, in millionths of a centimetre.
    pub fn micro_cm_per_unit(&self) -> u32 {
        self.cm_per_unit
    }

    /// One step of an offset is 2^`length_exponent` units of the source.
    pub fn length_exponent(&self) -> i8 {
        self.length_exponent
    }
}

/// A rig's id, byte by byte: FNV-1a, 32 bits, of all but the CRC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Id(pub u32);

impl Default for Id {
    fn default() -> Self {
        Id(names::HASH_OF_NOTHING)
    }
}

impl Id {
    pub fn and(self, byte: u8) -> Id {
        Id(names::hash_on(self.0, byte))
    }
}

/// Walks the channels of a pose.
#[derive(Clone, Debug)]
pub(crate) struct ChannelIter<'a> {
    joints: Joints<'a>,
    kinds: Kinds<'a>,
    offset: [i32; 3],
    scalars: u16,
}

impl<'a> Rig<'a> {
    pub(crate) fn slots(&self) -> ChannelIter<'a> {
        let kinds = Kinds { halves: &[], next: 0, len: 0 };
        ChannelIter { joints: self.joints(), kinds, offset: [0; 3], scalars: self.scalars }
    }
}

impl Iterator for ChannelIter<'_> {
    /// A channel's kind and, for positions, the offset that it replaces, in steps of the rig.
    type Item = (Kind, i32);

    fn next(&mut self) -> Option<(Kind, i32)> {
        loop {
            if let Some(kind) = self.kinds.next() {
                let axis = if kind.is_position() { kind.axis() } else { None };
                return Some((kind, axis.and_then(|axis| self.offset.get(axis).copied()).unwrap_or(0)));
            }
            if self.joints.left == 0 {
                self.scalars = self.scalars.checked_sub(1)?;
                return Some((Kind::Scalar, 0));
            }
            // A checked rig's joints can all be read.
            self.joints.fields(&mut self.kinds, &mut self.offset).ok()?;
        }
    }
}

/// Walks the joints of a rig.
#[derive(Clone, Debug)]
pub struct Joints<'a> {
    bytes: Bytes<'a>,
    left: u16,
    first_channel: u16,
}

impl<'a> Joints<'a> {
    fn parse(&mut self) -> Result<Joint<'a>, OpenError> {
        let first_channel = self.first_channel;
        let (mut kinds, mut offset) = (Kinds { halves: &[], next: 0, len: 0 }, [0; 3]);
        let (name, parent, end_site) = self.fields(&mut kinds, &mut offset)?;
        Ok(Joint { name, parent, offset, end_site, first_channel, kinds })
    }

    /// Reads a joint: its kinds and offset to where they belong, for stacks on which a whole joint is much; returns name, parent and
    /// whether it is an End Site.
    #[inline(never)]
    fn fields(&mut self, kinds: &mut Kinds<'a>, offset: &mut [i32; 3]) -> Result<(&'a [u8], Option<u16>, bool), OpenError> {
        let head = self.bytes.byte()?;
        let len = head & 0xf;
        let end_site = head & 0x10 != 0;
        if head & 0xe0 != 0 || (end_site && len != 0) {
            return Err(OpenError::Malformed);
        }
        let parent = self.bytes.varint()?;
        if parent > MAX_JOINTS as u32 {
            return Err(OpenError::Malformed);
        }
        let parent = (parent as u16).checked_sub(1);
        *kinds = Kinds { halves: self.bytes.take(usize::from(len).div_ceil(2))?, next: 0, len };
        for along in offset {
            *along = self.bytes.zigzag()?;
        }
        let name = if end_site { &[][..] } else { self.bytes.name()? };
        // At most MAX_JOINTS joints of 15 channels: fits 16 bits.
        self.first_channel = self.first_channel.wrapping_add(u16::from(len));
        self.left = self.left.saturating_sub(1);
        Ok((name, parent, end_site))
    }
}

impl<'a> Iterator for Joints<'a> {
    type Item = Joint<'a>;

    fn next(&mut self) -> Option<Joint<'a>> {
        if self.left == 0 { None } else { self.parse().ok() }
    }
}

/// Walks the scalars of a rig.
#[derive(Clone, Debug)]
pub struct Scalars<'a> {
    bytes: Bytes<'a>,
    left: u16,
    /// The last one that a list named, and how many after it are named by the list too.
    listed: u8,
    more: u8,
    exponent: i8,
}

impl<'a> Scalars<'a> {
    fn new(bytes: Bytes<'a>, left: u16) -> Scalars<'a> {
        Scalars { bytes, left, listed: 0, more: 0, exponent: 0 }
    }

    /// Of bytes that [`Scalars::bytes`] gave: of a checked rig, of which no more is at hand.
    pub fn of_bytes(bytes: &'a [u8], count: usize) -> Scalars<'a> {
        Scalars::new(Bytes(bytes), count as u16)
    }

    /// Where those that are still to come stand in the rig.
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes.0
    }

    fn parse(&mut self) -> Result<Scalar<'a>, OpenError> {
        self.left = self.left.saturating_sub(1);
        self.listed = self.listed.wrapping_add(1);
        let mut name = &[][..];
        if self.more == 0 {
            self.exponent = self.bytes.byte()? as i8;
            self.listed = SPELLED;
            if self.exponent == LISTED {
                self.listed = self.bytes.byte()?;
                self.more = self.bytes.byte()?;
                self.exponent = self.bytes.byte()? as i8;
            } else {
                name = self.bytes.name()?;
            }
        } else {
            self.more -= 1;
        }
        Ok(Scalar { name, listed: self.listed, exponent: self.exponent })
    }
}

impl<'a> Iterator for Scalars<'a> {
    type Item = Scalar<'a>;

    fn next(&mut self) -> Option<Scalar<'a>> {
        if self.left == 0 { None } else { self.parse().ok() }
    }
}
