//! Sine, cosine, arctangent and inverse square root in integers: from products of 32-bit numbers, without a division and without a table but the
//! coefficients. Only what asks for angles in another form links them; playing needs none.
//!
//! # The steps
//!
//! An implementation in another language that follows these steps computes the same bits. Numbers are of 32 bits, and unsigned unless stated
//! otherwise. "Qn" stands for a number times 2^n. Shifts to the right round down. `high(a, b)` is the upper half of a product:
//! `(a * b) >> 32`, exactly. Angles are signed, in 2^-32 turns, and wrap.
//!
//! **`sin_cos(angle)`**, both results signed in Q30:
//! 1. `quarter = (angle + 2^29) >> 30`, and `rest = angle - (quarter << 30)`, signed: an eighth of a turn either way, -2^29 to 2^29 - 1.
//! 2. `t = |rest| << 2` (1 stands for an eighth of a turn, Q31), `u = high(t, t)` (its square, Q30).
//! 3. `sin = high(t, S[0] - high(u, S[1] - high(u, S[2] - high(u, S[3]))))` with S of [`SINE`], negated if `rest` is negative.
//! 4. `cos = 2^30 - high(u, C[0] - high(u, C[1] - high(u, C[2] - high(u, C[3]))))` with C of [`COSINE`].
//! 5. For the quarters 0 to 3 the result is (`sin`, `cos`), (`cos`, `-sin`), (`-sin`, `-cos`), (`-cos`, `sin`).
//!
//! **`atan2(y, x)`** of two signed numbers:
//! 1. `large` and `small` are the greater and the smaller one of |y| and |x|, which reach 2^31. If `large` is 0, the result is 0.
//! 2. Both are shifted to the left by the leading zeros of `large`, then to the right by 1.
//! 3. `far = small > (large >> 1)`. If so, the angle is measured back from an eighth of a turn: `(small, large) = (large - small, large + small)`.
//! 4. Both are shifted to the left by the leading zeros of `large`, 0 or 1: its highest bit is set now.
//! 5. `r = reciprocal(large)`, `z = high(small, r) << 2` (the quotient, at most 1/2, Q32), `u = high(z, z)`.
//! 6. `angle = high(z, A[0] - high(u, A[1] - high(u, A[2] - high(u, A[3] - high(u, A[4] - high(u, A[5]))))))` with A of [`ARCTANGENT`].
//! 7. If `far`, it becomes `2^29 - angle`. If |y| > |x|, it becomes `2^30 - angle`. If x is negative, `2^31 - angle`. If y is negative, `-angle`.
//!
//! **`reciprocal(d)`** of a number whose highest bit is set: 2^62 / d (d in Q32, the result in Q30), by Newton's method:
//! `r = 0xb4b4b4b5 - high(d, 0x78787878)` (48/17 - 32/17 d), then three times `r = high(r, 2^31 - high(d, r)) << 2`.
//!
//! **`inverse_root(n)`** of a number of 2^30 or more: 1 / sqrt(n) (n in Q32, the result in Q30), by Newton's method:
//! `y = 0x887d9c55 - high(n, 0x4dfea27a)` (0.914 (7/3 - 4/3 n)), then four times `y = high(y, 3 * 2^30 - high(high(n, y) << 2, y)) << 1`; the result is `y + 2`.

/// The upper half of a product: `a` in Q32 leaves `b` its format.
#[inline(always)]
pub(crate) fn high(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}

/// The sine of an eighth of a turn times t, divided by t: coefficients of t^0, t^2, t^4, t^6 with alternating signs, times 2^31, 2^33, 2^35, 2^37. The
/// polynomial takes the function's values at the Chebyshev points of t^2, the four (1 + cos(pi (2 j + 1) / 8)) / 2.
static SINE: [u32; 4] = [1_686_629_708, 693_598_003, 85_555_982, 4_941_520];

/// 1 minus the cosine of an eighth of a turn times t, divided by t^2: as [`SINE`], times 2^32, 2^34, 2^36, 2^38.
static COSINE: [u32; 4] = [1_324_675_878, 272_375_455, 22_399_895, 973_605];

/// The arctangent of z in turns, divided by z: coefficients of z^0 to z^10 as of [`SINE`], times 2^32. The Chebyshev points of z^2 are the six
/// (1 + cos(pi (2 j + 1) / 12)) / 8.
static ARCTANGENT: [u32; 6] = [683_565_272, 227_854_097, 136_665_923, 96_821_929, 69_146_217, 34_631_066];

/// Half a quarter of a turn, in 2^-32 turns.
const EIGHTH: u32 = 1 << 29;

/// The polynomial of `coefficients` with alternating signs at `u`: no partial sum is negative. One loop for all: unrolled it takes 300 bytes more on a
/// Cortex-M0.
#[inline(never)]
fn alternating(coefficients: &[u32], u: u32) -> u32 {
    coefficients.iter().rev().fold(0, |sum, coefficient| coefficient.wrapping_sub(high(u, sum)))
}

/// Sine and cosine, in Q30, of an angle in 2^-32 turns. Each is within 6e-9 of the true value, and exact at quarter turns.
#[inline(never)]
pub(crate) fn sin_cos(angle: i32) -> (i32, i32) {
    let quarter = (angle as u32).wrapping_add(EIGHTH) >> 30;
    let rest = (angle as u32).wrapping_sub(quarter << 30) as i32;
    let t = rest.unsigned_abs() << 2;
    let u = high(t, t);
    let sin = high(t, alternating(&SINE, u)) as i32;
    let sin = if rest < 0 { -sin } else { sin };
    let cos = (1 << 30) - high(u, alternating(&COSINE, u)) as i32;
    match quarter {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The angle of the vector (x, y) from the x axis, in 2^-32 turns, within 6 of the true value for a vector longer than 2^26; 0 for no vector.
#[inline(never)]
pub(crate) fn atan2(y: i32, x: i32) -> i32 {
    let (across, along) = (y.unsigned_abs(), x.unsigned_abs());
    let (mut small, mut large) = if across > along { (along, across) } else { (across, along) };
    if large == 0 {
        return 0;
    }
    let up = large.leading_zeros();
    (small, large) = ((small << up) >> 1, (large << up) >> 1);
    let far = small > large >> 1;
    if far {
        (small, large) = (large - small, large + small);
    }
    if large < 1 << 31 {
        (small, large) = (small << 1, large << 1);
    }
    let z = high(small, reciprocal(large)) << 2;
    let mut angle = high(z, alternating(&ARCTANGENT, high(z, z)));
    if far {
        angle = EIGHTH - angle;
    }
    if across > along {
        angle = 2 * EIGHTH - angle;
    }
    if x < 0 {
        angle = 4 * EIGHTH - angle;
    }
    if y < 0 { angle.wrapping_neg() as i32 } else { angle as i32 }
}

/// 2^62 / d for a number whose highest bit is set, within 5.
#[inline(always)]
fn reciprocal(d: u32) -> u32 {
    // The line 48/17 - 32/17 d is within 1/17 of 1 / d; each step of Newton's method squares that.
    let mut r = 0xb4b4_b4b5 - high(d, 0x7878_7878);
    for _ in 0..3 {
        r = high(r, (1u32 << 31).wrapping_sub(high(d, r))) << 2;
    }
    r
}

/// 2^46 / sqrt(n) for a number of 2^30 or more: within 5e-9 of itself.
#[inline(never)]
pub(crate) fn inverse_root(n: u32) -> u32 {
    // The line 0.914 (7/3 - 4/3 n) is within 8.6 % of 1 / sqrt(n). A step of Newton's method leaves 1.5 times the square of the error.
    let mut y = 0x887d_9c55 - high(n, 0x4dfe_a27a);
    for _ in 0..4 {
        y = high(y, (3u32 << 30).wrapping_sub(high(high(n, y) << 2, y))) << 1;
    }
    // What rounding down has cost, so that the root of a power of 4 is exact.
    y + 2
}

/// The arctangent of 2^-i, in 2^-32 turns.
const ARCTANGENTS: [i32; 15] = [
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
];

/// [`atan2`] within 2^-16 turns, for what stands in Q15: by CORDIC (Volder 1959), additions and shifts alone, which takes half the instructions of [`atan2`] on a
/// processor without a long product.
#[inline(never)]
pub(crate) fn atan2_coarse(y: i32, x: i32) -> i32 {
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
    for (shift, arctangent) in ARCTANGENTS.iter().enumerate() {
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
        assert!(worst < 6e-9, "{worst}");
        assert_eq!([0, 1 << 30, i32::MIN, -1 << 30].map(sin_cos), [(0, 1 << 30), (1 << 30, 0), (0, -1 << 30), (-1 << 30, 0)]);
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
        assert!(worst <= 6.0, "{worst}");
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
            assert!(f64::from(atan2(y, x).wrapping_sub(truth.round() as i64 as i32)).abs() <= 6.0, "{y} {x}");
        }
    }

    /// The polynomial of the least degree through `f` at the Chebyshev points of 0 to `end`, by Newton's divided differences.
    fn through<const N: usize>(f: impl Fn(f64) -> f64, end: f64) -> [f64; N] {
        let point = |j: usize| end / 2.0 * (1.0 + (std::f64::consts::PI * (2 * j + 1) as f64 / (2 * N) as f64).cos());
        let points: [f64; N] = std::array::from_fn(point);
        let mut differences = points.map(f);
        for width in 1..N {
            for j in (width..N).rev() {
                differences[j] = (differences[j] - differences[j - 1]) / (points[j] - points[j - width]);
            }
        }
        let mut polynomial = [0.0; N];
        for j in (0..N).rev() {
            for power in (0..N).rev() {
                let before = if power == 0 { differences[j] } else { polynomial[power - 1] };
                polynomial[power] = before - points[j] * polynomial[power];
            }
        }
        polynomial
    }

    #[test]
    fn coefficients_are_those_of_the_stated_polynomials() {
        let eighth = std::f64::consts::FRAC_PI_4;
        let scaled = |polynomial: &[f64], first: i32, each: i32| -> Vec<u32> {
            let signs = [1.0, -1.0].into_iter().cycle();
            let bits = (0..).map(|power| first + each * power);
            polynomial.iter().zip(signs).zip(bits).map(|((c, sign), bits)| (c * sign * 2f64.powi(bits)).round() as u32).collect()
        };
        assert_eq!(scaled(&through::<4>(|u| (eighth * u.sqrt()).sin() / u.sqrt(), 1.0), 31, 2), SINE);
        assert_eq!(scaled(&through::<4>(|u| (1.0 - (eighth * u.sqrt()).cos()) / u, 1.0), 32, 2), COSINE);
        let arctangent = through::<6>(|u| u.sqrt().atan() / u.sqrt() / std::f64::consts::TAU, 0.25);
        assert_eq!(scaled(&arctangent, 32, 0), ARCTANGENT);
        for (shift, arctangent) in ARCTANGENTS.iter().enumerate() {
            let truth = 0.5f64.powi(shift as i32).atan() / std::f64::consts::TAU * UNITS;
            assert_eq!(f64::from(*arctangent), truth.round());
        }
    }

    #[test]
    fn reciprocals_and_inverse_roots_keep_the_stated_error() {
        for step in 0..STEPS {
            let n = step.wrapping_mul(0x9e37_79b9);
            for d in [n | 1 << 31, u32::MAX - step, (1 << 31) + step] {
                let error = f64::from(reciprocal(d)) - 2f64.powi(62) / f64::from(d);
                assert!(error.abs() <= 5.0, "{d}: {error}");
            }
            for n in [n.max(1 << 30), u32::MAX - step, (1 << 30) + step] {
                let error = f64::from(inverse_root(n)) / 2f64.powi(46) * f64::from(n).sqrt() - 1.0;
                assert!(error.abs() < 5e-9, "{n}: {error}");
            }
        }
    }

    /// The bindings compute the same bits, and pictures are compared pixel for pixel: a change here is one in every language.
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
        assert_eq!(crc, 52_357);
    }
}
