//! Sine, cosine and arctangent in integers, by CORDIC (Volder 1959): additions and shifts, no product.
//!
//! Only what asks for angles in another form links them; playing needs none.

/// The arctangent of 2^-i, in 2^-32 turns.
const ARCTANGENTS: [i32; 30] = [
    536_870_912,
    316_933_406,
    167_458_907,
    85_004_756,
    42_667_331,
    21_354_465,
    10_679_838,
    5_340_245,
    2_670_163,
    1_335_087,
    667_544,
    333_772,
    166_886,
    83_443,
    41_722,
    20_861,
    10_430,
    5_215,
    2_608,
    1_304,
    652,
    326,
    163,
    81,
    41,
    20,
    10,
    5,
    3,
    1,
];

/// The product of the cosines of [`ARCTANGENTS`], in Q30: what the rotations lengthen a vector by, inverted.
const SHORTENED: i32 = 652_032_874;

/// Sine and cosine, in Q30, of an angle in 2^-32 turns. Each is within 6e-8 of the true value.
#[inline(never)]
pub(crate) fn sin_cos(angle: i32) -> (i32, i32) {
    let quarter = (angle as u32).wrapping_add(1 << 29) >> 30;
    // At most an eighth of a turn either way; the vector never leaves the circle of radius 2^30 by more than 1/8.
    let mut rest = (angle as u32).wrapping_sub(quarter << 30) as i32;
    let (mut x, mut y) = (SHORTENED, 0i32);
    for (shift, arctangent) in ARCTANGENTS.iter().enumerate() {
        let (dx, dy) = (y >> shift, x >> shift);
        if rest >= 0 {
            (x, y, rest) = (x - dx, y + dy, rest - arctangent);
        } else {
            (x, y, rest) = (x + dx, y - dy, rest + arctangent);
        }
    }
    match quarter {
        0 => (y, x),
        1 => (x, -y),
        2 => (-y, -x),
        _ => (-x, y),
    }
}

/// The angle of the vector (x, y) from the x axis, in 2^-32 turns, within 16 of the true value for a vector longer than 2^26; 0 for no vector.
#[inline(never)]
pub(crate) fn atan2(y: i32, x: i32) -> i32 {
    atan2_in::<30>(y, x)
}

/// [`atan2`] in half the steps: within 2^-16 turns, for what stands in Q15.
#[inline(never)]
pub(crate) fn atan2_coarse(y: i32, x: i32) -> i32 {
    atan2_in::<15>(y, x)
}

#[inline(always)]
fn atan2_in<const STEPS: usize>(y: i32, x: i32) -> i32 {
    // Components below 2^29: the rotations lengthen the vector by 1.65 at most, which stays below 2^31.
    let largest = (x.unsigned_abs() | y.unsigned_abs()).leading_zeros() as i32;
    if largest == 32 {
        return 0;
    }
    let up = largest - 3;
    let scaled = |v: i32| if up >= 0 { v << up } else { v >> -up };
    let (mut x, mut y) = (scaled(x), scaled(y));
    let mut angle = 0i32;
    if x < 0 {
        (x, y, angle) = (-x, -y, i32::MIN);
    }
    for (shift, arctangent) in ARCTANGENTS.iter().enumerate().take(STEPS) {
        let (dx, dy) = (y >> shift, x >> shift);
        if y > 0 {
            (x, y, angle) = (x + dx, y - dy, angle.wrapping_add(*arctangent));
        } else {
            (x, y, angle) = (x - dx, y + dy, angle.wrapping_sub(*arctangent));
        }
    }
    angle
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNITS: f64 = 4_294_967_296.0;
    /// Miri takes a thousand times as long.
    const STEPS: u32 = if cfg!(miri) { 400 } else { 200_000 };

    #[test]
    fn sine_and_cosine_keep_the_stated_error() {
        let mut worst = 0.0f64;
        for step in 0..STEPS {
            let raw = step.wrapping_mul(42_949_673).wrapping_add(step) as i32;
            let angle = f64::from(raw) / UNITS * std::f64::consts::TAU;
            let (sin, cos) = sin_cos(raw);
            let one = f64::from(1 << 30);
            worst = worst.max((f64::from(sin) / one - angle.sin()).abs()).max((f64::from(cos) / one - angle.cos()).abs());
        }
        assert!(worst < 6e-8, "{worst}");
    }

    #[test]
    fn arctangents_keep_the_stated_error() {
        let mut worst = 0.0f64;
        for step in 0..STEPS {
            let raw = step.wrapping_mul(42_949_673).wrapping_add(step) as i32;
            let angle = f64::from(raw) / UNITS * std::f64::consts::TAU;
            for bits in [26, 28, 30] {
                let length = f64::from(1 << bits);
                let (y, x) = ((angle.sin() * length).round() as i32, (angle.cos() * length).round() as i32);
                let truth = f64::from(y).atan2(f64::from(x)) / std::f64::consts::TAU * UNITS;
                let error = f64::from(atan2(y, x).wrapping_sub(truth.round() as i64 as i32));
                worst = worst.max(error.abs());
            }
        }
        assert!(worst <= 16.0, "{worst}");
        for step in 0..STEPS / 8 {
            let raw = step.wrapping_mul(42_949_673).wrapping_add(step) as i32;
            let angle = f64::from(raw) / UNITS * std::f64::consts::TAU;
            let (y, x) = ((angle.sin() * 32768.0).round() as i32, (angle.cos() * 32768.0).round() as i32);
            let error = atan2_coarse(y, x).wrapping_sub(raw);
            assert!(error.unsigned_abs() <= 1 << 16, "{error}");
        }
        assert_eq!(atan2(0, 0), 0);
        for (y, x) in [(i32::MIN, i32::MIN), (i32::MAX, i32::MIN), (0, i32::MIN), (1, 0), (0, 1)] {
            let truth = f64::from(y).atan2(f64::from(x)) / std::f64::consts::TAU * UNITS;
            assert!(f64::from(atan2(y, x).wrapping_sub(truth.round() as i64 as i32)).abs() <= 16.0, "{y} {x}");
        }
    }

    /// Pictures are compared pixel for pixel: they need the same values on every machine and in every version.
    #[test]
    fn values_are_the_same_to_the_last_bit() {
        let mut crc = crate::crc::INITIAL;
        let mut note = |values: [i32; 4]| values.iter().for_each(|value| crc = crate::crc::update(crc, &value.to_le_bytes()));
        for step in 0..500 {
            let raw = (step as u32).wrapping_mul(0x9e37_79b9) as i32;
            let (sin, cos) = sin_cos(raw);
            note([sin, cos, atan2(sin, cos), atan2_coarse(sin, cos)]);
            // Along the axes, with and without bits to spare.
            let length = (1 << (step % 31)) | raw.unsigned_abs() as i32 >> (step % 31 + 1);
            note([atan2(0, length), atan2(0, -length), atan2(length, 0), atan2(-length, 0)]);
        }
        assert_eq!(crc, 64_138);
    }
}
