//! The pose of a frame: the rotation, the position and the scalars that its raw values stand for, however a clip codes them.

use crate::form::{FormRef, WrongForm};
use crate::joint::JointRef;
use crate::kind::{ANGLE, MAP, QUATERNION};
use crate::scalar::ScalarRef;
use crate::turn::{EulerOrder, NO_ROTATION, Turn, about, normalized, of_exponential, product};
use crate::units::{Angle, Component, Fraction};

/// The pose of one frame: a raw value for each channel of the rig, and what they mean.
///
/// ```
/// # fn knee(player: &pantin::Player) -> Option<i32> {
/// let knee = player.clip().find("LeftKnee")?;
/// let [first, ..] = player.turn(&knee).ok()?.euler(knee.euler_order()?);
/// Some(first.centidegrees())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Pose<'p> {
    /// One value a channel of the rig: angles in 2^-32 turns, positions in 2^[`crate::Form::length_exponent`] units of the source,
    /// quaternion components in 2^-30, scalars in 2^([`crate::Scalar::exponent`] - 31).
    pub values: &'p [i32],
    /// What the values mean.
    pub form: FormRef<'p>,
}

impl Pose<'_> {
    /// The rotation of a joint, however the clip codes it. A joint without rotation channels has no rotation.
    pub fn turn(&self, joint: &JointRef<'_>) -> Result<Turn, WrongForm> {
        if joint.rig_id() != self.form.rig_id {
            return Err(WrongForm::Rig);
        }
        let exponential = joint.choice().is_some_and(|choice| self.form.is_exponential_choice(choice));
        // The values of a joint of one form: Euler angles in the joint's order, x, y, z of a map, or w, x, y, z of a quaternion.
        let (mut own, mut axes, mut count, mut parts) = ([0; 4], [0; 3], 0, 0);
        for (channel, kind) in (joint.first_channel()..).zip(joint.kinds()) {
            let (part, member) = kind.turning();
            let place = match part {
                0 => continue,
                ANGLE => {
                    put(&mut axes, count, member);
                    count += 1;
                    count - 1
                }
                _ => member,
            };
            parts |= part;
            put(&mut own, place, self.values.get(channel).copied().unwrap_or(0));
        }
        let [w, x, y, _] = own;
        let three = [w, x, y].map(Angle::from_bits);
        Ok(match (parts, order(axes, count)) {
            (ANGLE, _) if exponential => Turn::Exponential(three),
            (MAP, _) => Turn::Exponential(three),
            (QUATERNION, _) => Turn::Quaternion(own.map(Component::from_bits)),
            (0 | ANGLE, Some(order)) => Turn::Euler { order, angles: three },
            _ => Turn::Quaternion(self.chain(joint, exponential).map(Component::from_bits)),
        })
    }

    /// The product of everything that turns a joint of more parts than a [`Turn`] has forms for: FORMAT.md 11.
    #[inline(never)]
    fn chain(&self, joint: &JointRef<'_>, exponential: bool) -> [i32; 4] {
        let mut unit = NO_ROTATION;
        let (mut coded, mut count, mut quaternion, mut map) = ([0; 3], 0, [0; 4], [0; 3]);
        for (channel, kind) in (joint.first_channel()..).zip(joint.kinds()) {
            let raw = self.values.get(channel).copied().unwrap_or(0);
            match kind.turning() {
                (ANGLE, _) if exponential => {
                    put(&mut coded, count, raw);
                    count += 1;
                }
                (ANGLE, axis) => unit = product(unit, about(axis, Angle::from_bits(raw))),
                (MAP, component) => put(&mut map, component, raw),
                (QUATERNION, component) => put(&mut quaternion, component, raw),
                _ => {}
            }
        }
        // What the joint lacks is no rotation here, and a product with that is exact.
        [of_exponential(coded), normalized(quaternion), of_exponential(map)].into_iter().fold(unit, product)
    }

    /// A scalar as a fraction of its range: a morph weight of 0 to 1 with the exponent 0 is its own fraction. Times
    /// 2^[`crate::Scalar::exponent`] it is the scalar's value.
    pub fn scalar(&self, scalar: &ScalarRef) -> Result<Fraction, WrongForm> {
        if scalar.rig_id() != self.form.rig_id {
            return Err(WrongForm::Rig);
        }
        Ok(Fraction::from_bits(self.values.get(scalar.channel()).copied().unwrap_or(0)))
    }

    /// Where a joint stands in its parent: raw values in units of 2^[`crate::Form::length_exponent`] of the source, `None` on axes where
    /// the rig's offset stands.
    pub fn position(&self, joint: &JointRef<'_>) -> Result<[Option<i32>; 3], WrongForm> {
        if joint.rig_id() != self.form.rig_id {
            return Err(WrongForm::Rig);
        }
        let mut position = [None; 3];
        for (channel, kind) in (joint.first_channel()..).zip(joint.kinds()).filter(|(_, kind)| kind.is_position()) {
            put(&mut position, kind.axis().unwrap_or(0), self.values.get(channel).copied());
        }
        Ok(position)
    }
}

fn put<T, const N: usize>(array: &mut [T; N], index: usize, value: T) {
    if let Some(place) = array.get_mut(index) {
        *place = value;
    }
}

/// The order that begins with the first `count` axes; `None` if they are not different or more than three.
fn order([mut first, mut second, mut third]: [usize; 3], count: usize) -> Option<EulerOrder> {
    if count == 0 {
        first = 0;
    }
    if count < 2 {
        second = if first == 2 { 0 } else { first + 1 };
    }
    if count < 3 {
        third = 3usize.wrapping_sub(first).wrapping_sub(second);
    }
    let axes = [first, second, third].into_iter().fold(0, |axes, axis| axes | 1u32.wrapping_shl(axis as u32));
    if count > 3 || axes != 0b111 {
        return None;
    }
    EulerOrder::ALL.get(2 * first + usize::from(second > third)).copied()
}

/// The Euler order of a joint of the rig.
pub(crate) fn order_of(kinds: crate::Kinds<'_>) -> Option<EulerOrder> {
    let (mut axes, mut count) = ([0; 3], 0);
    for kind in kinds {
        match kind.turning() {
            (0, _) => {}
            (ANGLE, axis) => {
                put(&mut axes, count, axis);
                count += 1;
            }
            _ => return None,
        }
    }
    order(axes, count).filter(|_| count > 0)
}
