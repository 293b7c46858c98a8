//! The channels of a pose in groups that are one rotation, one place or one scalar: read from the rig once, then used frame by frame.

use crate::Error;
use pantin::{EulerOrder, FormRef, Kind, Rig};

/// What a group of channels is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum Shape {
    /// Each channel by itself: places, scalars, one or two Euler angles.
    #[default]
    Free,
    /// Three Euler angles about different axes: a, b, c are also a + 1/2, 1/2 - b, c + 1/2 turns.
    Euler,
    /// An exponential map: the same rotation has another one that is a turn shorter or longer.
    Map,
    /// A quaternion, whose negative is the same rotation.
    Quaternion,
}

/// Channels that belong together: 6 bytes. [`crate::Animator`] is lent one for each joint with channels, another for a joint that also has
/// position channels, and one for each scalar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Group {
    pub(crate) first: u16,
    /// The bit of a mask: a joint's index, or the number of joints plus a scalar's.
    pub(crate) bit: u16,
    pub(crate) len: u8,
    pub(crate) shape: Shape,
}

impl Group {
    /// What fills memory before an animator takes it.
    pub const NONE: Group = Group { first: 0, bit: 0, len: 0, shape: Shape::Free };

    /// Fills `groups` with those of a clip's poses, and returns how many they are.
    pub fn of_clip(clip: &pantin::Clip<'_>, groups: &mut [Group]) -> Result<usize, Error> {
        set_up(&clip.rig(), clip.form_ref(), groups)
    }

    #[inline(always)]
    pub(crate) fn range(&self) -> core::ops::Range<usize> {
        usize::from(self.first)..usize::from(self.first) + usize::from(self.len)
    }
}

/// Fills `groups` with those of a rig whose poses have a form, and returns those in use.
#[inline(never)]
pub(crate) fn set_up(rig: &Rig<'_>, form: FormRef<'_>, groups: &mut [Group]) -> Result<usize, Error> {
    let form = form.to_form();
    let mut used = 0usize;
    let mut push = |group: Group| {
        if let Some(place) = groups.get_mut(used) {
            *place = group;
        }
        used += 1;
    };
    let mut choices = 0usize;
    for (joint, bit) in rig.joints().zip(0..) {
        let turns = { joint.kinds }.filter(|kind| kind.is_rotation()).count();
        let mut exponential = false;
        if turns == 3 {
            exponential = form.exponentials().nth(choices / 8).is_some_and(|byte| byte >> (choices % 8) & 1 != 0);
            choices += 1;
        }
        // Runs of channels of one family.
        let mut run = Group { bit, first: joint.first_channel, ..Group::NONE };
        let mut family = 0;
        let mut close = |run: Group, family: u8| {
            let shape = match (family, run.len) {
                (1, 3) if exponential => Shape::Map,
                (1, 3) if is_order(joint.kinds) => Shape::Euler,
                (2, 4) => Shape::Quaternion,
                (3, 3) => Shape::Map,
                _ => Shape::Free,
            };
            if run.len > 0 {
                push(Group { shape, ..run });
            }
        };
        for (kind, channel) in joint.kinds.zip(joint.first_channel..) {
            let own = family_of(kind);
            if own != family {
                close(run, family);
                (run.first, run.len, family) = (channel, 0, own);
            }
            run.len += 1;
        }
        close(run, family);
    }
    let (first, bit) = (rig.joint_channels() as u16, rig.joint_count() as u16);
    for scalar in 0..rig.channels().saturating_sub(rig.joint_channels()) as u16 {
        push(Group { first: first + scalar, bit: bit + scalar, len: 1, shape: Shape::Free });
    }
    if used > groups.len() { Err(Error::TooSmall { what: "groups", needed: used, given: groups.len() }) } else { Ok(used) }
}

fn family_of(kind: Kind) -> u8 {
    match kind {
        _ if kind.is_rotation() => 1,
        _ if kind.is_quaternion() => 2,
        _ if kind.is_exponential() => 3,
        _ => 4,
    }
}

/// Whether the rotations of a joint are about three different axes.
fn is_order(kinds: pantin::Kinds<'_>) -> bool {
    order(kinds).is_some()
}

/// The Euler order of a joint with three rotations.
pub(crate) fn order(kinds: pantin::Kinds<'_>) -> Option<EulerOrder> {
    let mut axes = kinds.filter(|kind| kind.is_rotation()).filter_map(|kind| match kind {
        Kind::Xrotation => Some(pantin::Axis::X),
        Kind::Yrotation => Some(pantin::Axis::Y),
        Kind::Zrotation => Some(pantin::Axis::Z),
        _ => None,
    });
    let (first, second, third) = (axes.next()?, axes.next()?, axes.next()?);
    EulerOrder::of(first, second).filter(|order| order.axes() == [first, second, third])
}

/// Half a turn.
const HALF: i32 = i32::MIN;

/// An eighth of a turn. If each of three angles is nearer than this, the other three that are the same rotation are farther.
const NEAR: u32 = 1 << 29;

/// Whether two angles are within an eighth of a turn.
#[inline(always)]
pub(crate) fn is_near(from: i32, to: i32) -> bool {
    from.wrapping_sub(to).wrapping_add(NEAR as i32) as u32 <= 2 * NEAR
}

/// Writes to `from` what is the same rotation and nearest to `to`, a channel.
pub(crate) fn nearest(shape: Shape, from: &mut [i32], to: &[i32]) {
    if let (&mut [a, b, c], &[x, y, z]) = (&mut *from, to) {
        // Differences that wrap are those of angles, but not those of maps.
        let wraps = || [(a, x), (b, y), (c, z)].iter().any(|(from, to)| from.checked_sub(*to).is_none());
        if is_near(a, x) && is_near(b, y) && is_near(c, z) && !(shape == Shape::Map && wraps()) {
            return;
        }
    }
    any_nearest(shape, from, to);
}

/// [`nearest`] for any number of channels, however far.
#[inline(never)]
fn any_nearest(shape: Shape, from: &mut [i32], to: &[i32]) {
    let far = |from: &[i32]| from.iter().zip(to).fold(0u64, |sum, (a, b)| sum + u64::from(a.wrapping_sub(*b).unsigned_abs()));
    match (shape, from) {
        (Shape::Euler, from @ &mut [a, b, c]) => {
            let other = [a.wrapping_add(HALF), HALF.wrapping_sub(b), c.wrapping_add(HALF)];
            if far(&other) < far(from) {
                from.copy_from_slice(&other);
            }
        }
        (Shape::Map, from @ &mut [..]) => {
            let now = from.iter().zip(to).fold(0i64, |sum, (&a, &b)| sum + (i64::from(a) - i64::from(b)).abs());
            // A turn less is 2^32 away in these sums or farther, less 3 for rounding.
            if now < (1 << 31) - 3 {
                return;
            }
            // Below 2^64, and the root below 2^32.
            let length = from.iter().fold(0u64, |sum, &x| sum.saturating_add(u64::from(x.unsigned_abs()).pow(2))).isqrt() as i64;
            // A turn less, the other way.
            let shorter = |x: i32| (i64::from(x) * (length - (1 << 32))).checked_div(length).unwrap_or(0);
            let fits = from.iter().all(|&x| i32::try_from(shorter(x)).is_ok());
            let apart = from.iter().zip(to).fold(0i64, |sum, (&a, &b)| sum + (shorter(a) - i64::from(b)).abs());
            if length > 0 && fits && apart < now {
                for x in from {
                    *x = shorter(*x) as i32;
                }
            }
        }
        (Shape::Quaternion, from) => {
            let dot = from.iter().zip(to).fold(0i64, |sum, (&a, &b)| sum + ((i64::from(a) * i64::from(b)) >> 2));
            if dot < 0 {
                for x in from {
                    *x = x.wrapping_neg();
                }
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_of_two_maps_is_taken() {
        let mut random = fastrand::Rng::with_seed(3);
        let sum = |a: [f64; 3], b: [i32; 3]| a.iter().zip(b).map(|(a, b)| (a - f64::from(b)).abs()).sum::<f64>();
        let mut changed = 0;
        for shift in [0, 1, 2, 5, 20] {
            for _ in 0..20_000 {
                let [from, to] = [0; 2].map(|_| [0; 3].map(|_: i32| random.i32(-i32::MAX..) >> random.u8(0..=shift)));
                let own = from.map(f64::from);
                let length = own.iter().map(|x| x * x).sum::<f64>().sqrt();
                let other = own.map(|x| x * (1.0 - 4_294_967_296.0 / length));
                let mut nearer = from;
                nearest(Shape::Map, &mut nearer, &to);
                // Where they are about as far, either may be taken.
                if (sum(other, to) - sum(own, to)).abs() > 16.0 {
                    let fits = other.iter().all(|x| x.abs() < 2_147_483_600.0);
                    let expected = length > 0.0 && fits && sum(other, to) < sum(own, to);
                    let edge = !fits && other.iter().all(|x| x.abs() < 2_147_483_700.0);
                    assert!(edge || (nearer != from) == expected, "{from:?} {to:?}");
                }
                changed += usize::from(nearer != from);
            }
        }
        assert!(changed > 1000, "{changed}");
    }
}
