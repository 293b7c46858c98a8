//! The rig: the figure's joints and scalars, checked once.
//!
//! A rig's bytes depend on nothing but the figure, so that clips can share one by its [`Rig::id`].

use crate::bytes::Reader;
use crate::joint::{Joint, JointRef, Joints, has_choice};
use crate::kind::{Kind, Kinds};
use crate::layout::{END_SITE, MAX_CHANNELS, MAX_JOINTS};
use crate::scalar::{ScalarRef, Scalars};
use crate::{OpenError, crc, names};

/// A checked rig: the joints and scalars that the channels of a pose drive.
#[derive(Clone, Copy, Debug)]
pub struct Rig<'a> {
    /// All bytes but the CRC.
    body: &'a [u8],
    /// Where the joints begin in them: 17 at most.
    joints_at: u8,
    joints: u16,
    scalars: u16,
    joint_channels: u16,
    /// Joints with a choice: [`has_choice`].
    choices: u16,
    /// Millionths of a centimetre.
    unit_micro_cm: u32,
    id: Id,
    length_exponent: i8,
    up: Up,
}

/// The direction of the world that is vertical.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Up(u8);

impl Default for Up {
    fn default() -> Self {
        Up::Y
    }
}

impl Up {
    /// Y is up, as in glTF.
    pub const Y: Up = Up(1);
    const NEGATIVE: u8 = 4;

    /// The direction along an axis, 0 to 2 for x, y, z, or against it; `None` for another axis.
    pub const fn new(axis: usize, negative: bool) -> Option<Up> {
        if axis > 2 {
            return None;
        }
        Some(Up(axis as u8 | if negative { Self::NEGATIVE } else { 0 }))
    }

    /// The direction that a rig's byte states; `None` if it states none.
    pub const fn from_byte(byte: u8) -> Option<Up> {
        if byte > 6 { None } else { Up::new((byte & 3) as usize, byte & Self::NEGATIVE != 0) }
    }

    /// The byte for it in a rig.
    pub const fn byte(self) -> u8 {
        self.0
    }

    /// The axis, 0 to 2 for x, y, z.
    pub const fn axis(self) -> usize {
        (self.0 & 3) as usize
    }

    /// Whether up is against the axis.
    pub const fn is_negative(self) -> bool {
        self.0 & Self::NEGATIVE != 0
    }
}

impl<'a> Rig<'a> {
    /// Checks `bytes`, all of them one rig with its CRC.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, OpenError> {
        let mut rig = Rig::NONE;
        rig.read(bytes)?;
        Ok(rig)
    }

    /// No joints and no scalars.
    pub(crate) const NONE: Rig<'a> = Rig {
        body: &[],
        joints_at: 0,
        joints: 0,
        scalars: 0,
        joint_channels: 0,
        choices: 0,
        unit_micro_cm: 0,
        id: Id(names::HASH_OF_NOTHING),
        length_exponent: 0,
        up: Up::Y,
    };

    /// [`Rig::new_checked`] in place.
    #[inline(never)]
    pub(crate) fn read(&mut self, bytes: &'a [u8]) -> Result<(), OpenError> {
        let Some((body, stored)) = bytes.split_last_chunk::<2>() else { return Err(OpenError::Truncated) };
        if crc::of(body) != u16::from_le_bytes(*stored) {
            return Err(OpenError::BadCrc);
        }
        self.id = Id(names::hash(body));
        self.body = body;
        let mut reader = Reader::new(body);
        self.unit_micro_cm = reader.varint();
        self.length_exponent = reader.byte() as i8;
        let up = Up::from_byte(reader.byte());
        let (joints, scalars) = (reader.varint(), reader.varint());
        self.up = up.unwrap_or(Up::Y);
        let bad = up.is_none() || self.unit_micro_cm == 0 || !(-31..=31).contains(&self.length_exponent);
        if bad || joints > MAX_JOINTS as u32 || scalars > MAX_CHANNELS as u32 {
            return Err(OpenError::Malformed);
        }
        self.joints_at = reader.position as u8;
        (self.joints, self.scalars) = (joints as u16, scalars as u16);
        let mut walk = self.joints();
        let mut index = 0;
        while walk.read() {
            self.choices += u16::from(has_choice(&walk.joint));
            let joint = &mut walk.joint;
            walk.reader.malformed |= joint.parent.map_or(index != 0, |parent| parent >= index) || !joint.kinds.are_of_joint();
            index += 1;
        }
        self.joint_channels = walk.first_channel;
        let mut walk = Scalars::new(walk.reader, self.scalars);
        for _ in 0..self.scalars {
            walk.read();
        }
        walk.reader.malformed |= !walk.reader.rest().is_empty() || self.channels() > MAX_CHANNELS;
        walk.reader.check()
    }

    /// The same rig in other bytes.
    pub(crate) fn with_bytes<'b>(&self, body: &'b [u8]) -> Rig<'b> {
        let Rig { joints_at, joints, scalars, joint_channels, choices, unit_micro_cm, id, length_exponent, up, .. } = *self;
        Rig { body, joints_at, joints, scalars, joint_channels, choices, unit_micro_cm, id, length_exponent, up }
    }

    /// The FNV-1a hash (32 bits) of the rig's bytes, by which a clip without a rig names the one that it needs.
    pub fn id(&self) -> u32 {
        self.id.0
    }

    /// Joints, End Sites included. The root comes first, and every parent before its children.
    #[inline(never)]
    pub fn joints(&self) -> Joints<'a> {
        let mut reader = Reader::new(self.body);
        reader.position = u32::from(self.joints_at);
        Joints::new(reader, self.joints)
    }

    /// One of the joints.
    #[inline(never)]
    pub fn joint(&self, index: usize) -> Option<Joint<'a>> {
        self.joints().nth(index)
    }

    /// Finds a joint by its name, of equal names the first. Names are compared byte by byte; an empty name finds nothing.
    #[inline(never)]
    pub fn find(&self, name: &str) -> Option<JointRef<'a>> {
        // End Sites have no name.
        JointRef::first(self, |_, joint| !name.is_empty() && joint.name_bytes() == name.as_bytes())
    }

    /// The joint of this index, End Sites counted, to be asked for frame by frame.
    pub fn joint_ref(&self, index: usize) -> Option<JointRef<'a>> {
        JointRef::first(self, |at, _| at == index)
    }

    /// Finds a scalar by its name, of equal names the first. Names are compared byte by byte.
    #[inline(never)]
    pub fn find_scalar(&self, name: &str) -> Option<ScalarRef> {
        let hash = names::hash(name.as_bytes());
        let (index, scalar) =
            self.scalars().enumerate().find(|(_, scalar)| scalar.name_hash() == hash && scalar.name() == name)?;
        let channel = (self.joint_channels() + index) as u16;
        Some(ScalarRef { rig_id: self.id(), channel, exponent: scalar.exponent })
    }

    /// Channels that move no joint. In a pose they follow the joints' channels.
    pub fn scalars(&self) -> Scalars<'a> {
        let mut joints = self.joints();
        // They stand behind the joints.
        while self.scalars > 0 && joints.read() {}
        Scalars::new(joints.reader, self.scalars)
    }

    /// Number of joints, End Sites included.
    pub fn joint_count(&self) -> usize {
        usize::from(self.joints)
    }

    /// Channels of a pose that belong to joints; scalars follow them.
    pub fn joint_channels(&self) -> usize {
        usize::from(self.joint_channels)
    }

    /// Joints with a choice.
    pub(crate) fn choices(&self) -> usize {
        usize::from(self.choices)
    }

    /// Length of a pose.
    pub fn channels(&self) -> usize {
        usize::from(self.joint_channels) + usize::from(self.scalars)
    }

    /// Length of the source's unit, in millionths of a centimetre.
    pub fn unit_micro_cm(&self) -> u32 {
        self.unit_micro_cm
    }

    /// The direction of the world that is vertical.
    pub fn up(&self) -> Up {
        self.up
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

/// Walks the channels of a pose. It reads only what a channel needs of the rig's bytes, because each start of a clip walks through all of them.
#[derive(Clone, Debug)]
pub(crate) struct ChannelIter<'a> {
    reader: Reader<'a>,
    /// Those left of the joint that was read last.
    kinds: Kinds<'a>,
    /// Where its offset is.
    offset_at: u32,
    joints: u16,
    scalars: u16,
}

impl<'a> Rig<'a> {
    pub(crate) fn slots(&self) -> ChannelIter<'a> {
        let reader = self.joints().reader;
        ChannelIter { reader, kinds: Kinds::NONE, offset_at: 0, joints: self.joints, scalars: self.scalars }
    }
}

impl ChannelIter<'_> {
    /// Goes to the next joint; false if there is none.
    #[inline(never)]
    fn read(&mut self) -> bool {
        let Some(left) = self.joints.checked_sub(1) else { return false };
        self.joints = left;
        let head = self.reader.byte();
        self.reader.skip_varints(1);
        self.kinds = crate::joint::kinds(&mut self.reader, head);
        self.offset_at = self.reader.position;
        self.reader.skip_varints(3);
        if head & END_SITE == 0 {
            self.reader.name();
        }
        true
    }

    /// The offset of the last joint along an axis.
    #[inline(never)]
    fn offset(&self, axis: u32) -> i32 {
        let mut reader = self.reader;
        reader.position = self.offset_at;
        reader.skip_varints(axis);
        reader.zigzag()
    }
}

impl Iterator for ChannelIter<'_> {
    /// A channel's kind, and for a position the offset that it replaces, in steps of the rig.
    type Item = (Kind, i32);

    fn next(&mut self) -> Option<(Kind, i32)> {
        loop {
            if let Some(kind) = self.kinds.next() {
                // The first three kinds are positions, in the order of the axes.
                return Some((kind, if kind.is_position() { self.offset(kind as u32) } else { 0 }));
            }
            if !self.read() {
                self.scalars = self.scalars.checked_sub(1)?;
                return Some((Kind::Scalar, 0));
            }
        }
    }
}
