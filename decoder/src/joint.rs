//! The joints of a rig, and the iterator that reads them.

use crate::bytes::Reader;
use crate::kind::{Kind, Kinds};
use crate::layout::{END_SITE, HELPER, JOINT_CHANNELS, MAX_JOINTS};
use crate::rig::Rig;

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
    /// Whether it only steers other joints, such as the target of an IK chain: neither it nor what hangs on it is a limb.
    pub helper: bool,
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

/// A joint of a rig, found once ([`Rig::find`]) and then asked for frame by frame ([`crate::Pose::turn`]).
#[derive(Clone, Copy, Debug)]
pub struct JointRef<'a> {
    rig_id: u32,
    index: u16,
    first_channel: u16,
    /// How many joints with a choice stand before this one, if it has a choice itself.
    choice: Option<u16>,
    kinds: Kinds<'a>,
}

impl<'a> JointRef<'a> {
    /// The first joint of the rig that is `wanted`, of its index.
    #[inline(always)]
    pub(crate) fn first(rig: &Rig<'a>, wanted: impl Fn(usize, &Joint<'a>) -> bool) -> Option<JointRef<'a>> {
        let (mut walk, mut index, mut choices) = (rig.joints(), 0u16, 0);
        while walk.read() {
            let (joint, choice) = (&walk.joint, has_choice(&walk.joint));
            if wanted(usize::from(index), joint) {
                let Joint { first_channel, kinds, .. } = *joint;
                return Some(JointRef { rig_id: rig.id(), index, first_channel, choice: choice.then_some(choices), kinds });
            }
            choices += u16::from(choice);
            index += 1;
        }
        None
    }

    /// Its index in the rig.
    pub fn index(&self) -> usize {
        usize::from(self.index)
    }

    /// The index of its first channel in a pose.
    pub fn first_channel(&self) -> usize {
        usize::from(self.first_channel)
    }

    /// The kinds of its channels as the rig has them, which a clip can code otherwise: [`crate::Clip::kinds`].
    pub fn kinds(&self) -> Kinds<'a> {
        self.kinds
    }

    /// The order of its Euler angles in the rig, in which [`crate::Turn::euler`] should be asked for them; `None` for a joint whose rotation channels are not one to
    /// three Euler angles about different axes.
    pub fn euler_order(&self) -> Option<crate::EulerOrder> {
        crate::pose::order_of(self.kinds)
    }

    /// The id of its rig: [`Rig::id`].
    pub fn rig_id(&self) -> u32 {
        self.rig_id
    }

    pub(crate) fn choice(&self) -> Option<usize> {
        self.choice.map(usize::from)
    }
}

/// Whether a clip may code the joint's rotation as an exponential map in place of its three Euler angles.
pub fn has_choice(joint: &Joint<'_>) -> bool {
    joint.kinds.filter(|kind: &Kind| kind.is_rotation()).count() == 3
}

/// Reads the kinds of the joint that begins with a byte.
pub(crate) fn kinds<'a>(reader: &mut Reader<'a>, head: u8) -> Kinds<'a> {
    let len = head & JOINT_CHANNELS;
    Kinds::new(reader.take(u32::from(len).div_ceil(2)), len)
}

/// Iterates over the joints of a rig.
#[derive(Clone, Debug)]
pub struct Joints<'a> {
    pub(crate) reader: Reader<'a>,
    left: u16,
    /// The first channel of the next joint.
    pub(crate) first_channel: u16,
    /// The joint that was read last.
    pub(crate) joint: Joint<'a>,
}

impl<'a> Joints<'a> {
    pub(crate) fn new(reader: Reader<'a>, left: u16) -> Joints<'a> {
        let none = Joint {
            name: &[],
            parent: None,
            offset: [0; 3],
            end_site: false,
            helper: false,
            first_channel: 0,
            kinds: Kinds::NONE,
        };
        Joints { reader, left, first_channel: 0, joint: none }
    }

    /// Reads the next joint; false if there is none.
    #[inline(never)]
    pub(crate) fn read(&mut self) -> bool {
        let Some(left) = self.left.checked_sub(1) else { return false };
        let (reader, joint) = (&mut self.reader, &mut self.joint);
        let head = reader.byte();
        let len = head & JOINT_CHANNELS;
        (joint.end_site, joint.helper) = (head & END_SITE != 0, head & HELPER != 0);
        let parent = reader.varint();
        reader.malformed |=
            head & !(JOINT_CHANNELS | END_SITE | HELPER) != 0 || (joint.end_site && len != 0) || parent > MAX_JOINTS as u32;
        joint.parent = (parent as u16).checked_sub(1);
        joint.kinds = kinds(reader, head);
        for along in &mut joint.offset {
            *along = reader.zigzag();
        }
        joint.name = if joint.end_site { &[] } else { reader.name() };
        joint.first_channel = self.first_channel;
        // At most MAX_JOINTS joints of 15 channels: fits 16 bits.
        self.first_channel = self.first_channel.wrapping_add(u16::from(len));
        self.left = left;
        true
    }
}

impl<'a> Iterator for Joints<'a> {
    type Item = Joint<'a>;

    fn next(&mut self) -> Option<Joint<'a>> {
        if self.read() { Some(self.joint) } else { None }
    }
}
