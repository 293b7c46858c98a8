//! Square roots of integers: only used while a figure is set up.

use crate::rotation::{Vector, vector};
use crate::trig::ONE;

/// The root, rounded down.
pub(crate) fn integer_root(square: u32) -> u32 {
    let (mut root, mut bit) = (0, 1 << 15);
    while bit > 0 {
        let next: u32 = root | bit;
        if next * next <= square {
            root = next;
        }
        bit >>= 1;
    }
    root
}

/// The shift that brings every component below 2^15, so that the squares sum to less than 2^32.
pub(crate) fn shift_for(v: Vector) -> u32 {
    let largest = v.iter().fold(0, |largest, x| largest | x.unsigned_abs());
    17u32.saturating_sub(largest.leading_zeros())
}

/// The vector's direction in Q15, within 2 units a component for one longer than 2^13; `None` for none.
pub(crate) fn direction(v: Vector) -> Option<Vector> {
    let largest = v.iter().fold(0, |largest, x| largest | x.unsigned_abs());
    if largest == 0 {
        return None;
    }
    let shift = 17 - largest.leading_zeros() as i32;
    let v = vector(|axis| if shift >= 0 { v[axis] >> shift } else { v[axis] << -shift });
    let length = integer_root(v.iter().map(|x| x.unsigned_abs().pow(2)).sum()) as i32;
    Some(vector(|axis| v[axis] * ONE / length.max(1)))
}
