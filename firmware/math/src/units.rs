//! Figure units: the power of two of the source's unit in which the longest component of a bone lies within 2^13 to 2^14. A person is some 2^16 high.

use crate::rotation::shift_right;
use pantin::{Joint, Rig};

/// Bits of the longest bone's largest component in figure units: its product with an element of a rotation stays below 2^31.
const BONE_BITS: i32 = 14;

/// The figure units of a rig, for the poses of one form.
#[derive(Clone, Copy, Debug)]
pub struct FigureUnits {
    /// One figure unit is 2^exponent source units.
    pub exponent: i32,
    /// The last joint of the chain that only places the figure: the root, and an only child of it that has three position channels in place of an
    /// offset, as rigs with a joint on the floor above the hips do.
    pub hips: usize,
    /// Of an offset in the rig: 2^exponent source units.
    offset_exponent: i32,
    /// Of a position channel.
    position_exponent: i32,
}

impl FigureUnits {
    /// Chooses the unit by the longest bone; where a position channel moves a joint, by `pose`.
    pub fn new(rig: &Rig, pose: &[i32], position_exponent: i8) -> Self {
        let mut units = FigureUnits {
            exponent: 0,
            hips: placement_end(rig),
            offset_exponent: rig.length_exponent().into(),
            position_exponent: position_exponent.into(),
        };
        let mut longest = None;
        for joint in rig.joints().skip(units.hips + 1) {
            for (raw, moved) in bone(&joint, pose) {
                if raw != 0 {
                    longest = longest.max(Some(units.exponent_of(moved) + 32 - raw.unsigned_abs().leading_zeros() as i32));
                }
            }
        }
        units.exponent = longest.unwrap_or(0) - BONE_BITS;
        units
    }

    fn exponent_of(&self, moved: bool) -> i32 {
        if moved { self.position_exponent } else { self.offset_exponent }
    }

    /// The right shift that brings the value of a position channel to figure units, by [`shift_right`].
    pub fn position_shift(&self) -> i32 {
        self.exponent - self.position_exponent
    }

    /// The right shift that brings an offset of the rig to figure units, by [`shift_right`].
    pub fn offset_shift(&self) -> i32 {
        self.exponent - self.offset_exponent
    }

    /// Where a joint behind the hips stands in its parent: components within 2^14. Components that position channels give are those of `pose`.
    pub fn bone(&self, joint: &Joint, pose: &[i32]) -> [i16; 3] {
        bone(joint, pose).map(|(raw, moved)| shift_right(raw, self.exponent - self.exponent_of(moved)) as i16)
    }
}

/// See [`FigureUnits::hips`].
fn placement_end(rig: &Rig) -> usize {
    let only_child = rig.joints().filter(|joint| joint.parent == Some(0) && !joint.helper).count() == 1;
    let placed = rig.joints().nth(1).is_some_and(|joint| {
        let positions = joint.kinds.filter(|kind| kind.is_position()).count();
        positions == 3 && joint.offset == [0; 3]
    });
    usize::from(only_child && placed)
}

/// Raw components of a joint's bone, and whether each comes from a position channel.
#[inline(never)]
fn bone(joint: &Joint, pose: &[i32]) -> [(i32, bool); 3] {
    let mut bone = joint.offset.map(|raw| (raw, false));
    for (slot, kind) in joint.kinds.enumerate().filter(|(_, kind)| kind.is_position()) {
        let raw = pose.get(usize::from(joint.first_channel) + slot).copied().unwrap_or(0);
        if let Some(component) = kind.axis().and_then(|axis| bone.get_mut(axis)) {
            *component = (raw, true);
        }
    }
    bone
}
