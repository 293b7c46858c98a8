//! Turns about a line parallel to an axis: two coefficients a frame, whatever the interpolation.
//!
//! With r the way from a vertex's foot on the axis to it, e where r is after the whole angle W and n what a quarter turn makes of r,
//! e = cos W r + sin W n. Any mix a r + b e is therefore c r + s n:
//! - spherical, a = sin((1-t)W) / sin W and b = sin(tW) / sin W: c = cos tW, s = sin tW, which needs no division, nor care near W = 0;
//! - linear and eased, a = 1 - t and b = t: c = 1 + t (cos W - 1), s = t sin W.

use crate::morph::{Place, eased};
use crate::shape::{Interpolation, Turn};
use pantin_figure::trig::{FRACTION_BITS, ONE, sin_cos};

/// Both weights of a shape, and how a model's vertices are ordered.
#[derive(Clone, Copy)]
pub(crate) struct Sides {
    pub pair: [i32; 2],
    pub middles: usize,
    pub pairs: usize,
}

/// Turns the members: in the middle by the mean of both weights, elsewhere each side by its own, mirrored on the other side.
pub(crate) fn apply(turn: &Turn, interpolation: Interpolation, sides: Sides, places: &mut [Place]) {
    let [stored, mirrored] = sides.pair;
    let image = Turn {
        centre: [turn.centre[0].wrapping_neg(), turn.centre[1], turn.centre[2]],
        // A mirror keeps turns about x, and reverses the others.
        angle: if turn.axis == 0 { turn.angle } else { turn.angle.wrapping_neg() },
        ..*turn
    };
    for members in turn.members() {
        let first = usize::from(members.first);
        let range = first..first + usize::from(members.count);
        if first < sides.middles {
            let way = coefficients(turn.angle, members.part, interpolation, (stored + mirrored) >> 1);
            places.get_mut(range).into_iter().flatten().for_each(|place| move_about(turn, way, place));
            continue;
        }
        if stored != 0 {
            let way = coefficients(turn.angle, members.part, interpolation, stored);
            places.get_mut(range.clone()).into_iter().flatten().for_each(|place| move_about(turn, way, place));
        }
        let to_right = first < sides.middles + sides.pairs;
        let other = |index: usize| if to_right { index + sides.pairs } else { index.wrapping_sub(sides.pairs) };
        if mirrored != 0 {
            let way = coefficients(image.angle, members.part, interpolation, mirrored);
            let range = other(range.start)..other(range.end);
            places.get_mut(range).into_iter().flatten().for_each(|place| move_about(&image, way, place));
        }
    }
}

/// c and s, Q15, of a part (255ths) of an angle (2^-16 turns) at a weight (Q15).
pub(crate) fn coefficients(angle: i16, part: u8, interpolation: Interpolation, weight: i32) -> [i32; 2] {
    // 255 is the whole.
    let angle = (i32::from(angle) * (i32::from(part) + i32::from(part >> 7))) >> 8;
    if interpolation == Interpolation::Spherical {
        let (sin, cos) = sin_cos((angle * weight).wrapping_shl(1));
        return [cos, sin];
    }
    let t = eased(interpolation, weight);
    let (sin, cos) = sin_cos(angle.wrapping_shl(16));
    // A negative weight turns the other way: the cosine is the same on both sides.
    [ONE + ((t.abs() * ((cos - ONE) >> 1)) >> (FRACTION_BITS - 1)), (t * sin) >> FRACTION_BITS]
}

/// Coefficients are at most 1 and the radius below 2^15 steps: sums of two products stay within 2^31, else they wrap.
#[inline]
fn move_about(turn: &Turn, [c, s]: [i32; 2], place: &mut Place) {
    let (b, c_axis) = match turn.axis {
        0 => (1, 2),
        1 => (2, 0),
        _ => (0, 1),
    };
    let from_b = i32::from(place[b]) - i32::from(turn.centre[b]);
    let from_c = i32::from(place[c_axis]) - i32::from(turn.centre[c_axis]);
    let turned = |first: i32, second: i32| first.wrapping_add(second).wrapping_add(ONE / 2) >> FRACTION_BITS;
    let to_b = turned(from_b.wrapping_mul(c), from_c.wrapping_mul(-s));
    let to_c = turned(from_c.wrapping_mul(c), from_b.wrapping_mul(s));
    place[b] = to_b.wrapping_add(i32::from(turn.centre[b])) as i16;
    place[c_axis] = to_c.wrapping_add(i32::from(turn.centre[c_axis])) as i16;
}
