//! Rotations in floating point: for cores with a floating-point unit, and for comparison, as the integers take fewer instructions there too.
//!
//! Additions, multiplications and conversions alone, in the order in which they are written: a host computes the same bits. `micromath` has
//! the estimate of an inverse root. Its sine is not used: it takes an angle in radians, and so spends most of its instructions on finding the
//! angle's place in the turn, which an angle in 2^-32 turns has in its highest bits; and its error is 1.2e-3.

use crate::rotation::{Rotation, RotationBackend, Vector};
use crate::trig::ONE;
use core::f32::consts::TAU;
use micromath::F32Ext;

/// A rotation as the images of the x, y and z axes. Elements are within 4e-5 of the fixed-point rotation's after a turn about an axis, 1.7e-4
/// after an exponential map and 1.3e-4 after a quaternion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatRotation([[f32; 3]; 3]);

/// A turn is 2^32 of an angle's units.
const RADIANS: f32 = TAU / 4_294_967_296.0;

impl FloatRotation {
    fn then(&self, local: &[[f32; 3]; 3]) -> FloatRotation {
        FloatRotation(local.map(|column| self.apply(column)))
    }

    #[inline(always)]
    fn apply(&self, v: [f32; 3]) -> [f32; 3] {
        let [x, y, z] = &self.0;
        core::array::from_fn(|row| x[row] * v[0] + y[row] * v[1] + z[row] * v[2])
    }

    /// After a unit quaternion w, x, y, z.
    fn turn_unit(&mut self, [w, x, y, z]: [f32; 4]) {
        *self = self.then(&[
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
            [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
            [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]);
    }
}

/// Sine and cosine of an angle in 2^-32 turns, each within 1.3e-5 of the true value, and exact at quarter turns.
#[inline(always)]
fn sin_cos(angle: i32) -> (f32, f32) {
    // At most an eighth of a turn either way from a quarter turn.
    let quarter = (angle as u32).wrapping_add(1 << 29) >> 30;
    let rest = angle.wrapping_sub((quarter << 30) as i32) as f32 * RADIANS;
    let square = rest * rest;
    // The polynomials of these degrees with the least error.
    let sin = rest * (1.0 + square * (-0.166_628_34 + square * 0.008_152_992));
    let cos = 1.0 + square * (-0.499_776_3 + square * 0.040_488_935);
    let (sin, cos) = if quarter & 1 == 0 { (sin, cos) } else { (cos, -sin) };
    if quarter & 2 == 0 { (sin, cos) } else { (-sin, -cos) }
}

/// 1 / root: `micromath`'s estimate, and two of Newton's steps.
fn inverse_root(x: f32) -> f32 {
    let mut root = F32Ext::invsqrt(x);
    for _ in 0..2 {
        root *= 1.5 - 0.5 * x * root * root;
    }
    root
}

impl RotationBackend for FloatRotation {
    const NONE: Self = FloatRotation([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    #[inline(always)]
    fn become_as(&mut self, other: &Self) {
        for (own, other) in self.0.iter_mut().zip(&other.0) {
            (own[0], own[1], own[2]) = (other[0], other[1], other[2]);
        }
    }

    fn of_view(view: &Rotation) -> Self {
        FloatRotation(view.0.map(|column| column.map(|x| x as f32 / ONE as f32)))
    }

    #[inline(always)]
    fn turn(&mut self, axis: usize, angle: i32) {
        // As most joints turn about some of their axes only.
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
        for (b, c) in b.iter_mut().zip(c) {
            let (from_b, from_c) = (*b, *c);
            *b = from_b * cos + from_c * sin;
            *c = from_c * cos - from_b * sin;
        }
    }

    fn turn_exponential(&mut self, map: Vector) {
        const HALF: f32 = RADIANS / 2.0;
        let [x, y, z] = map.map(|x| x as f32);
        let square = x * x + y * y + z * z;
        // Below that the half angle's sine is the half angle.
        if square < 1e-8 / (HALF * HALF) {
            return self.turn_unit([1.0, x * HALF, y * HALF, z * HALF]);
        }
        let inverse = inverse_root(square);
        // Half of at most 2^31 times the root of 3: it fits.
        let (sin, cos) = sin_cos((square * inverse * 0.5) as i32);
        let scale = inverse * sin;
        self.turn_unit([cos, x * scale, y * scale, z * scale]);
    }

    fn turn_quaternion(&mut self, q: [i32; 4]) {
        let q = q.map(|x| x as f32 / 1_073_741_824.0);
        let square = q.iter().map(|x| x * x).sum::<f32>();
        if square > 0.0 {
            let inverse = inverse_root(square);
            self.turn_unit(q.map(|x| x * inverse));
        }
    }

    #[inline(always)]
    fn rotate(&self, v: Vector) -> Vector {
        self.apply(v.map(|x| x as f32)).map(|x| x as i32)
    }

    fn rotate_any(&self, v: Vector) -> Vector {
        self.rotate(v.map(|x| x.clamp(-(1 << 29), 1 << 29)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Turn<'a, R> = &'a dyn Fn(&mut R);

    fn worst(float: &FloatRotation, fixed: &Rotation) -> f32 {
        let pairs = float.0.iter().flatten().zip(fixed.0.iter().flatten());
        pairs.fold(0.0, |worst, (a, b)| worst.max((a - *b as f32 / ONE as f32).abs()))
    }

    #[test]
    fn every_turn_is_that_of_the_fixed_point_rotation_within_what_the_approximations_leave() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut next = || random.i32(..);
        let mut most = [0f32; 3];
        for _ in 0..100_000 {
            let values = [next(), next(), next(), next()];
            let turns: [(Turn<FloatRotation>, Turn<Rotation>); 3] = [
                (&|r| r.turn(1, values[0]), &|r| RotationBackend::turn(r, 1, values[0])),
                (&|r| r.turn_exponential([values[0], values[1], values[2]]), &|r| {
                    RotationBackend::turn_exponential(r, [values[0], values[1], values[2]])
                }),
                (&|r| r.turn_quaternion(values), &|r| RotationBackend::turn_quaternion(r, values)),
            ];
            for ((float_turn, fixed_turn), most) in turns.into_iter().zip(&mut most) {
                let (mut float, mut fixed) = (FloatRotation::NONE, Rotation::NONE);
                float_turn(&mut float);
                fixed_turn(&mut fixed);
                *most = most.max(worst(&float, &fixed));
            }
        }
        assert!(most[0] < 4e-5 && most[1] < 1.7e-4 && most[2] < 1.3e-4, "{most:?}");
    }

    #[test]
    fn sine_and_cosine_keep_the_stated_error() {
        let mut worst = 0f64;
        for step in 0..2_000_000u32 {
            let raw = step.wrapping_mul(4_294_967) as i32;
            let angle = f64::from(raw) / 4_294_967_296.0 * std::f64::consts::TAU;
            let (sin, cos) = sin_cos(raw);
            worst = worst.max((f64::from(sin) - angle.sin()).abs()).max((f64::from(cos) - angle.cos()).abs());
        }
        assert!(worst < 1.3e-5, "{worst}");
        assert_eq!([0, 1 << 30, i32::MIN, -1 << 30].map(sin_cos), [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)]);
    }
}
