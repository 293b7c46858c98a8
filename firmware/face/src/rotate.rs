//! Rotates vertices about a line parallel to an axis: two coefficients per frame and angle, for every interpolation.
//!
//! Let r be the vector from the axis to a vertex, e the vector that r becomes after the whole angle W, and n the vector that it becomes after
//! a quarter turn. Then e = cos W r + sin W n, and any mix a r + b e has the form c r + s n:
//! - spherical, a = sin((1-t)W) / sin W and b = sin(tW) / sin W: c = cos tW, s = sin tW, without a division or a special case near W = 0;
//! - linear, improved linear and eased, a = 1 - t and b = t: c = 1 + t (cos W - 1), s = t sin W.

use crate::shape::{AxisRotation, Interpolation, eased};
use crate::vertex::Vertex;
use pantin_figure::trig::{FRACTION_BITS, ONE, sin_cos};

/// Both weights of a shape (Q15), and how many vertices the model has in the middle and on the left.
#[derive(Clone, Copy)]
pub(crate) struct SideWeights {
    pub pair: [i32; 2],
    pub middles: usize,
    pub pairs: usize,
}

/// Rotates the members: those in the middle by the mean of both weights, the others each side by its own, mirrored on the right.
pub(crate) fn rotate(rotation: &AxisRotation, interpolation: Interpolation, sides: SideWeights, vertices: &mut [Vertex]) {
    let [stored, mirrored] = sides.pair;
    let image = AxisRotation {
        centre: [rotation.centre[0].wrapping_neg(), rotation.centre[1], rotation.centre[2]],
        // A mirror keeps rotations about x, and reverses the others.
        angle: if rotation.axis == 0 { rotation.angle } else { rotation.angle.wrapping_neg() },
        ..*rotation
    };
    for members in rotation.members() {
        let first = usize::from(members.first);
        let range = first..first + usize::from(members.count);
        if first < sides.middles {
            let c_s = coefficients(rotation.angle, members.part, interpolation, (stored + mirrored) >> 1);
            vertices.get_mut(range).into_iter().flatten().for_each(|vertex| move_about(rotation, c_s, vertex));
            continue;
        }
        let c_s = coefficients(rotation.angle, members.part, interpolation, stored);
        if stored != 0 {
            vertices.get_mut(range.clone()).into_iter().flatten().for_each(|vertex| move_about(rotation, c_s, vertex));
        }
        let to_right = first < sides.middles + sides.pairs;
        let other = |index: usize| if to_right { index + sides.pairs } else { index.wrapping_sub(sides.pairs) };
        if mirrored != 0 {
            let is_same = image.angle == rotation.angle && mirrored == stored;
            let c_s = if is_same { c_s } else { coefficients(image.angle, members.part, interpolation, mirrored) };
            let range = other(range.start)..other(range.end);
            vertices.get_mut(range).into_iter().flatten().for_each(|vertex| move_about(&image, c_s, vertex));
        }
    }
}

/// c and s (Q15) of a part (255ths) of an angle (2^-16 turns) at a weight (Q15). In a function of its own: as a part of the loop over members it takes
/// more stack, and prepares interpolations that the shape does not have.
#[inline(never)]
pub(crate) fn coefficients(angle: i16, part: u8, interpolation: Interpolation, weight: i32) -> [i32; 2] {
    // 255 is the whole.
    let angle = (i32::from(angle) * (i32::from(part) + i32::from(part >> 7))) >> 8;
    if interpolation == Interpolation::Spherical {
        let (sin, cos) = sin_cos((angle * weight).wrapping_shl(1));
        return [cos, sin];
    }
    let t = eased(interpolation, weight);
    let (sin, cos) = sin_cos(angle.wrapping_shl(16));
    // A negative weight rotates the other way: the cosine is the same on both sides.
    [ONE + ((t.abs() * ((cos - ONE) >> 1)) >> (FRACTION_BITS - 1)), (t * sin) >> FRACTION_BITS]
}

/// Coefficients are at most 1 and radii are below 2^15 steps: sums of two products stay within 2^31, otherwise they wrap.
#[inline]
fn move_about(rotation: &AxisRotation, [c, s]: [i32; 2], vertex: &mut Vertex) {
    let (b, c_axis) = match rotation.axis {
        0 => (1, 2),
        1 => (2, 0),
        _ => (0, 1),
    };
    let from_b = i32::from(vertex[b]) - i32::from(rotation.centre[b]);
    let from_c = i32::from(vertex[c_axis]) - i32::from(rotation.centre[c_axis]);
    let rotated = |first: i32, second: i32| first.wrapping_add(second).wrapping_add(ONE / 2) >> FRACTION_BITS;
    let to_b = rotated(from_b.wrapping_mul(c), from_c.wrapping_mul(-s));
    let to_c = rotated(from_c.wrapping_mul(c), from_b.wrapping_mul(s));
    vertex[b] = to_b.wrapping_add(i32::from(rotation.centre[b])) as i16;
    vertex[c_axis] = to_c.wrapping_add(i32::from(rotation.centre[c_axis])) as i16;
}
