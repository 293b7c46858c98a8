//! Which joints of a rig make a clear figure: without fingers, toes beyond one, features of the face and bones too short to see.

use crate::Error;
use crate::names::contains;
use crate::root::{integer_root, shift_for};
use crate::rotation::Vector;
use pantin::Rig;
use pantin_math::units::FigureUnits;

/// What is known of one joint of the whole rig before the figure's skeleton is built. Lengths are in figure units.
#[derive(Clone, Copy, Debug)]
pub struct JointInfo {
    /// Its bone: the rest offset, or what position channels put in its place. Nothing for a placement.
    pub(crate) bone: [i16; 3],
    /// Length of the bone.
    pub(crate) length: u16,
    /// Longest chain of bones below it, in 8 units.
    reach: u16,
    /// In what is left of a hand: how long the finger is up to here, in 8 units. Elsewhere [`NO_FINGER`].
    finger: u16,
    /// Index of the parent; the root has [`NO_PARENT`].
    pub(crate) parent: u8,
    /// Kept joints in its part of the tree, itself among them.
    pub(crate) weight: u8,
    /// The child that the longest chain starts with, and later its index in the skeleton.
    pub(crate) link: u8,
    flags: u8,
}

/// Fills a workspace.
impl Default for JointInfo {
    fn default() -> Self {
        JointInfo {
            bone: [0; 3],
            length: 0,
            reach: 0,
            finger: NO_FINGER,
            parent: NO_PARENT,
            weight: 0,
            link: NO_PARENT,
            flags: 0,
        }
    }
}

/// Facts about a limb.
pub(crate) mod flag {
    /// Not a bone but where the figure stands.
    pub const PLACEMENT: u8 = 1;
    pub const END_SITE: u8 = 2;
    pub const HEAD: u8 = 4;
    pub const KEPT: u8 = 8;
    /// A kept joint hangs on it.
    pub const BEARS: u8 = 16;
    /// More than one joint hangs on it, kept or not.
    pub const FORKS: u8 = 32;
    /// One joint does.
    pub const PARENT: u8 = 64;
}

impl JointInfo {
    pub(crate) fn is(&self, flags: u8) -> bool {
        self.flags & flags == flags
    }

    fn set(&mut self, flag: u8, on: bool) {
        self.flags = if on { self.flags | flag } else { self.flags & !flag };
    }
}

/// In place of a parent's index, or of one in the skeleton.
pub(crate) const NO_PARENT: u8 = u8::MAX;
const NO_FINGER: u16 = u16::MAX;

/// All joints of a rig, and what follows from them together.
pub(crate) struct JointTable<'w> {
    pub table: &'w mut [JointInfo],
    /// One figure unit is 2^exponent source units.
    pub exponent: i32,
    /// Rough height of the figure: 5/4 of its longest chain of bones from the hips.
    pub size: i32,
    /// The joint that the camera follows.
    pub hips: usize,
}

/// The size of a figure without bones.
const NO_SIZE: i32 = 1 << 14;

impl<'w> JointTable<'w> {
    /// Reads the rig; where a joint's bone is a matter of position channels, as `pose` has them. `scratch` has an element a joint.
    #[inline(never)]
    pub fn new(rig: &Rig, pose: &[i32], position_exponent: i8, scratch: &'w mut [JointInfo]) -> Result<Self, Error> {
        let (needed, given) = (rig.joint_count(), scratch.len().min(usize::from(NO_PARENT)));
        let table = scratch.get_mut(..needed).filter(|_| needed <= given);
        let table = table.ok_or(Error::TooManyJoints { needed, given })?;
        let units = FigureUnits::new(rig, pose, position_exponent);
        let (hips, exponent) = (units.hips, units.exponent);
        let mut has_head = false;
        for ((index, joint), info) in rig.joints().enumerate().zip(table.iter_mut()) {
            let bone = if index <= hips { [0; 3] } else { units.bone(&joint, pose) };
            let head = !has_head && [&b"head"[..], b"kopf"].iter().any(|word| contains(joint.name_bytes(), word));
            has_head |= head;
            let parent = joint.parent.map_or(NO_PARENT, |parent| parent as u8);
            *info =
                JointInfo { bone, length: length(bone.map(i32::from)) as u16, parent, flags: flag::KEPT, ..JointInfo::default() };
            if joint.helper {
                // It counts neither for the size nor as a limb.
                (info.bone, info.length) = ([0; 3], 0);
                info.set(flag::KEPT, false);
            }
            info.set(flag::PLACEMENT, index <= hips);
            info.set(flag::END_SITE, joint.end_site);
            info.set(flag::HEAD, head);
        }
        let mut table = JointTable { table, exponent, size: NO_SIZE, hips };
        table.drop_below_helpers();
        table.measure();
        Ok(table)
    }

    /// Drops what hangs on a joint that is not kept.
    fn drop_below_helpers(&mut self) {
        for index in 0..self.table.len() {
            let parent = self.table.get(index).and_then(|info| self.table.get(usize::from(info.parent)));
            let dropped = parent.is_some_and(|parent| !parent.is(flag::KEPT));
            if let Some(info) = self.table.get_mut(index).filter(|_| dropped) {
                info.length = 0;
                info.set(flag::KEPT, false);
            }
        }
    }

    /// Reaches, from the ends of the limbs upwards, and the size.
    fn measure(&mut self) {
        for index in (0..self.table.len()).rev() {
            let Some(&JointInfo { parent, length, reach, .. }) = self.table.get(index) else { return };
            if let Some(parent) = self.table.get_mut(usize::from(parent)) {
                parent.set(flag::FORKS, parent.is(flag::PARENT));
                parent.set(flag::PARENT, true);
                let chain = reach.saturating_add(length / 8);
                if chain >= parent.reach {
                    parent.reach = chain;
                    parent.link = index as u8;
                }
            }
        }
        let reach = self.table.get(self.hips).map_or(0, |hips| i32::from(hips.reach) * 8);
        if reach > 0 {
            self.size = reach + reach / 4;
        }
    }

    /// Drops what would only be a blot on a small display: fingers but the longest, everything in the head, and what ends a
    /// limb and is too short to see.
    pub fn prune(&mut self) {
        let eighths = self.size / 8;
        for index in 0..self.table.len() {
            let parent = self.table.get(index).map_or(NO_PARENT, |info| info.parent);
            let Some(&parent) = self.table.get(usize::from(parent)) else { continue };
            let hand = parent.is(flag::FORKS) && i32::from(parent.reach) < eighths / 6;
            let finger = if hand { 0 } else { parent.finger };
            let longest = parent.link == index as u8;
            let short = parent.finger == NO_FINGER || i32::from(parent.finger) < eighths / 25;
            let shows = finger == NO_FINGER || (longest && short);
            let Some(info) = self.table.get_mut(index) else { return };
            let kept = info.is(flag::KEPT) && parent.is(flag::KEPT) && !parent.is(flag::HEAD) && shows;
            info.set(flag::KEPT, kept);
            info.finger = if finger == NO_FINGER { NO_FINGER } else { finger.saturating_add(info.length / 8).min(NO_FINGER - 1) };
        }
        self.settle(self.size / 64);
    }

    /// Drops what ends a limb and is shorter than `shortest`, marks what bears the rest and counts it.
    pub fn settle(&mut self, shortest: i32) {
        for index in (0..self.table.len()).rev() {
            let Some(info) = self.table.get_mut(index) else { return };
            let stays =
                info.is(flag::PLACEMENT) || info.is(flag::HEAD) || info.is(flag::BEARS) || i32::from(info.length) >= shortest;
            let kept = info.is(flag::KEPT) && stays;
            info.set(flag::KEPT, kept);
            info.weight = info.weight.saturating_add(u8::from(kept));
            let (parent, weight) = (info.parent, info.weight);
            if let Some(parent) = self.table.get_mut(usize::from(parent)) {
                parent.set(flag::BEARS, parent.is(flag::BEARS) || kept);
                parent.weight = parent.weight.saturating_add(weight);
            }
        }
    }

    /// The kept joint after `index`, or the first of all, in an order in which every joint comes right after its parent or after what hangs on a sibling,
    /// and the sibling with most on it comes last: then few rotations wait for their joints at a time.
    pub fn after(&self, index: Option<usize>) -> Option<usize> {
        let mut above = index.unwrap_or(usize::from(NO_PARENT));
        let mut done = None;
        loop {
            if let Some(child) = self.lightest(above, done) {
                return Some(child);
            }
            done = Some(above);
            // Above the root there is nothing.
            above = usize::from(self.table.get(above)?.parent);
        }
    }

    /// The kept child of a joint that comes after `done`, its child too, or the first.
    fn lightest(&self, parent: usize, done: Option<usize>) -> Option<usize> {
        let key = |index: usize| self.table.get(index).map(|info| (info.weight, index));
        let done = done.and_then(key);
        let children =
            self.table.iter().enumerate().filter(|(_, info)| usize::from(info.parent) == parent && info.is(flag::KEPT));
        children
            .filter_map(|(index, _)| key(index))
            .filter(|own| done.is_none_or(|done| *own > done))
            .min()
            .map(|(_, index)| index)
    }
}

/// Length of a vector, rounded down to a few units.
pub(crate) fn length(v: Vector) -> i32 {
    let shift = shift_for(v);
    let square = v.iter().fold(0u32, |sum, &x| sum + (x >> shift).unsigned_abs().pow(2));
    (integer_root(square) as i32) << shift
}
