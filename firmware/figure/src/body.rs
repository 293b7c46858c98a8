//! Which joints of a rig make a clear figure: without fingers, toes beyond one, features of the face and bones too short to see.

use crate::names::contains;
use crate::root::{integer_root, shift_for};
use crate::rotation::{Vector, shift_right};
use crate::{Error, RIG_JOINTS};
use heapless::Vec;
use pantin::{Joint, Rig};

/// What is known of one joint of the whole rig before the figure's skeleton is built.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limb {
    /// Index of the parent; the root has [`NO_PARENT`].
    pub parent: u16,
    /// Its bone in figure units: the rest offset, or what position channels put in its place. Nothing for a placement.
    pub bone: [i16; 3],
    /// Length of the bone.
    pub length: i32,
    /// Longest chain of bones below it, and the child that it starts with.
    pub reach: i32,
    pub longest: u16,
    pub children: u8,
    /// Not a bone but where the figure stands.
    pub placement: bool,
    pub end_site: bool,
    pub head: bool,
    pub kept: bool,
    /// Whether a kept joint hangs on it.
    pub bears: bool,
    /// In what is left of a hand: how long the finger is up to here. Elsewhere negative.
    pub finger: i32,
}

/// In place of a parent's index: more than any rig has.
const NO_PARENT: u16 = u16::MAX;

/// All joints of a rig, and what follows from them together.
pub(crate) struct Limbs {
    pub limbs: Vec<Limb, RIG_JOINTS>,
    /// One figure unit is 2^exponent source units.
    pub exponent: i32,
    /// Rough height of the figure: 5/4 of its longest chain of bones from the hips.
    pub size: i32,
    /// The joint that the camera follows.
    pub hips: usize,
}

/// Bits of the longest bone's largest component in figure units: the product with a Q15 row stays below 2^31.
const BONE_BITS: i32 = 14;
/// The size of a figure without bones.
const NO_SIZE: i32 = 1 << 14;

impl Limbs {
    /// Reads the rig; where a joint's bone is a matter of position channels, as `pose` has them.
    #[inline(never)]
    pub fn new(rig: &Rig, pose: &[i32], position_exponent: i8) -> Result<Self, Error> {
        let hips = placement_end(rig);
        let bones = || rig.joints().enumerate().map(|(index, joint)| bone(&joint, pose, index <= hips));
        let exponent_of = |moved| i32::from(if moved { position_exponent } else { rig.length_exponent() });
        let bits = |(raw, moved): (i32, bool)| exponent_of(moved) + 32 - raw.unsigned_abs().leading_zeros() as i32;
        let longest = bones().skip(hips + 1).flatten().filter(|&(raw, _)| raw != 0).map(bits).max();
        let exponent = longest.unwrap_or(0) - BONE_BITS;
        let mut limbs = Vec::new();
        let mut has_head = false;
        for ((index, joint), bone) in rig.joints().enumerate().zip(bones()) {
            let bone = if index <= hips { [(0, false); 3] } else { bone };
            // Below 2^14 by the choice of the exponent.
            let bone = bone.map(|(raw, moved)| shift_right(raw, exponent - exponent_of(moved)) as i16);
            let head = !has_head && contains(joint.name(), "head");
            has_head |= head;
            let limb = Limb {
                parent: joint.parent.unwrap_or(NO_PARENT),
                bone,
                length: length(bone.map(i32::from)),
                reach: 0,
                longest: 0,
                children: 0,
                placement: index <= hips,
                end_site: joint.end_site,
                head,
                kept: true,
                bears: false,
                finger: -1,
            };
            limbs.push(limb).map_err(|_| Error::TooManyJoints { most: RIG_JOINTS })?;
        }
        let mut limbs = Limbs { limbs, exponent, size: NO_SIZE, hips };
        limbs.measure();
        Ok(limbs)
    }

    /// Reaches, from the ends of the limbs upwards, and the size.
    fn measure(&mut self) {
        for index in (0..self.limbs.len()).rev() {
            let Limb { parent, length, reach, .. } = self.limbs[index];
            if let Some(parent) = self.limbs.get_mut(usize::from(parent)) {
                parent.children = parent.children.saturating_add(1);
                if length + reach >= parent.reach {
                    parent.reach = length + reach;
                    parent.longest = index as u16;
                }
            }
        }
        let reach = self.limbs.get(self.hips).map_or(0, |hips| hips.reach);
        if reach > 0 {
            self.size = reach + reach / 4;
        }
    }

    /// Drops what would only be a blot on a small display: fingers but the longest, everything in the head, and what ends a
    /// limb and is too short to see.
    pub fn prune(&mut self) {
        for index in 0..self.limbs.len() {
            let Some(parent) = self.limbs.get(usize::from(self.limbs[index].parent)) else { continue };
            let hand = parent.children > 1 && parent.reach < self.size / 6;
            let finger = if hand { 0 } else { parent.finger };
            let shows = finger < 0 || (parent.longest == index as u16 && parent.finger < self.size / 25);
            let kept = parent.kept && !parent.head && shows;
            let limb = &mut self.limbs[index];
            limb.kept = kept;
            limb.finger = if finger < 0 { finger } else { finger + limb.length };
        }
        self.settle(self.size / 64);
    }

    /// Drops what ends a limb and is shorter than `shortest`, and marks what bears the rest.
    pub fn settle(&mut self, shortest: i32) {
        for index in (0..self.limbs.len()).rev() {
            let limb = &mut self.limbs[index];
            limb.kept &= limb.placement || limb.head || limb.bears || limb.length >= shortest;
            let (parent, kept) = (limb.parent, limb.kept);
            if let Some(parent) = self.limbs.get_mut(usize::from(parent)) {
                parent.bears |= kept;
            }
        }
    }
}

/// The last joint of the chain that only places the figure: the root, and an only child of it that has its own three
/// positions in place of an offset, as rigs with a joint on the floor above the hips do.
fn placement_end(rig: &Rig) -> usize {
    let only_child = rig.joints().filter(|joint| joint.parent == Some(0)).count() == 1;
    let placed = rig.joints().nth(1).is_some_and(|joint| {
        let positions = joint.kinds.filter(|kind| kind.is_position()).count();
        positions == 3 && joint.offset == [0; 3]
    });
    usize::from(only_child && placed)
}

/// Raw components of a joint's bone, and whether each comes from a position channel.
fn bone(joint: &Joint, pose: &[i32], placement: bool) -> [(i32, bool); 3] {
    let mut bone = joint.offset.map(|raw| (raw, false));
    for (slot, kind) in joint.kinds.enumerate().filter(|(_, kind)| kind.is_position() && !placement) {
        let raw = pose.get(usize::from(joint.first_channel) + slot).copied().unwrap_or(0);
        if let Some(component) = kind.axis().and_then(|axis| bone.get_mut(axis)) {
            *component = (raw, true);
        }
    }
    bone
}

/// Length of a vector, rounded down to a few units.
pub(crate) fn length(v: Vector) -> i32 {
    let shift = shift_for(v);
    let square = v.iter().fold(0u32, |sum, &x| sum + (x >> shift).unsigned_abs().pow(2));
    (integer_root(square) as i32) << shift
}
