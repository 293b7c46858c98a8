//! The rig: the figure's joints and scalars, checked once.
//!
//! A rig's bytes depend on nothing but the figure, so that clips can share one by its [`Rig::id`].

use crate::bytes::Bytes;
use crate::joint::{Joint, JointRef, Joints};
use crate::kind::{Kind, Kinds};
use crate::layout::{MAX_CHANNELS, MAX_JOINTS};
use crate::scalar::{ScalarRef, Scalars};
use crate::{OpenError, crc, names};

/// A checked rig: the joints and scalars that the channels of a pose drive.
#[derive(Clone, Copy, Debug)]
pub struct Rig<'a> {
    /// All bytes but the CRC.
    body: &'a [u8],
    /// Where the joints begin in them: 12 at most.
    joints_at: u8,
    joints: u16,
    scalars: u16,
    joint_channels: u16,
    /// Millionths of a centimetre.
    unit_micro_cm: u32,
    id: Id,
    length_exponent: i8,
}

impl<'a> Rig<'a> {
    /// Checks `bytes`, all of them one rig with its CRC.
    #[inline(never)]
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, OpenError> {
        let (body, stored) = bytes.split_last_chunk::<2>().ok_or(OpenError::Truncated)?;
        // One pass for both: the identity adds two instructions a byte.
        let (sum, id) = body.iter().fold((crc::INITIAL, Id::default()), |(sum, id), &byte| (crc::push(sum, byte), id.and(byte)));
        if sum != u16::from_le_bytes(*stored) {
            return Err(OpenError::BadCrc);
        }
        let mut reader = Bytes(body);
        let unit_micro_cm = reader.varint()?;
        let length_exponent = reader.byte()? as i8;
        let joints = reader.varint()?;
        let scalars = reader.varint()?;
        if unit_micro_cm == 0 || !(-31..=31).contains(&length_exponent) {
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
            unit_micro_cm,
            id,
            length_exponent,
        };
        let mut walk = rig.joints();
        for index in 0..rig.joints {
            let mut kinds = Kinds::NONE;
            let (_, parent, _) = walk.fields(&mut kinds, &mut [0; 3])?;
            let len = kinds.len();
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

    /// The same rig in other bytes.
    pub(crate) fn with_bytes<'b>(&self, body: &'b [u8]) -> Rig<'b> {
        let Rig { joints_at, joints, scalars, joint_channels, unit_micro_cm, id, length_exponent, .. } = *self;
        Rig { body, joints_at, joints, scalars, joint_channels, unit_micro_cm, id, length_exponent }
    }

    /// The FNV-1a hash (32 bits) of the rig's bytes, by which a clip without a rig names the one that it needs.
    pub fn id(&self) -> u32 {
        self.id.0
    }

    /// Joints, End Sites included. The root comes first, and every parent before its children.
    #[inline(never)]
    pub fn joints(&self) -> Joints<'a> {
        Joints::new(Bytes(self.body.get(usize::from(self.joints_at)..).unwrap_or(&[])), self.joints)
    }

    /// One of the joints.
    #[inline(never)]
    pub fn joint(&self, index: usize) -> Option<Joint<'a>> {
        self.joints().nth(index)
    }

    /// Finds a joint by its name, of equal names the first. Names are compared byte by byte; an empty name finds nothing.
    #[inline(never)]
    pub fn find(&self, name: &str) -> Option<JointRef<'a>> {
        let named = |joint: Joint<'_>| !joint.end_site && joint.name_bytes() == name.as_bytes();
        JointRef::new(self, self.joints().position(named).filter(|_| !name.is_empty())?)
    }

    /// The joint of this index, End Sites counted, to be asked for frame by frame.
    pub fn joint_ref(&self, index: usize) -> Option<JointRef<'a>> {
        JointRef::new(self, index)
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
    pub fn unit_micro_cm(&self) -> u32 {
        self.unit_micro_cm
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
        let kinds = Kinds::NONE;
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
