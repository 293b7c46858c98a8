//! A look: neck, head and eyes turn towards a point, each by its share.

use crate::chain::{Chain, Joint, shifted};
use crate::error::{Error, Name};
use crate::groups::Group;
use crate::two_bone::Reach;
use heapless::Vec;
use pantin::{Angle, Clip};
use pantin_math::rotation::Vector;
use pantin_math::trig::{ONE, sin_cos};
use pantin_math::vector::{add, cross, direction, dot, sub, swing};

/// Most joints from the root to the last that looks.
const JOINTS: usize = 12;
/// Most joints that look.
const LOOKERS: usize = 4;

/// A joint that takes part in a look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// How much of the way that is left when its turn comes this joint goes, in 2^-15: the last one's is usually 1 << 15.
    pub part: u16,
    /// How far it turns at most beyond what the clip does: below a quarter turn.
    pub most: Angle,
}

/// The last joints of a chain, which turn so that the last one faces a point.
#[derive(Clone, Debug)]
pub struct Look<'a> {
    chain: Chain<'a, JOINTS>,
    /// Part, and the greatest chord in Q15.
    shares: Vec<(i32, i32), LOOKERS>,
    forward: Vector,
}

impl<'a> Look<'a> {
    /// The look of a joint, by its name: the last of `shares` is its own, the one before its parent's, and so on (4 at most). `forward` is the
    /// direction in the joint's own axes in which it faces, of any length.
    pub fn of(clip: &Clip<'a>, groups: &[Group], joint: &str, shares: &[Share], forward: [i32; 3]) -> Result<Look<'a>, Error> {
        let chain = Chain::to(clip, groups, joint)?;
        let (forward, _) = direction(forward).ok_or(Error::NoDirection)?;
        if shares.len() > chain.bones.len() {
            return Err(Error::ChainTooShort(Name::new(joint)));
        }
        let mut own = Vec::new();
        for share in shares {
            let (sin, _) = sin_cos(share.most.to_bits() >> 1);
            let share = (i32::from(share.part).min(ONE), 2 * sin.max(0));
            own.push(share).map_err(|_| Error::TooSmall { what: "joints that look", needed: shares.len(), given: LOOKERS })?;
        }
        Ok(Look { chain, shares: own, forward })
    }

    /// Where the joint that faces is in a pose, in 2^[`pantin::Form::length_exponent`] units of the source.
    pub fn eye(&self, pose: &[i32]) -> [i32; 3] {
        self.chain.place(pose, usize::MAX).place.map(|x| shifted(x, -self.chain.shift))
    }

    /// Turns the joints towards a point in the axes of the pose, in 2^[`pantin::Form::length_exponent`] units of the source.
    #[inline(never)]
    pub fn at(&self, pose: &mut [i32], target: [i32; 3]) -> Reach {
        let target = target.map(|x| shifted(x, self.chain.shift));
        let count = self.chain.bones.len();
        let Some((above, bones)) = self.chain.bones.split_at_checked(count.saturating_sub(self.shares.len())) else {
            return Reach { error: u32::MAX, within: false };
        };
        let mut joint: Joint = self.chain.place(pose, above.len());
        // How the last joint faces, from the rotations that the pose has.
        let (mut facing, mut eye) = (joint, joint.place);
        for bone in bones {
            facing = bone.after(&facing, pose, self.chain.shift);
            eye = facing.place;
        }
        let mut face = facing.rotation.apply(self.forward);
        let Some((wanted, _)) = direction(sub(target, eye)) else { return Reach { error: 0, within: true } };
        for (bone, &(part, most)) in bones.iter().zip(&self.shares) {
            // What the joints above have turned, this one and the face are turned by already.
            let before = joint.rotation;
            let mut own = before;
            bone.turn(&mut own, pose);
            // A step on the chord, then out to the circle.
            let chord = sub(wanted, face);
            let length = direction(chord).map_or(0, |(_, length)| length);
            let mut share = part;
            if (length * (share >> 1)) >> 14 > most {
                share = (most << 15).checked_div(length.max(1)).unwrap_or(0).min(ONE);
            }
            let next = direction(add(face, chord.map(|x| (x * share) >> 15))).map_or(face, |(next, _)| next);
            let world = match swing(face, next) {
                Some(step) => {
                    face = next;
                    step.then(&own)
                }
                None => own,
            };
            bone.write(&before, &world, pose);
            joint.rotation = world;
        }
        let sine = direction(cross(face, wanted)).map_or(0, |(_, length)| length);
        let error = Angle::atan2_coarse(sine, dot(face, wanted)).to_bits().unsigned_abs();
        // A degree.
        Reach { error, within: error < 1 << 24 }
    }
}
