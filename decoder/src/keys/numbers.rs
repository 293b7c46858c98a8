//! The arithmetic of key clips: key values to raw values, and the one division.

use super::layout::*;
use crate::kind::Kind;

/// How a channel's thousandths become raw values: bits of their fraction, or [`Scale::ANGLE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scale(pub(super) u8);

impl Scale {
    const ANGLE: Scale = Scale(63);

    /// Of a kind in a clip with this unit of positions; `exponent` is a scalar's own. `None` if it is out of bounds.
    #[inline(always)]
    pub(super) fn of(kind: Kind, length_exponent: i8, exponent: i8) -> Option<Scale> {
        let fraction = match class(kind) {
            POSITION => -i32::from(length_exponent),
            SCALAR if kind == Kind::Scalar => 31 - i32::from(exponent),
            SCALAR => 30,
            _ => return Some(Scale::ANGLE),
        };
        (0..=MAX_FRACTION as i32).contains(&fraction).then_some(Scale(fraction as u8))
    }

    /// The raw value of thousandths, below 2^26 in magnitude: below 2^40, and not yet wrapped to 32 bits.
    #[inline(never)]
    pub(super) fn raw(self, thousandths: i32) -> i64 {
        let (factor, shift) =
            if self == Scale::ANGLE { (ANGLE_FACTOR, ANGLE_SHIFT) } else { (DECIMAL_FACTOR, DECIMAL_SHIFT - u32::from(self.0)) };
        shift_rounded(i64::from(thousandths) * i64::from(factor), shift)
    }
}

/// Classes of kinds, which have statistics of their own.
pub(super) const POSITION: usize = 1;
pub(super) const SCALAR: usize = 2;

/// The class of a kind: 0 for angles and exponential maps, 1 for positions, 2 for scalars and components of quaternions.
pub(super) const fn class(kind: Kind) -> usize {
    match kind {
        Kind::Xposition | Kind::Yposition | Kind::Zposition => POSITION,
        Kind::Scalar | Kind::Wquaternion | Kind::Xquaternion | Kind::Yquaternion | Kind::Zquaternion => SCALAR,
        _ => 0,
    }
}

/// Shifts right by 1 bit or more; halves are rounded up.
#[inline(never)]
pub(super) fn shift_rounded(value: i64, bits: u32) -> i64 {
    value.wrapping_add(1 << (bits - 1)) >> bits
}

/// A product of a number in 2^-30.
#[inline(never)]
pub(super) fn scaled(one: i32, other: i32) -> i64 {
    shift_rounded(i64::from(one) * i64::from(other), 30)
}

/// A quotient, rounded to the nearest; halves away from zero. Two digits of 32 bits, one bit a turn: the compiler's own routine is several times as
/// large.
#[inline(never)]
pub(super) fn divide(value: i64, by: u32) -> i64 {
    let rest = value.unsigned_abs() + u64::from(by >> 1);
    let zeros = by.leading_zeros();
    let (above, high) = digit(0, (rest >> 32) as u32, (by, zeros));
    let (_, low) = digit(above, rest as u32, (by, zeros));
    let quotient = (u64::from(high) << 32 | u64::from(low)) as i64;
    if value < 0 { quotient.wrapping_neg() } else { quotient }
}

/// A digit of a long division: `above`, the rest so far, is less than the divisor, which comes with its leading zeros. Returns the rest and the digit of
/// the quotient.
#[inline(never)]
fn digit(above: u32, digit: u32, (by, zeros): (u32, u32)) -> (u32, u32) {
    let room = if above == 0 { 32 + digit.leading_zeros() } else { above.leading_zeros() };
    // As many bits more leave the rest less than the divisor: they give no bit of the quotient.
    let known = room.saturating_sub(zeros + 1).min(32);
    let both = (u64::from(above) << 32 | u64::from(digit)) << known;
    let (mut above, mut rest) = ((both >> 32) as u32, both as u32);
    for _ in known..32 {
        let carry = above >> 31 != 0;
        above = above << 1 | rest >> 31;
        rest <<= 1;
        if carry || above >= by {
            above = above.wrapping_sub(by);
            rest |= 1;
        }
    }
    (above, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quotient_is_the_nearest() {
        for by in [1, 2, 3, 7, 64, 65_535, 0x8000_0000, u32::MAX] {
            for value in [0, 1, 2, 3, 4, 5, 31, 32, 33, 1 << 40, (1 << 62) + 12_345, i64::MAX] {
                let nearest = ((i128::from(value) + i128::from(by >> 1)) / i128::from(by)) as i64;
                assert_eq!((divide(value, by), divide(-value, by)), (nearest, -nearest), "{value} / {by}");
            }
        }
    }

    #[test]
    fn thousandths_become_raw_values() {
        let angle = Scale::of(Kind::Xrotation, 0, 0).unwrap();
        assert_eq!([360_000, 90_000, -180_000].map(|degrees| angle.raw(degrees)), [1 << 32, 1 << 30, -1 << 31]);
        let place = Scale::of(Kind::Xposition, -23, 0).unwrap();
        assert_eq!([1000, 500, -1].map(|place_| place.raw(place_)), [1 << 23, 1 << 22, -8389]);
        assert_eq!(Scale::of(Kind::Scalar, 0, 1), Some(Scale(30)));
        assert_eq!([Scale::of(Kind::Scalar, 0, -2), Scale::of(Kind::Xposition, 1, 0)], [None, None]);
    }
}
