//! Rotations between the forms in which clips code them, in integers.

use crate::groups::{Shape, order};
use pantin::{Angle, Component, Kinds, Turn};

/// A rotation as a unit quaternion w, x, y, z.
pub(crate) type Unit = [Component; 4];

/// No rotation.
pub(crate) const NO_ROTATION: Unit = [Component::ONE, Component::ZERO, Component::ZERO, Component::ZERO];

/// The exponential map of a unit quaternion, of at most half a turn.
pub(crate) fn map_of(q: Unit) -> [i32; 3] {
    // 0 to 1/2 turn; 1/2 itself is negative as an angle.
    let angle = i64::from(Turn::Quaternion(q).angle().to_bits().unsigned_abs());
    let [w, x, y, z] = q.map(Component::to_bits);
    let square = |x: i32| u64::from(x.unsigned_abs()).pow(2);
    let sine = square(x).saturating_add(square(y)).saturating_add(square(z)).isqrt() as i64;
    let sign = if w < 0 { -1 } else { 1 };
    // Below 2^31 times 2^31.
    let part = |x: i32| (sign * i64::from(x) * angle).checked_div(sine).unwrap_or(0);
    [x, y, z].map(|x| part(x).clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32)
}

/// The rotation that a group of channels is; `None` for channels that are each by themselves.
pub(crate) fn turn_of(shape: Shape, kinds: Kinds<'_>, own: &[i32]) -> Option<Turn> {
    Some(match (shape, own) {
        (Shape::Euler, &[a, b, c, ..]) => Turn::Euler { order: order(kinds)?, angles: [a, b, c].map(Angle::from_bits) },
        (Shape::Map, &[..]) => Turn::Exponential(ordered::<3>(kinds, own).map(Angle::from_bits)),
        (Shape::Quaternion, &[..]) => Turn::Quaternion(ordered::<4>(kinds, own).map(Component::from_bits)),
        _ => return None,
    })
}

/// Writes a rotation into a group of channels.
pub(crate) fn write(shape: Shape, kinds: Kinds<'_>, q: Unit, own: &mut [i32]) {
    match shape {
        Shape::Euler => {
            let Some(order) = order(kinds) else { return };
            for (own, angle) in own.iter_mut().zip(Turn::Quaternion(q).euler(order)) {
                *own = angle.to_bits();
            }
        }
        Shape::Map => {
            let map = map_of(q);
            for (at, own) in places(kinds, 3).zip(own) {
                *own = map.get(at).copied().unwrap_or(0);
            }
        }
        Shape::Quaternion => {
            for (at, own) in places(kinds, 4).zip(own) {
                *own = q.get(at).copied().unwrap_or(Component::ZERO).to_bits();
            }
        }
        Shape::Free => {}
    }
}

/// Which component each channel of a map or a quaternion holds. The angles of a joint that is coded as a map hold x, y, z in turn.
fn places(kinds: Kinds<'_>, count: usize) -> impl Iterator<Item = usize> {
    kinds.filter(|kind| !kind.is_position()).enumerate().map(move |(at, kind)| match kind {
        _ if kind.is_rotation() => at,
        _ if count == 4 => kind.axis().map_or(0, |axis| axis + 1),
        _ => kind.axis().unwrap_or(0),
    })
}

fn ordered<const N: usize>(kinds: Kinds<'_>, own: &[i32]) -> [i32; N] {
    let mut values = [0; N];
    for (at, own) in places(kinds, N).zip(own) {
        if let Some(value) = values.get_mut(at) {
            *value = *own;
        }
    }
    values
}
