//! Rotations: Q15 matrices, turned by Euler angles, exponential maps and quaternions.
//!
//! Every product fits 32 bits because rows and columns of a rotation are unit vectors: no partial sum of their products
//! exceeds 1, that is 2^30.

use crate::trig::{FRACTION_BITS, HALF, ONE, WORKED_OUT, angle_of_unit, series, sin_cos, table};
use crate::vector::direction;
use pantin::{Component, Turn};

/// A vector: Q15 for directions, figure units for places.
pub type Vector = [i32; 3];

/// A vector, axis by axis: where it is to be small, less code than an array of the library's.
#[inline(always)]
pub fn vector(of: impl Fn(usize) -> i32) -> Vector {
    [of(0), of(1), of(2)]
}

/// What forward kinematics asks of a rotation, however it is held.
pub trait RotationBackend: Copy {
    /// No rotation.
    const NONE: Self;

    /// Becomes another one: number by number, since a whole one would go through the library's memory move.
    fn become_as(&mut self, other: &Self);

    /// What a camera starts from: a rotation times a factor of at most 1.13.
    fn of_view(view: &Rotation) -> Self;

    /// This rotation after a turn about its own `axis` (0, 1, 2 for x, y, z) by an angle in 2^-32 turns.
    fn turn(&mut self, axis: usize, angle: i32);

    /// This rotation after one by an exponential map (axis times angle), each component in 2^-32 turns.
    fn turn_exponential(&mut self, map: Vector);

    /// This rotation after one by a quaternion w, x, y, z of any length but 0, which is taken for no rotation.
    fn turn_quaternion(&mut self, q: [i32; 4]);

    /// The image of a vector whose components lie within -2^14 .. 2^14.
    fn rotate(&self, v: Vector) -> Vector;

    /// The image of a vector of any length: cut off at 2^29.
    fn rotate_any(&self, v: Vector) -> Vector;
}

impl RotationBackend for Rotation {
    const NONE: Self = Rotation::IDENTITY;

    #[inline(always)]
    fn become_as(&mut self, other: &Self) {
        for (own, other) in self.0.iter_mut().zip(&other.0) {
            (own[0], own[1], own[2]) = (other[0], other[1], other[2]);
        }
    }

    fn of_view(view: &Rotation) -> Self {
        *view
    }

    #[inline(always)]
    fn turn(&mut self, axis: usize, angle: i32) {
        Rotation::turn(self, axis, angle);
    }

    fn turn_exponential(&mut self, map: Vector) {
        *self = self.then(&Rotation::of_exponential(map));
    }

    fn turn_quaternion(&mut self, q: [i32; 4]) {
        *self = self.then(&Rotation::of_quaternion(q));
    }

    #[inline(always)]
    fn rotate(&self, v: Vector) -> Vector {
        self.apply(v)
    }

    fn rotate_any(&self, v: Vector) -> Vector {
        self.apply_any(v)
    }
}

/// A rotation as its three columns: the images of the x, y and z axes, in Q15.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rotation(pub [Vector; 3]);

impl Rotation {
    /// No rotation.
    pub const IDENTITY: Rotation = Rotation([[ONE, 0, 0], [0, ONE, 0], [0, 0, ONE]]);

    /// This rotation after a turn about its own `axis` by an angle in 2^-32 turns.
    pub fn turn(&mut self, axis: usize, angle: i32) {
        if angle == 0 {
            return;
        }
        let (sin, cos) = sin_cos(angle);
        let [x, y, z] = &mut self.0;
        let (b, c) = match axis {
            0 => (y, z),
            1 => (z, x),
            _ => (x, y),
        };
        let mix = |b: &mut i32, c: &mut i32| {
            let (from_b, from_c) = (*b, *c);
            *b = (from_b * cos + from_c * sin + HALF) >> FRACTION_BITS;
            *c = (from_c * cos - from_b * sin + HALF) >> FRACTION_BITS;
        };
        mix(&mut b[0], &mut c[0]);
        mix(&mut b[1], &mut c[1]);
        mix(&mut b[2], &mut c[2]);
    }

    /// The image of a vector whose components lie within -2^15 .. 2^15 and whose length is below 2^16.
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub fn apply(&self, v: Vector) -> Vector {
        let [x, y, z] = &self.0;
        let row = |row: usize| (x[row] * v[0] + y[row] * v[1] + z[row] * v[2] + HALF) >> FRACTION_BITS;
        [row(0), row(1), row(2)]
    }

    /// The image of a vector of any length: cut off at 2^29.
    pub fn apply_any(&self, v: Vector) -> Vector {
        if v.iter().all(|x| (-(1 << 14)..1 << 14).contains(x)) { self.apply(v) } else { self.apply_wide(v) }
    }

    /// The image of a vector of up to 2^29, in two halves: the product of an element with each fits 32 bits.
    #[inline(never)]
    fn apply_wide(&self, v: Vector) -> Vector {
        let high = v.map(|x| x.clamp(-(1 << 29), 1 << 29) >> FRACTION_BITS);
        let low = self.apply(v.map(|x| x & (ONE - 1)));
        let [x, y, z] = &self.0;
        core::array::from_fn(|row| x[row] * high[0] + y[row] * high[1] + z[row] * high[2] + low[row])
    }

    /// This rotation after `local`.
    pub fn then(&self, local: &Rotation) -> Rotation {
        Rotation(local.0.map(|column| self.apply(column)))
    }

    /// The angles about three axes (0, 1, 2 for x, y, z), the first one first, in 2^-32 turns: of which the rotation is the turns about them one after the other, each
    /// about the axis as turned by those before. Within 2e-4 turns. The first two axes must differ, and the third is the one that is left.
    pub fn euler(&self, [i, j, k]: [usize; 3]) -> [i32; 3] {
        let Rotation(columns) = self;
        let at = |row: usize, column: usize| columns.get(column).and_then(|column| column.get(row)).copied().unwrap_or(0);
        // Where there is no division, a remainder is a call.
        let sign = if matches!((i, j), (0, 1) | (1, 2) | (2, 0)) { 1 } else { -1 };
        let narrow = |q30: i32| q30 >> FRACTION_BITS;
        // Its length is the second angle's cosine; the others are unit vectors.
        let c = direction([at(i, i), -sign * at(i, j), 0]).map_or(0, |([x, y, _], _)| angle_of_unit(y, x));
        let (sin, cos) = sin_cos(c);
        let cos_b = narrow(at(i, i) * cos - sign * at(i, j) * sin);
        let b = angle_of_unit(sign * at(i, k), cos_b);
        let image = |row: usize| narrow(sign * at(row, i) * sin + at(row, j) * cos);
        let a = angle_of_unit(sign * image(k), image(j));
        [a, b, c]
    }

    /// The unit quaternion w, x, y, z, by its largest component (Shepperd 1978).
    pub fn quaternion(&self) -> [Component; 4] {
        let Rotation([x, y, z]) = self;
        let ([xx, xy, xz], [yx, yy, yz], [zx, zy, zz]) = (*x, *y, *z);
        let one = 1 << FRACTION_BITS;
        // Four times the product of the largest component with each; `xy` is row y of column x.
        let of_w = [one + xx + yy + zz, yz - zy, zx - xz, xy - yx];
        let of_x = [yz - zy, one + xx - yy - zz, xy + yx, zx + xz];
        let of_y = [zx - xz, xy + yx, one - xx + yy - zz, yz + zy];
        let of_z = [xy - yx, zx + xz, yz + zy, one - xx - yy + zz];
        let [w, _, _, _] = of_w;
        let [_, x, _, _] = of_x;
        let [_, _, y, _] = of_y;
        let [_, _, _, z] = of_z;
        let q = if w >= x && w >= y && w >= z {
            of_w
        } else if x >= y && x >= z {
            of_x
        } else if y >= z {
            of_y
        } else {
            of_z
        };
        // Below 2^18: normalized by the decoder.
        Turn::Quaternion(q.map(|x| Component::from_bits(x << 12))).quaternion()
    }

    /// The rotation of a quaternion w, x, y, z of length 1 in Q15.
    fn of_unit([w, x, y, z]: [i32; 4]) -> Rotation {
        // Q30 to Q15, times two. |ab| + |cd| of four components of a unit quaternion is at most 1/2.
        let twice = |q30: i32| (q30 + (1 << 13)) >> 14;
        Rotation([
            [ONE - twice(y * y + z * z), twice(x * y + w * z), twice(x * z - w * y)],
            [twice(x * y - w * z), ONE - twice(x * x + z * z), twice(y * z + w * x)],
            [twice(x * z + w * y), twice(y * z - w * x), ONE - twice(x * x + y * y)],
        ])
    }

    /// The rotation of a quaternion w, x, y, z of any length but 0 (which is taken for no rotation). Elements are within 1.2e-4 of
    /// the true rotation's.
    pub fn of_quaternion(q: [i32; 4]) -> Rotation {
        unit(q).map_or(Rotation::IDENTITY, Rotation::of_unit)
    }

    /// The rotation of an exponential map (axis times angle), each component in 2^-32 turns: any angle that three components
    /// of up to half a turn can give. Elements are within 1.5e-4 of the true rotation's.
    pub fn of_exponential(map: Vector) -> Rotation {
        // 2^15 is half a turn; the three squares sum to at most 3 * 2^30. A component is h + l / 2^12: its square h^2 + 2 h l / 2^12.
        let square = |x: i32| (x >> 16) * (x >> 16) + (((x >> 16) * ((x >> 4) & 0xfff)) >> 11);
        let square = map.iter().fold(0, |sum: u32, &x| sum.saturating_add_signed(square(x)));
        let index = (square >> 24) as usize;
        let place = ((square >> 12) & 0xfff) as i32;
        let Some((from, to)) = two(&HALF_ANGLE, half_angle, index) else { return Rotation::IDENTITY };
        let between = |from: i32, to: i32| from + (((to - from) * place) >> 12);
        let (w, scale) = (between(from[0], to[0]), between(from[1], to[1]));
        // Components in 17 bits, the scale's 16 and 7 bits apart: all products fit.
        let [x, y, z] = map.map(|x| {
            let x = shift_right(x, 15);
            (x * (scale >> 7) + ((x * (scale & 0x7f)) >> 7) + HALF) >> FRACTION_BITS
        });
        Rotation::of_unit([shift_right(w, TABLE_BITS - 15), x, y, z])
    }
}

/// Intervals of [`HALF_ANGLE`]: squares of up to 3 * 2^30, in steps of 2^24.
const INTERVALS: usize = 192;

/// Fraction bits of the cosines of [`HALF_ANGLE`]; its scales have one less.
const TABLE_BITS: i32 = 22;

/// Cosine of half the angle, and pi/2 times its sine over it, by the square of the half angle, in 2^24 / 2^30 of (pi/2)^2.
/// A step of the table stays below 2^18. Linear between: the cosine's second derivative, at most 1/12, leaves 1.6e-5.
static HALF_ANGLE: [[i32; 2]; INTERVALS + 2] = table!(half_angle, INTERVALS + 2);

const fn half_angle(index: usize) -> [i32; 2] {
    const ONE_TABLE: f64 = (1 << TABLE_BITS) as f64;
    const QUARTER_TURN: f64 = core::f64::consts::FRAC_PI_2;
    let square = index as f64 / 64.0 * QUARTER_TURN * QUARTER_TURN;
    [round(series(square, 0.0) * ONE_TABLE), round(QUARTER_TURN * series(square, 1.0) * ONE_TABLE / 2.0)]
}

/// Two entries in a row.
#[inline(always)]
fn two<T: Copy>(table: &[T], entry: impl Fn(usize) -> T, index: usize) -> Option<(T, T)> {
    if WORKED_OUT {
        return (index + 1 < table.len()).then(|| (entry(index), entry(index + 1)));
    }
    Some((*table.get(index)?, *table.get(index + 1)?))
}

/// Inverse square roots (Q22) of 1 .. 4 in steps of 1/128. Linear between: the second derivative, at most 3/4, leaves 6e-6.
static INVERSE_ROOT: [i32; 386] = table!(inverse_root, 386);

const fn inverse_root(index: usize) -> i32 {
    let x = 1.0 + index as f64 / 128.0;
    let (mut root, mut step) = (x, 0);
    while step < 40 {
        root = (root + x / root) / 2.0;
        step += 1;
    }
    round((1 << TABLE_BITS) as f64 / root)
}

const fn round(x: f64) -> i32 {
    if x < 0.0 { (x - 0.5) as i32 } else { (x + 0.5) as i32 }
}

/// The quaternion of length 1 in Q15.
fn unit(q: [i32; 4]) -> Option<[i32; 4]> {
    let largest = q.iter().fold(0, |largest, x| largest | x.unsigned_abs());
    if largest == 0 {
        return None;
    }
    // The largest component goes to 2^14 .. 2^15, the squares sum to 2^28 .. 2^32; short of 2^30 there is room for a bit more.
    let mut shift = 17 - largest.leading_zeros() as i32;
    let mut square = square_of(q.map(|x| shift_right(x, shift)));
    if square < 1 << 30 {
        shift -= 1;
        square = square_of(q.map(|x| shift_right(x, shift)));
    }
    let inverse = inverse_length(square)?;
    Some(q.map(|x| {
        let x = shift_right(x, shift);
        (x * (inverse >> 7) + ((x * (inverse & 0x7f)) >> 7) + HALF) >> FRACTION_BITS
    }))
}

/// The inverse of a length in Q22 by its square, 2^30 (a length of 1) to 2^32: within 6e-6. None for greater ones than the table has, which do not occur.
#[inline]
pub fn inverse_length(square: u32) -> Option<i32> {
    let above = square.saturating_sub(1 << 30);
    let index = (above >> 23) as usize;
    let place = ((above >> 8) & 0x7fff) as i32;
    let (from, to) = two(&INVERSE_ROOT, inverse_root, index)?;
    Some(from + (((to - from) * place) >> FRACTION_BITS))
}

fn square_of(q: [i32; 4]) -> u32 {
    q.iter().fold(0, |sum, &x| sum.saturating_add(x.unsigned_abs().saturating_mul(x.unsigned_abs())))
}

/// `value` / 2^`shift`, rounded; a negative shift multiplies and saturates.
#[inline(never)]
pub fn shift_right(value: i32, shift: i32) -> i32 {
    match shift {
        32.. => 0,
        1.. => (value >> (shift - 1)).saturating_add(1) >> 1,
        0 => value,
        -31..0 if value.unsigned_abs().leading_zeros() as i32 > -shift => value << -shift,
        _ if value == 0 => 0,
        _ if value < 0 => -i32::MAX,
        _ => i32::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rodrigues' formula about a unit axis.
    fn about(axis: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
        let (sin, cos) = angle.sin_cos();
        let [x, y, z] = axis;
        let t = 1.0 - cos;
        [
            [t * x * x + cos, t * x * y + sin * z, t * x * z - sin * y],
            [t * x * y - sin * z, t * y * y + cos, t * y * z + sin * x],
            [t * x * z + sin * y, t * y * z - sin * x, t * z * z + cos],
        ]
    }

    fn worst(rotation: &Rotation, truth: [[f64; 3]; 3]) -> f64 {
        let pairs = rotation.0.iter().flatten().zip(truth.iter().flatten());
        pairs.fold(0.0, |worst, (&got, want)| worst.max((f64::from(got) / 32768.0 - want).abs()))
    }

    /// Numbers in -1 .. 1 from a fixed sequence.
    fn sequence() -> impl FnMut() -> f64 {
        let mut random = fastrand::Rng::with_seed(1);
        move || random.f64() * 2.0 - 1.0
    }

    fn unit_vector(next: &mut impl FnMut() -> f64) -> [f64; 3] {
        loop {
            let v = [next(), next(), next()];
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.1..1.0).contains(&length) {
                return v.map(|x| x / length);
            }
        }
    }

    #[test]
    fn exponential_maps_keep_the_stated_error_up_to_any_angle_they_can_hold() {
        let (mut next, mut error) = (sequence(), 0.0f64);
        for _ in 0..200_000 {
            let axis = unit_vector(&mut next);
            // Up to 1.7 half turns where no component passes half a turn.
            let turns = (next() * 0.86).clamp(-0.49 / axis.map(f64::abs).iter().fold(0.0f64, |a, &b| a.max(b)), 0.49);
            let raw = axis.map(|x| (x * turns * 4294967296.0) as i64 as i32);
            let truth = about(raw.map(|x| f64::from(x) / (turns * 4294967296.0)), turns * std::f64::consts::TAU);
            error = error.max(worst(&Rotation::of_exponential(raw), truth));
        }
        assert!(error < 1.5e-4, "{error}");
    }

    #[test]
    fn quaternions_of_any_length_are_normalized() {
        let (mut next, mut error) = (sequence(), 0.0f64);
        for _ in 0..200_000 {
            let (axis, angle) = (unit_vector(&mut next), next() * 4.0);
            let (sin, cos) = (angle / 2.0).sin_cos();
            let length = 2f64.powf(next() * 6.0 + 24.5);
            let q = [cos, sin * axis[0], sin * axis[1], sin * axis[2]].map(|x| (x * length) as i32);
            error = error.max(worst(&Rotation::of_quaternion(q), about(axis, angle)));
        }
        assert!(error < 1.2e-4, "{error}");
        assert_eq!(Rotation::of_quaternion([0; 4]), Rotation::IDENTITY);
        Rotation::of_quaternion([i32::MIN; 4]);
    }

    #[test]
    fn no_rotation_is_exact() {
        assert_eq!(Rotation::of_exponential([0; 3]), Rotation::IDENTITY);
        assert_eq!(Rotation::of_quaternion([1 << 30, 0, 0, 0]), Rotation::IDENTITY);
        assert_eq!(Rotation::IDENTITY.apply([1, -2, 16383]), [1, -2, 16383]);
        assert_eq!(Rotation::IDENTITY.apply_wide([-123_456_789, 1 << 28, 7]), [-123_456_789, 1 << 28, 7]);
    }
}
