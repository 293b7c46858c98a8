//! Sine and cosine by table, from an angle in turns (2^32 is one turn) to Q15 (32768 is 1).
//!
//! The tables are worked out by the compiler; at run time there are integers only (but in a page, see [`WORKED_OUT`]), and no product is wider than 32 bits.

/// Fraction bits of sines, cosines and of every element of a rotation.
pub const FRACTION_BITS: u32 = 15;
/// 1 in Q15. It is representable: a rotation by nothing is exact.
pub const ONE: i32 = 1 << FRACTION_BITS;

/// Half a unit of the last place, for rounding shifts by [`FRACTION_BITS`].
pub const HALF: i32 = ONE / 2;

/// Whether entries of tables are worked out where they are needed, by the same instructions that the compiler works the tables out with, to the
/// same bits: in a page, where a byte to be loaded counts and numbers are cheap.
pub const WORKED_OUT: bool = cfg!(target_arch = "wasm32");

/// A table of what a constant function makes of each index.
#[macro_export]
macro_rules! table {
    ($entry:ident, $len:expr) => {{
        let mut table = [$entry(0); $len];
        let mut index = 0;
        while index < $len {
            table[index] = $entry(index);
            index += 1;
        }
        table
    }};
}
pub use table;

/// Angles of the table in a turn.
const ANGLES: usize = 128;
/// Fraction bits of the table: its own rounding must not show in Q15.
const TABLE_BITS: u32 = 22;

/// Sine and cosine of each angle.
static CIRCLE: [[i32; 2]; ANGLES] = table!(on_circle, ANGLES);

/// Sine and cosine of an angle of the table.
#[inline(always)]
fn nearest_angle(index: usize) -> [i32; 2] {
    if WORKED_OUT { on_circle(index) } else { CIRCLE.get(index).copied().unwrap_or([0; 2]) }
}

const fn on_circle(index: usize) -> [i32; 2] {
    // The table's own quarter, and the angle in it: the series converges to the last bit.
    let (quarter, place) = (index / (ANGLES / 4), index % (ANGLES / 4));
    let angle = place as f64 * core::f64::consts::TAU / ANGLES as f64;
    let sin = round(angle * series(angle * angle, 1.0));
    let cos = round(series(angle * angle, 0.0));
    match quarter {
        0 => [sin, cos],
        1 => [cos, -sin],
        2 => [-sin, -cos],
        _ => [-cos, sin],
    }
}

const fn round(x: f64) -> i32 {
    (x * (1 << TABLE_BITS) as f64 + 0.5) as i32
}

/// The alternating series sum of (-u)^k / (first + 2k)! * first!: with `first` 0 the cosine of the root of u, with 1 its sine
/// over the root. Converges to the last bit for u up to 16.
#[inline(never)]
pub const fn series(u: f64, first: f64) -> f64 {
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

/// Sine and cosine of an angle in 2^-32 turns, by the addition theorem from the nearest angle of the table. Each is within 2.1e-5
/// of the true value, and exact at quarter turns.
#[inline(always)]
pub fn sin_cos(angle: i32) -> (i32, i32) {
    let nearest = (angle as u32).wrapping_add(1 << 24);
    let [sin, cos] = nearest_angle((nearest >> 25) as usize);
    // At most 2^-8 turns either way: in radians 0.0246, in Q20 less than 2^15. A sixth of its third power is below 3e-6.
    let rest = ((nearest >> 9) & 0xffff) as i32 - (1 << 15);
    let rest = (rest * 25_736) >> 15;
    // Half its square in Q27.
    let half_square = (rest * rest) >> 14;
    let (near_sin, near_cos) = (sin >> 7, cos >> 7);
    // Q35 to Q22, and Q42 to Q22.
    let sin = sin + ((near_cos * rest) >> 13) - ((near_sin * half_square) >> 20);
    let cos = cos - ((near_sin * rest) >> 13) - ((near_cos * half_square) >> 20);
    const ROUND: i32 = 1 << (TABLE_BITS - FRACTION_BITS - 1);
    ((sin + ROUND) >> (TABLE_BITS - FRACTION_BITS), (cos + ROUND) >> (TABLE_BITS - FRACTION_BITS))
}

/// Angles of the table in an eighth of a turn, by the smaller component of a unit vector in 1/128: the nearest one.
static NEAREST: [u8; 93] = {
    let mut nearest = [0; 93];
    let (mut index, mut angle) = (0, 0);
    while index < 93 {
        let sine = (2 * index + 1) as f64 / 256.0;
        // Half of a step on lies the border to the next angle.
        while angle < ANGLES / 8 {
            let border = (angle as f64 + 0.5) * core::f64::consts::TAU / ANGLES as f64;
            if border * series(border * border, 1.0) > sine {
                break;
            }
            angle += 1;
        }
        nearest[index] = angle as u8;
        index += 1;
    }
    nearest
};

/// The angle of a unit vector in Q15 from the x axis, in 2^-32 turns: within 2^-16 turns, as far as the vector's length is 1 to within 2^-14.
#[inline(never)]
pub fn angle_of_unit(y: i32, x: i32) -> i32 {
    let (across, along) = (y.unsigned_abs() as i32, x.unsigned_abs() as i32);
    let (small, large) = if across <= along { (across, along) } else { (along, across) };
    let index = NEAREST.get((small >> 8) as usize).copied().unwrap_or((ANGLES / 8) as u8);
    let [sin, cos] = nearest_angle(index.into());
    // What is left is small: its sine is itself. Below 2^11, times 2^32 / (2 pi 2^15).
    let rest = (small * (cos >> 7) - large * (sin >> 7) + HALF) >> FRACTION_BITS;
    let mut angle = (i32::from(index) << 25) + rest * 20_861;
    if across > along {
        angle = (1 << 30) - angle;
    }
    if x < 0 {
        angle = i32::MIN.wrapping_sub(angle);
    }
    if y < 0 { angle.wrapping_neg() } else { angle }
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
    fn angles_of_unit_vectors_keep_the_stated_error() {
        let mut worst = 0;
        for step in 0..2_000_000u32 {
            let raw = step.wrapping_mul(4_294_967) as i32;
            let angle = f64::from(raw) / 4294967296.0 * std::f64::consts::TAU;
            for length in [32766.0, 32768.0, 32770.0] {
                let [x, y] = [angle.cos(), angle.sin()].map(|part| (part * length).round() as i32);
                worst = worst.max(angle_of_unit(y, x).wrapping_sub(raw).unsigned_abs());
            }
        }
        assert!(worst < 1 << 16, "{worst}");
        for (y, x, angle) in [(0, ONE, 0), (ONE, 0, 1 << 30), (0, -ONE, i32::MIN), (-ONE, 0, -(1 << 30)), (0, 0, 0)] {
            assert_eq!(angle_of_unit(y, x), angle, "{y} {x}");
        }
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(sin_cos(0), (0, ONE));
        assert_eq!(sin_cos(0x4000_0000), (ONE, 0));
        assert_eq!(sin_cos(i32::MIN), (0, -ONE));
        assert_eq!(sin_cos(-0x4000_0000), (-ONE, 0));
    }
}
