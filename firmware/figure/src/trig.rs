//! Sine and cosine by table, from an angle in turns (2^32 is one turn) to Q15 (32768 is 1).
//!
//! The tables are worked out by the compiler; at run time there are integers only, and no product is wider than 32 bits.

/// Fraction bits of sines, cosines and of every element of a rotation.
pub const FRACTION_BITS: u32 = 15;
/// 1 in Q15. It is representable: a rotation by nothing is exact.
pub const ONE: i32 = 1 << FRACTION_BITS;

/// Half a unit of the last place, for rounding shifts by [`FRACTION_BITS`].
pub(crate) const HALF: i32 = ONE / 2;

/// Intervals of the quarter wave.
const INTERVALS: usize = 256;
/// Fraction bits of the table: its own rounding must not show in Q15.
const TABLE_BITS: u32 = 22;
/// Fraction bits of the place within an interval: a step of the table (< 2^15) times it stays below 2^29.
const PLACE_BITS: u32 = 14;

/// The quarter wave: its value at the start of each interval, and the step to the next. The quarter turn itself is the last.
static QUARTER: [[i32; 2]; INTERVALS + 1] = quarter_wave();

const fn quarter_wave() -> [[i32; 2]; INTERVALS + 1] {
    let mut table = [[0; 2]; INTERVALS + 1];
    let mut index = 0;
    while index < table.len() {
        let (from, to) = (quarter_sine(index), quarter_sine(index + 1));
        table[index] = [from, to - from];
        index += 1;
    }
    table
}

const fn quarter_sine(index: usize) -> i32 {
    let angle = index as f64 * core::f64::consts::FRAC_PI_2 / INTERVALS as f64;
    (angle * series(angle * angle, 1.0) * (1 << TABLE_BITS) as f64 + 0.5) as i32
}

/// The alternating series sum of (-u)^k / (first + 2k)! * first!: with `first` 0 the cosine of the root of u, with 1 its sine
/// over the root. Converges to the last bit for u up to 16.
pub(crate) const fn series(u: f64, first: f64) -> f64 {
    let mut sum = 0.0;
    let mut term = 1.0;
    let mut n = first;
    while n < first + 50.0 {
        sum += term;
        term *= -u / ((n + 1.0) * (n + 2.0));
        n += 2.0;
    }
    sum
}

/// Sine of a phase between nothing and a quarter turn (2^30).
#[inline(always)]
fn quarter(phase: u32) -> i32 {
    let index = (phase >> 22) as usize;
    let place = (phase >> (22 - PLACE_BITS)) & ((1 << PLACE_BITS) - 1);
    let Some(&[from, step]) = QUARTER.get(index) else { return ONE };
    let value = from + ((step * place as i32) >> PLACE_BITS);
    (value + (1 << (TABLE_BITS - FRACTION_BITS - 1))) >> (TABLE_BITS - FRACTION_BITS)
}

/// Sine and cosine of an angle in 2^-32 turns. Each is within 2.1e-5 of the true value, and exact at quarter turns.
pub fn sin_cos(angle: i32) -> (i32, i32) {
    let turn = angle as u32;
    let phase = turn & 0x3fff_ffff;
    let (sin, cos) = (quarter(phase), quarter(0x4000_0000 - phase));
    match turn >> 30 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_keep_the_stated_error() {
        let mut worst = 0.0f64;
        for step in 0..2_000_000u32 {
            let raw = step.wrapping_mul(4_294_967) as i32;
            let angle = f64::from(raw) / 4294967296.0 * std::f64::consts::TAU;
            let (sin, cos) = sin_cos(raw);
            worst = worst.max((f64::from(sin) / 32768.0 - angle.sin()).abs()).max((f64::from(cos) / 32768.0 - angle.cos()).abs());
        }
        assert!(worst < 2.1e-5, "{worst}");
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(sin_cos(0), (0, ONE));
        assert_eq!(sin_cos(0x4000_0000), (ONE, 0));
        assert_eq!(sin_cos(i32::MIN), (0, -ONE));
        assert_eq!(sin_cos(-0x4000_0000), (-ONE, 0));
    }
}
