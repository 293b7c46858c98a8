//! A motion on the spot: the way of the joint that carries the figure is taken out.

use super::rotation::{local, turns_freely, twist, write};
use crate::error::{Error, Setting, require};
use crate::fk::{about, product};
use crate::motion::Motion;
use anyhow::Result;

/// What is taken out of a motion that goes somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum InPlace {
    /// The horizontal way: the figure stays above the place of its first frame, and turns as it did.
    Way,
    /// The way and the heading: the figure faces where it faces in its first frame, too.
    WayAndHeading,
}

/// Takes the way out of the first joint with positions.
pub fn in_place(motion: &Motion, what: InPlace) -> Result<Motion> {
    let rig = &motion.rig;
    let carrier = rig.joints.iter().position(|joint| joint.kinds.iter().any(|kind| kind.is_position()));
    let Some(carrier) = carrier else {
        return Err(Error::setting(Setting::InPlace, "no joint has positions").into());
    };
    let (joint, first, up) = (&rig.joints[carrier], rig.first_channels()[carrier], rig.up.axis());
    let mut out = motion.clone();
    let horizontal = |slot: &usize| joint.kinds[*slot].is_position() && joint.kinds[*slot].axis() != Some(up);
    for slot in (0..joint.kinds.len()).filter(horizontal) {
        let held = motion.values[first + slot][0];
        out.values[first + slot].fill(held);
        out.keys[first + slot] = None;
    }
    if what == InPlace::WayAndHeading {
        let name = || format!("{} has not all three rotations that a heading takes", rig.joint_name(carrier));
        require!(turns_freely(joint), Error::setting(Setting::InPlace, name()));
        let start = twist(&local(motion, carrier, first, 0), up);
        for frame in 0..motion.frames {
            let turn = local(motion, carrier, first, frame);
            let ahead = product(&about(up, start - twist(&turn, up)), &turn);
            write(joint, first, &mut out.values, frame, &ahead);
        }
        out.keys[first..first + joint.kinds.len()].fill(None);
    }
    Ok(out)
}
