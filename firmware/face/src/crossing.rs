//! Points on a line between two vertices of the display.

use pantin_figure::trig::WORKED_OUT;

/// The part of a line, Q8, at which a value that is `from` at its start and `to` at its end passes 0. Their signs differ, and both are below 2^8.
#[inline]
pub(crate) fn zero_crossing(from: i32, to: i32) -> i32 {
    let whole = (from - to).unsigned_abs() as usize;
    let reciprocal = if WORKED_OUT { reciprocal(whole) } else { RECIPROCALS.get(whole).copied().unwrap_or(0) };
    (from.abs() * i32::from(reciprocal)) >> 7
}

/// The point at a part (Q8) of a line.
#[inline(always)]
pub(crate) fn between(from: [i16; 2], to: [i16; 2], part: i32) -> [i16; 2] {
    let (x, y) = (i32::from(from[0]), i32::from(from[1]));
    let (across, down) = (i32::from(to[0]) - x, i32::from(to[1]) - y);
    [(x + ((across * part) >> 8)) as i16, (y + ((down * part) >> 8)) as i16]
}

/// 2^15 / x for x from 1 to 255, and 0 for 0.
static RECIPROCALS: [u16; 256] = {
    let mut table = [0; 256];
    let mut x = 1;
    while x < 256 {
        table[x] = reciprocal(x);
        x += 1;
    }
    table
};

const fn reciprocal(x: usize) -> u16 {
    match (1usize << 15).checked_div(x) {
        Some(reciprocal) => reciprocal as u16,
        None => 0,
    }
}
