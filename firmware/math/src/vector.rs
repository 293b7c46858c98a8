//! Vectors and rotations in Q15: what inverse kinematics computes with, in products of 32 bits.

use crate::rotation::{Rotation, Vector, inverse_length};
use crate::trig::ONE;

/// The first vector minus the second one; wraps.
pub fn sub([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [a.wrapping_sub(x), b.wrapping_sub(y), c.wrapping_sub(z)]
}

/// The sum of two vectors; wraps.
pub fn add([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [a.wrapping_add(x), b.wrapping_add(y), c.wrapping_add(z)]
}

/// The vector product of two of length 1 at most, in Q15.
pub fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    let narrow = |q30: i32| (q30 + (1 << 14)) >> 15;
    [narrow(b * z - c * y), narrow(c * x - a * z), narrow(a * y - b * x)]
}

/// The scalar product of two of length 1 at most, in Q15.
pub fn dot([a, b, c]: Vector, [x, y, z]: Vector) -> i32 {
    (a * x + b * y + c * z + (1 << 14)) >> 15
}

/// A vector of length 1 at most, times a length below 2^16 in Q0.
pub fn times(v: Vector, by: i32) -> Vector {
    let by = by.clamp(-0xffff, 0xffff);
    v.map(|x| (x.clamp(-ONE, ONE) * (by >> 1)) >> 14)
}

/// The length of a vector, and its direction in Q15; none for a vector of no length. A length past 2^30 is cut off.
#[inline(never)]
pub fn direction([x, y, z]: Vector) -> Option<(Vector, i32)> {
    let largest = x.unsigned_abs() | y.unsigned_abs() | z.unsigned_abs();
    if largest == 0 {
        return None;
    }
    // The largest component below 2^31, and at least 2^30 if it is not the one number that is 2^31.
    let up = largest.leading_zeros().max(1) - 1;
    let (x, y, z) = (x << up, y << up, z << up);
    // It goes to 2^14 .. 2^15, the squares sum to 2^28 .. 3 * 2^30; short of 2^30 there is room for a bit more.
    let mut down = 16;
    let (mut a, mut b, mut c) = (x >> 16, y >> 16, z >> 16);
    let mut sum = (a * a) as u32 + (b * b) as u32 + (c * c) as u32;
    if sum < 1 << 30 {
        down = 15;
        (a, b, c) = (x >> 15, y >> 15, z >> 15);
        sum = (a.wrapping_mul(a) as u32).saturating_add(b.wrapping_mul(b) as u32).saturating_add(c.wrapping_mul(c) as u32);
    }
    // Q15. No product passes 2^31: no component is longer than the vector.
    let inverse = inverse_length(sum)? >> 7;
    let unit = |x: i32| (x * inverse + (1 << 14)) >> 15;
    let length = (((sum >> 16) + (sum >> 15 & 1)) as i32 * inverse) >> 14;
    let shift = down - up as i32;
    Some(([unit(a), unit(b), unit(c)], if shift < 0 { length >> -shift } else { length.min(1 << 30 >> shift) << shift }))
}

/// The rotation from one frame of three unit vectors to another: each frame is a vector, one at a right angle to it, and their product.
pub fn between(from: (Vector, Vector), to: (Vector, Vector)) -> Rotation {
    let columns = |(a, b): (Vector, Vector)| Rotation([a, b, cross(a, b)]);
    columns(to).then(&transposed(&columns(from)))
}

/// The inverse rotation: rows become columns.
pub fn transposed(Rotation([[a, b, c], [d, e, f], [g, h, i]]): &Rotation) -> Rotation {
    Rotation([[*a, *d, *g], [*b, *e, *h], [*c, *f, *i]])
}

/// The shortest rotation from one unit vector to another; none where they are opposite.
pub fn swing(from: Vector, to: Vector) -> Option<Rotation> {
    let [x, y, z] = cross(from, to);
    let cos = dot(from, to);
    // 1 + cos is at least 2^-5: opposite to within 14 degrees there is no one shortest way.
    let under = ONE + cos;
    if under < ONE >> 5 {
        return None;
    }
    let factor = (1 << 30) / under;
    // Products of Q15, times 1 / (1 + cos), which is below 2^5: in two steps.
    let part = |a: i32, b: i32| (((a * b) >> 15) * (factor >> 3)) >> 12;
    Some(Rotation([
        [cos + part(x, x), part(x, y) + z, part(x, z) - y],
        [part(x, y) - z, cos + part(y, y), part(y, z) + x],
        [part(x, z) + y, part(y, z) - x, cos + part(z, z)],
    ]))
}
