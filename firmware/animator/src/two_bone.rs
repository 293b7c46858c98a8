//! Two-bone inverse kinematics: a leg whose ankle, or an arm whose wrist, goes to a target.

use crate::chain::{Chain, Joint, shifted};
use crate::error::{Error, Name};
use crate::groups::Group;
use pantin::{Angle, Clip};
use pantin_math::rotation::Vector;
use pantin_math::trig::{ONE, sin_cos};
use pantin_math::vector::{add, between, cross, direction, dot, sub, times};

/// How near inverse kinematics came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach {
    /// Distance between the end and the target, in 2^[`pantin::Form::length_exponent`] units of the source; of a look, in 2^-32 turns.
    pub error: u32,
    /// Whether the target lies within the reach that the limits of the joints leave. Joints with fewer than three angles can miss it all the same, by
    /// the error.
    pub within: bool,
}

/// How far the middle joint may bend: 0 is straight. The defaults suit knees and elbows: 2 to 150 degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The least bend, above 0 and below half a turn.
    pub least: Angle,
    /// The greatest bend, above the least and below half a turn.
    pub greatest: Angle,
}

impl Default for Limits {
    fn default() -> Self {
        let degrees = |degrees| Angle::from_bits(crate::procedural::degrees(degrees));
        Limits { least: degrees(2), greatest: degrees(150) }
    }
}

/// Most joints from the root to the end of a limb.
const JOINTS: usize = 12;

/// Three joints in a row (thigh, shin, foot; upper arm, forearm, hand), the last of which goes to targets.
#[derive(Clone, Debug)]
pub struct Limb<'a> {
    chain: Chain<'a, JOINTS>,
    /// Lengths of the two bones in figure units, with 2^29 over each, and the distances of the ends that the limits allow.
    upper: (i32, i32),
    lower: (i32, i32),
    least: i32,
    greatest: i32,
    /// The axis about which the middle joint bends, in its own axes, and the sine of the greatest bend that it was seen at.
    hinge: Option<(Vector, i32)>,
}

/// The sine of the least bend that shows its axis, 2 degrees.
const LEAST_SINE: i32 = ONE / 28;

impl<'a> Limb<'a> {
    /// The limb that ends in a joint, by its name: its parent and its parent's parent bend. `groups` are those of the poses:
    /// [`crate::Animator::groups`]. [`Error::ChainTooShort`] for a joint with fewer than two above it, or for bones without length.
    pub fn to(clip: &Clip<'a>, groups: &[Group], end: &str, limits: Limits) -> Result<Limb<'a>, Error> {
        Limb::along(Chain::to(clip, groups, end)?, end, limits)
    }

    /// [`Limb::to`] the joint of an index.
    pub(crate) fn to_joint(clip: &Clip<'a>, groups: &[Group], end: usize, limits: Limits) -> Result<Limb<'a>, Error> {
        let name = clip.rig().joint(end).map_or("", |joint| joint.name());
        Limb::along(Chain::to_joint(clip, groups, end)?, name, limits)
    }

    fn along(chain: Chain<'a, JOINTS>, end: &str, limits: Limits) -> Result<Limb<'a>, Error> {
        let (count, short) = (chain.bones.len(), Error::ChainTooShort(Name::new(end)));
        let length = |back: usize| {
            let bone = chain.bones.get(count.wrapping_sub(back)).ok_or(short)?;
            direction(bone.offset).map(|(_, length)| length).ok_or(short)
        };
        let (upper, lower) = (length(2)?, length(1)?);
        if count < 3 {
            return Err(short);
        }
        let distance = |bend: Angle| {
            let (_, cos) = sin_cos(bend.to_bits());
            let square = i64::from(upper).pow(2)
                + i64::from(lower).pow(2)
                + ((2 * i64::from(upper) * i64::from(lower) * i64::from(cos)) >> 15);
            square.max(0).unsigned_abs().isqrt() as i32
        };
        let (least, greatest) = (distance(limits.greatest), distance(limits.least));
        // A bone of a few units bends nothing that can be seen.
        let known = |length: i32| (length, (1i32 << 29).checked_div(length.max(1 << 8)).unwrap_or(0));
        Ok(Limb { chain, upper: known(upper), lower: known(lower), least, greatest, hinge: None })
    }

    /// Where the end is in a pose, in 2^[`pantin::Form::length_exponent`] units of the source.
    pub fn end(&self, pose: &[i32]) -> [i32; 3] {
        self.chain.place(pose, usize::MAX).place.map(|x| shifted(x, -self.chain.shift))
    }

    /// Where the upper joint is in a pose, in the same units.
    pub fn start(&self, pose: &[i32]) -> [i32; 3] {
        let [_, first, ..] = self.places(pose);
        first.place.map(|x| shifted(x, -self.chain.shift))
    }

    /// Remembers how another limb of the same joints bends.
    pub(crate) fn bends_as(&mut self, other: &Limb<'a>) {
        self.hinge = other.hinge;
    }

    /// The length of the limb when it is stretched, in the same units.
    pub fn length(&self) -> i32 {
        shifted(self.upper.0 + self.lower.0, -self.chain.shift)
    }

    /// Turns the upper and the middle joint so that the end comes to a target, in the axes of the pose and in 2^[`pantin::Form::length_exponent`]
    /// units of the source, or as near as the limits allow; the end keeps its rotation in the world. The middle joint bends in the plane in which
    /// it did or, with a pole, towards that direction (in the axes of the pose, of any length).
    pub fn reach(&mut self, pose: &mut [i32], target: [i32; 3], pole: Option<[i32; 3]>) -> Reach {
        self.solve(pose, target.map(|x| shifted(x, self.chain.shift)), pole)
    }

    pub(crate) fn solve(&mut self, pose: &mut [i32], target: Vector, pole: Option<Vector>) -> Reach {
        let places = self.places(pose);
        self.learn(&places);
        self.solve_from(&places, pose, target, pole)
    }

    /// Right shift from a position channel's raw value to figure units.
    pub(crate) fn shift(&self) -> i32 {
        self.chain.shift
    }

    /// The joint above the limb and the limb's three joints in a pose.
    pub(crate) fn places(&self, pose: &[i32]) -> [Joint; 4] {
        let (shift, count) = (self.chain.shift, self.chain.bones.len());
        let above = self.chain.place(pose, count.saturating_sub(3));
        let Some([first, second, third]) = self.chain.bones.last_chunk::<3>() else { return [above; 4] };
        let hip = first.after(&above, pose, shift);
        let knee = second.after(&hip, pose, shift);
        [above, hip, knee, third.after(&knee, pose, shift)]
    }

    /// The first position channel along an axis above the limb.
    pub(crate) fn height(&self, axis: usize) -> Option<u16> {
        self.chain.bones.iter().rev().skip(3).rev().find_map(|bone| bone.position(axis))
    }

    /// The distance of the end from the upper joint past which the end comes less and less far, so that the limb does not snap straight: where it bends by 25
    /// degrees, or where the pose has the end. A pose that bends by less than 14 degrees gives up these, when its end has to move by a 64th of the limb.
    pub(crate) fn free(&self, [_, hip, _, end]: &[Joint; 4], target: Vector) -> i32 {
        let [bent, straight] = [3, 1].map(|part| self.greatest - part * self.greatest / 128);
        let own = (far(sub(end.place, hip.place)) as i32).min(self.greatest);
        let way = sub(target, end.place).map(|x| x.saturating_abs()).into_iter().fold(0, i32::max);
        let over = (own - straight).max(0);
        let given = (over * way.min(self.greatest / 64)).checked_div(self.greatest / 64).unwrap_or(0);
        (own - given).max(bent)
    }

    /// Whether a target stretches the limb too much: by more than three quarters of the way from where the pose has the end to where the limb is straight, and
    /// by more than a 32nd of the limb.
    pub(crate) fn overreaches(&self, [_, hip, _, end]: &[Joint; 4], target: Vector) -> bool {
        let (own, greatest) = (far(sub(end.place, hip.place)), u64::from(self.greatest.unsigned_abs()));
        far(sub(target, hip.place)) > own + (greatest.saturating_sub(own) * 3 / 4).max(greatest / 32)
    }

    /// The target or, past a distance of [`Limb::free`], one that is nearer.
    pub(crate) fn within(&self, [_, hip, ..]: &[Joint; 4], free: i32, target: Vector) -> Vector {
        let soft = (self.greatest - self.greatest / 128 - free).max(self.greatest / 256);
        match direction(sub(target, hip.place)) {
            Some((e, distance)) if distance > free => {
                let over = (distance - free).min(0xffff);
                add(hip.place, times(e, free + (over * soft).checked_div(over + soft).unwrap_or(0)))
            }
            _ => target,
        }
    }

    /// Directions of the two bones.
    fn bones(&self, [_, hip, knee, ankle]: &[Joint; 4]) -> [Vector; 2] {
        [unit(sub(knee.place, hip.place), self.upper), unit(sub(ankle.place, knee.place), self.lower)]
    }

    /// Whether it is not known how the limb bends.
    pub(crate) fn never_bent(&self) -> bool {
        self.hinge.is_none()
    }

    /// Remembers how the limb bends in a pose in which it bends as it should: not in one of a transition. At least 2 degrees tell it, and half of what
    /// was seen: nearly straight limbs bend to any side.
    pub(crate) fn learn(&mut self, places: &[Joint; 4]) {
        let [_, _, knee, _] = places;
        let [u, l] = self.bones(places);
        let Some((axis, sine)) = direction(cross(u, l)) else { return };
        let most = self.hinge.map_or(0, |(_, most)| most);
        if sine > (most / 2).max(LEAST_SINE) {
            let own = pantin_math::vector::transposed(&knee.rotation).apply(axis);
            let is_other = self.hinge.is_some_and(|(known, _)| dot(own, known) < 0);
            if !is_other || sine > most {
                self.hinge = Some((own, most.max(sine)));
            }
        }
    }

    /// [`Limb::reach`] in figure units, where [`Limb::places`] are known.
    #[inline(never)]
    pub(crate) fn solve_from(&mut self, places: &[Joint; 4], pose: &mut [i32], target: Vector, pole: Option<Vector>) -> Reach {
        let failed = Reach { error: u32::MAX, within: false };
        let shift = self.chain.shift;
        let [above, hip, knee, ankle] = places;
        let Some([first, second, third]) = self.chain.bones.last_chunk::<3>() else { return failed };
        // Within 2^-13 of a bone's length: nothing to do, and an unlocked limb costs no more than its kinematics.
        if sub(target, ankle.place).iter().all(|x| x.unsigned_abs() <= 2) {
            return Reach { error: 0, within: true };
        }
        let Some((e, distance)) = direction(sub(target, hip.place)) else { return failed };
        let [u, l] = self.bones(places);
        let reached = distance.max(self.least).min(self.greatest);
        // The cosine at the upper joint, (a^2 + d^2 - b^2) / 2ad: lengths below 2^16 as 2^14, squares below 2^28.
        let [a, b, d] = [self.upper.0, self.lower.0, reached].map(|length| length >> 2);
        let under = ((a * d) >> 13).max(1);
        let cos = (((a * a + d * d - b * b) << 1).checked_div(under).unwrap_or(0)).clamp(-ONE, ONE);
        let sin = (ONE * ONE - cos * cos).max(0).unsigned_abs().isqrt() as i32;
        let known = self.hinge.map(|(hinge, _)| knee.rotation.apply(hinge));
        let (bend, is_square) = bend_axis(cross(u, l), known, (sin * d).checked_div(b).unwrap_or(0));
        let axis = match (bend, pole) {
            (Some(axis), _) => axis,
            // Never bent: the pole, or any direction across.
            (None, Some(pole)) => match direction(pole).and_then(|(pole, _)| direction(cross(pole, e))) {
                Some((axis, _)) => axis,
                None => return failed,
            },
            (None, None) => match direction(cross(e, [ONE, 0, 0])) {
                Some((axis, _)) => axis,
                None => [0, 0, ONE],
            },
        };
        let Some((n, _)) = direction(match pole {
            Some(pole) => match direction(pole) {
                Some((pole, _)) => sub(pole, times(e, dot(pole, e))),
                None => return failed,
            },
            None => cross(e, axis),
        }) else {
            return failed;
        };
        let along = |v: Vector, by: i32| v.map(|x| (x * by) >> 15);
        // In the plane of the target and the bend: unit vectors, and at right angles to the new axis.
        let new_u = add(along(e, cos), along(n, sin));
        let new_l = unit(sub(times(e, reached), times(new_u, self.upper.0)), self.lower);
        let new_axis = cross(n, e);
        let squared =
            |bone: Vector| if is_square { Some(axis) } else { direction(cross(cross(bone, axis), bone)).map(|(axis, _)| axis) };
        let (Some(old_axis_u), Some(old_axis_l)) = (squared(u), squared(l)) else { return failed };
        let new_hip = between((u, old_axis_u), (new_u, new_axis)).then(&hip.rotation);
        let new_shin = between((l, old_axis_l), (new_l, new_axis)).then(&knee.rotation);
        first.write(&above.rotation, &new_hip, pose);
        second.write(&new_hip, &new_shin, pose);
        third.write(&new_shin, &ankle.rotation, pose);
        let mut off = (distance - reached).abs();
        if [first, second, third].iter().any(|bone| bone.is_hinge()) {
            // Joints with fewer than three angles cannot leave their plane.
            let end = third.after(&second.after(&first.after(above, pose, shift), pose, shift), pose, shift);
            off = direction(sub(target, end.place)).map_or(0, |(_, length)| length);
        }
        Reach { error: shifted(off, -shift).unsigned_abs(), within: distance == reached }
    }
}

/// The axis about which a limb bends to a sine of `wanted`, and whether it is square to both bones; `None` if it was never bent. `own` is the bend of the
/// pose and stays; what is added is about the remembered axis, as nearly straight limbs bend to any side. A bend the other way does not stay.
fn bend_axis(own: Vector, known: Option<Vector>, wanted: i32) -> (Option<Vector>, bool) {
    let bend = direction(own);
    let Some(known) = known else {
        let bend = bend.filter(|(_, sine)| *sine > LEAST_SINE).map(|(axis, _)| axis);
        return (bend, bend.is_some());
    };
    let back = bend.map_or(0, |(axis, sine)| ((sine.min(2 * ONE) >> 1) * dot(axis, known).min(0)) >> 14);
    let (stays, bend) = if back < 0 {
        let stays = sub(own, times(known, back));
        (stays, direction(stays))
    } else {
        (own, bend)
    };
    let added = wanted.max(LEAST_SINE) - bend.map_or(0, |(_, sine)| sine);
    match bend {
        Some((axis, _)) if added <= 0 => (Some(axis), back == 0),
        _ => (Some(direction(add(stays, times(known, added))).map_or(known, |(axis, _)| axis)), false),
    }
}

fn far(way: Vector) -> u64 {
    way.map(|x| u64::from(x.unsigned_abs()).pow(2)).iter().sum::<u64>().isqrt()
}

/// The direction of a bone whose length is known: a product in place of a root.
fn unit(v: Vector, (length, inverse): (i32, i32)) -> Vector {
    v.map(|x| (x.max(-length).min(length) * inverse) >> 14)
}
