//! Units of a pose's values, in types of the `fixed` crate: angles, quaternion components, fractions of a range.

use core::ops::{Add, Neg, Sub};
use fixed::types::{I0F32, I2F30, I3F29, I16F16};

/// A component of a quaternion, -2 to 2 (exclusive).
pub type Component = I2F30;

/// A fraction of a scalar's range, -1 to 1 (exclusive).
pub type Fraction = fixed::types::I1F31;

/// An angle of -1/2 to 1/2 turn (exclusive). Sums and differences wrap as angles do.
///
/// Euler angles and the components of an exponential map are angles. The raw value counts 2^-32 turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Angle(i32);

impl Angle {
    /// No rotation.
    pub const ZERO: Angle = Angle(0);

    /// The angle of a raw value in 2^-32 turns.
    pub const fn from_bits(raw: i32) -> Angle {
        Angle(raw)
    }

    /// The raw value, in 2^-32 turns.
    pub const fn to_bits(self) -> i32 {
        self.0
    }

    /// The angle of a number of degrees, rounded to the nearest; whole turns are dropped.
    pub const fn from_degrees(degrees: I16F16) -> Angle {
        // 2^32 turns / 360 / 2^16: at most 2^31 times 2^16, then divided by a constant.
        let scaled = degrees.to_bits() as i64 * (1 << 16);
        Angle(((scaled + if scaled < 0 { -180 } else { 180 }) / 360) as i32)
    }

    /// The angle of the vector (x, y) from the x axis, in any unit: within 6 * 2^-32 turns for a vector longer than 2^26; 0 for no vector.
    ///
    /// Costs at most 130 instructions on a Cortex-M3.
    pub fn atan2(y: i32, x: i32) -> Angle {
        Angle(crate::trig::atan2(y, x))
    }

    /// [`Angle::atan2`] within 2^-16 turns, by additions and shifts: for processors without a long product, on which it takes a third of the instructions.
    pub fn atan2_coarse(y: i32, x: i32) -> Angle {
        Angle(crate::trig::atan2_coarse(y, x))
    }

    /// Sine and cosine, each within 6e-9, and exact at quarter turns.
    ///
    /// Costs at most 110 instructions on a Cortex-M3.
    pub fn sin_cos(self) -> (Component, Component) {
        let (sin, cos) = crate::trig::sin_cos(self.0);
        (Component::from_bits(sin), Component::from_bits(cos))
    }

    /// In turns: -0.5 to 0.5.
    pub const fn turns(self) -> I0F32 {
        I0F32::from_bits(self.0)
    }

    /// In degrees: -180 to 180, rounded to 2^-16 degrees.
    pub const fn degrees(self) -> I16F16 {
        I16F16::from_bits(((self.0 as i64 * 360 + (1 << 15)) >> 16) as i32)
    }

    /// In radians: -pi to pi, rounded to 2^-29.
    pub const fn radians(self) -> I3F29 {
        // pi / 4, times 2^31: a half turn, 2^31, becomes pi in Q29.
        I3F29::from_bits(((self.0 as i64 * 1_686_629_713 + (1 << 30)) >> 31) as i32)
    }

    /// In hundredths of a degree: -18000 to 18000, rounded to the nearest.
    pub const fn centidegrees(self) -> i32 {
        ((self.0 as i64 * 36_000 + (1 << 31)) >> 32) as i32
    }
}

impl Add for Angle {
    type Output = Angle;

    fn add(self, other: Angle) -> Angle {
        Angle(self.0.wrapping_add(other.0))
    }
}

impl Sub for Angle {
    type Output = Angle;

    fn sub(self, other: Angle) -> Angle {
        Angle(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Angle {
    type Output = Angle;

    fn neg(self) -> Angle {
        Angle(self.0.wrapping_neg())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_come_and_go() {
        for degrees in [-179.5, -90.0, -0.25, 0.0, 1.0 / 3.0, 46.44, 90.0, 179.99] {
            let angle = Angle::from_degrees(I16F16::from_num(degrees));
            assert!((angle.degrees().to_num::<f64>() - degrees).abs() < 2e-5, "{degrees}: {angle:?}");
            assert!((f64::from(angle.centidegrees()) - degrees * 100.0).abs() <= 0.51, "{degrees}");
        }
        assert_eq!(Angle::from_bits(i32::MIN).centidegrees(), -18_000);
        for bits in [i32::MIN, -(1 << 30), -12_345_678, -1, 0, 1, 99, 1 << 29, i32::MAX] {
            let truth = f64::from(bits) / 4_294_967_296.0 * std::f64::consts::TAU;
            assert!((Angle::from_bits(bits).radians().to_num::<f64>() - truth).abs() < 2e-9, "{bits}");
        }
        assert_eq!(Angle::from_degrees(I16F16::from_num(450)).centidegrees(), 9_000);
        assert_eq!(Angle::from_bits(i32::MIN) + Angle::from_bits(i32::MIN), Angle::ZERO);
    }
}
