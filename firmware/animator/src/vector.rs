//! Vectors and rotations in Q15: what inverse kinematics computes with, in products of 32 bits.

use pantin_figure::rotation::Rotation;
pub(crate) use pantin_figure::rotation::Vector;
use pantin_figure::trig::ONE;

pub(crate) fn sub([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [a.wrapping_sub(x), b.wrapping_sub(y), c.wrapping_sub(z)]
}

pub(crate) fn add([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    [a.wrapping_add(x), b.wrapping_add(y), c.wrapping_add(z)]
}

/// The vector product of two of length 1 at most, in Q15.
pub(crate) fn cross([a, b, c]: Vector, [x, y, z]: Vector) -> Vector {
    let narrow = |q30: i32| (q30 + (1 << 14)) >> 15;
    [narrow(b * z - c * y), narrow(c * x - a * z), narrow(a * y - b * x)]
}

/// The scalar product of two of length 1 at most, in Q15.
pub(crate) fn dot([a, b, c]: Vector, [x, y, z]: Vector) -> i32 {
    (a * x + b * y + c * z + (1 << 14)) >> 15
}

/// A vector of length 1 at most, times a length below 2^16 in Q0.
pub(crate) fn times(v: Vector, by: i32) -> Vector {
    let by = by.clamp(-0xffff, 0xffff);
    v.map(|x| (x.clamp(-ONE, ONE) * (by >> 1)) >> 14)
}

/// The length of a vector, and its direction in Q15; none for a vector of no length. A length past 2^30 is cut off.
pub(crate) fn direction(v: Vector) -> Option<(Vector, i32)> {
    let v = v.map(|x| x.clamp(-(1 << 29), 1 << 29));
    let largest = v.iter().fold(0, |largest, x| largest | x.unsigned_abs());
    if largest == 0 {
        return None;
    }
    // The largest component goes to 2^14 .. 2^15; the squares sum to less than 3 * 2^30.
    let shift = 17 - largest.leading_zeros() as i32;
    let v = v.map(|x| if shift >= 0 { x >> shift } else { x << -shift });
    let length = v.iter().fold(0u32, |sum, x| sum.wrapping_add(x.unsigned_abs().wrapping_mul(x.unsigned_abs()))).isqrt();
    let inverse = (1u32 << 30).checked_div(length).unwrap_or(0) as i32;
    // Below 2^15 times 2^16.
    let unit = v.map(|x| (x * (inverse >> 1) + (1 << 13)) >> 14);
    let length = length as i32;
    Some((unit, if shift >= 0 { length << shift } else { length >> -shift }))
}

/// The rotation from one frame of three unit vectors to another: each frame is a vector, one at a right angle to it, and their product.
pub(crate) fn between(from: (Vector, Vector), to: (Vector, Vector)) -> Rotation {
    let columns = |(a, b): (Vector, Vector)| Rotation([a, b, cross(a, b)]);
    columns(to).then(&transposed(&columns(from)))
}

pub(crate) fn transposed(Rotation([[a, b, c], [d, e, f], [g, h, i]]): &Rotation) -> Rotation {
    Rotation([[*a, *d, *g], [*b, *e, *h], [*c, *f, *i]])
}

/// The shortest rotation from one unit vector to another; none where they are opposite.
pub(crate) fn swing(from: Vector, to: Vector) -> Option<Rotation> {
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
