//! One segment: its mode, then its acceleration, its slope, both, or neither.

use crate::channel::{ChannelState, length, mantissa};
use crate::entropy::Symbols;
use crate::layout::{DIRECT, FAR_BITS, GROUPS, LENGTH_CLASSES, START_MODE, STEPS, STEPS_SHIFT, group, segment_type};
use crate::tables;

/// Bytes that one segment takes at most, CRC included: a mode's symbol and 4 bits, then twice a number's symbol, 5 bits and
/// 31 bits in four parts; no symbol or part takes more than two bytes.
pub(crate) const MAX_SEGMENT_BYTES: u32 = 32;

/// Symbols of the mode's alphabet that are modes, of type W or K; one more says that a mode of type WK or NONE follows in bits.
pub const DIRECT_MODES: u32 = 32;
/// Bits of a mode that follows.
pub const MODE_BITS: u32 = 5;

/// Where the slopes begin in [`STEPS`], which the modes of type W and K index.
pub const SLOPE: u8 = 16;

/// The step of an acceleration (`which` is the length's index) or a slope (that + [`SLOPE`]), in raw units a frame^2 or a frame^3.
#[inline(always)]
pub const fn step(which: u8, channel_step: u8) -> u32 {
    // At most 2^29 * 3.
    let scaled = STEPS[(which & 31) as usize] * mantissa(channel_step);
    // 30 - channel_step / 2, rounded down, 1 to 30.
    let shift = ((2 * STEPS_SHIFT as u8 + 1).wrapping_sub(channel_step) & 63) >> 1;
    (scaled >> shift) | 1
}

/// What the last accelerations tell about the next one: which statistics it has, and whether its sign is turned around.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Context {
    /// Index into the contexts of [`tables`].
    pub index: u8,
    /// -1 if the symbol tells the opposite number, else 0.
    pub flip: i32,
    /// Sign of the running number, 0 if it is small: the next context's `turn`.
    pub sign: i8,
}

/// Contexts of w and k together.
pub const CONTEXTS: usize = 96;

/// The first context of a length, or of a length's slopes: 12 a class.
const FIRST_CONTEXTS: [u8; 32] = {
    let mut first = [0; 32];
    let mut i = 0;
    while i < 32 {
        first[i] = 12 * (LENGTH_CLASSES[i % 16] + 4 * (i / 16) as u8);
        i += 1;
    }
    first
};

impl Context {
    /// `which` as in [`step`], which gave `unit`: `now` is the running w or k; `turn` the sign before, 0 for a slope.
    #[inline(always)]
    pub const fn new(which: u8, now: i32, turn: i8, unit: u32) -> Context {
        // unit < 2^30, so nothing here passes 2^32.
        let half = (unit + 1) >> 1;
        let mut size = now.unsigned_abs();
        let turn = turn as i32;
        let (mut a, mut sign, mut flip) = (0, 0, turn >> 31);
        if size >= half {
            flip = now >> 31;
            sign = flip | 1;
            a = 3;
            size >>= 1;
            if size >= unit {
                a = 6;
                if size >= 3 * unit {
                    a = 9;
                }
            }
        }
        let first = FIRST_CONTEXTS[(which & 31) as usize];
        let index = first as i32 + a + (turn ^ flip) - flip + 1;
        Context { index: index as u8, flip, sign: sign as i8 }
    }
}

/// Reads the segment that follows the one that `state` has ended.
#[inline(never)]
pub(crate) fn read(state: &mut ChannelState, symbols: &mut Symbols<'_>) {
    let mode = mode(symbols, state.mode);
    state.mode = mode;
    // It was due at this frame.
    state.due = state.due.wrapping_add(length(mode));
    let (kind, length) = (mode >> 4, mode & 15);
    if kind & 1 == 0 {
        (state.w, state.turn) = number(symbols, state.step, length, state.w, state.turn);
    }
    let slope = match kind {
        segment_type::K | segment_type::WK => slope(symbols, state, length | SLOPE),
        _ => 0,
    };
    state.k = slope;
}

/// A new slope: captured motion has few.
#[inline(never)]
fn slope(symbols: &mut Symbols<'_>, state: &ChannelState, which: u8) -> i32 {
    number(symbols, state.step, which, state.k, 0).0
}

/// A new acceleration or slope in raw units, and the sign of the running one, `now`.
#[inline(always)]
fn number(symbols: &mut Symbols<'_>, channel_step: u8, which: u8, now: i32, turn: i8) -> (i32, i8) {
    let unit = step(which, channel_step);
    let context = Context::new(which, now, turn, unit);
    let symbol = symbols.symbol_in_line(tables::number(context.index));
    let mut size = (symbol + 1) >> 1;
    if size > DIRECT {
        size = far(symbols, size);
    }
    // All ones if it is negative.
    let sign = -((symbol & 1) as i32) ^ context.flip;
    ((size.wrapping_mul(unit) as i32 ^ sign).wrapping_sub(sign), context.sign)
}

/// The mode that follows `after`.
#[inline(always)]
fn mode(symbols: &mut Symbols<'_>, after: u8) -> u8 {
    let symbol = symbols.symbol_in_line(tables::mode(after));
    if symbol < DIRECT_MODES {
        return symbol as u8;
    }
    let mode = (DIRECT_MODES + symbols.bits(MODE_BITS)) as u8;
    if mode == START_MODE { START_MODE - 1 } else { mode }
}

/// A magnitude above [`DIRECT`].
#[inline(never)]
fn far(symbols: &mut Symbols<'_>, index: u32) -> u32 {
    if let Some(count @ 1..=GROUPS) = index.checked_sub(DIRECT) {
        return group(count) + symbols.few_bits(count);
    }
    let bits = symbols.bits(FAR_BITS);
    // At most 2^32 + 2^7: it may wrap, but no well-formed number is so large.
    (group(GROUPS + 1) - 1).wrapping_add(1 << bits).wrapping_add(symbols.long_bits(bits))
}
