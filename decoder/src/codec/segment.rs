//! One segment: its mode, then its acceleration, its slope, both, or neither.

use crate::blocks::Input;
use crate::channel::{ChannelState, mantissa, segment_frames};
use crate::entropy::{Cursor, Symbols};
use crate::layout::{DIRECT, GROUPS, LENGTH_CLASSES, MAX_STEP, START_MODE, STEPS, STEPS_SHIFT, group, segment_type};
use crate::tables;

/// Bytes that one segment takes at most, CRC included: two symbols of the mode, then twice a number's symbol, its length's, and
/// 31 bits in four parts; no symbol or part takes more than two bytes.
pub(crate) const MAX_SEGMENT_BYTES: u32 = 32;

/// Symbols of the mode's alphabet that are modes, of type W or K; one more says that a mode of type WK or CARRY follows.
pub const DIRECT_MODES: u32 = 32;
/// The context of the symbol that follows: its mode, less [`DIRECT_MODES`].
pub const SECOND: u8 = 64;
/// Contexts of modes: those of the mode before, and [`SECOND`].
pub const MODE_CONTEXTS: usize = 65;

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
    /// Sign of the running number, 0 if it is small: the next context's `prev_sign`.
    pub sign: i8,
}

/// Contexts of w and k together.
pub const CONTEXTS: usize = 96;

/// Contexts of accelerations: 12 a class of lengths. As many of slopes follow.
const ACCELERATIONS: u8 = 48;
/// The first context of a length.
const FIRST_CONTEXTS: [u8; 16] = {
    let mut first = [0; 16];
    let mut i = 0;
    while i < 16 {
        first[i] = 12 * LENGTH_CLASSES[i];
        i += 1;
    }
    first
};

impl Context {
    /// `which` as in [`step`], which gave `unit`: `now` is the running w or k; `prev_sign` the sign before, 0 for a slope.
    #[inline(always)]
    pub const fn new(which: u8, now: i32, prev_sign: i8, unit: u32) -> Context {
        // unit < 2^30, so nothing here passes 2^32.
        let half = (unit + 1) >> 1;
        let mut size = now.unsigned_abs();
        let prev_sign = prev_sign as i32;
        let (mut a, mut sign, mut flip) = (0, 0, prev_sign >> 31);
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
        let first = FIRST_CONTEXTS[(which & 15) as usize] + if which & SLOPE == 0 { 0 } else { ACCELERATIONS };
        let index = first as i32 + a + (prev_sign ^ flip) - flip + 1;
        Context { index: index as u8, flip, sign: sign as i8 }
    }
}

/// What segments are read from.
pub(crate) struct Segments<'a> {
    pub(crate) symbols: Symbols<'a>,
    /// Whether one was due that follows: [`crate::play_state::follow`] is for it once all have read.
    pub(crate) followers: bool,
}

impl<'a> Segments<'a> {
    pub(crate) fn at(at: Cursor, input: &Input<'a>) -> Segments<'a> {
        Segments { symbols: Symbols { at, input: *input }, followers: false }
    }
}

/// Reads the segment that follows the one that `state` has ended.
#[inline(never)]
pub(crate) fn read(state: &mut ChannelState, segments: &mut Segments<'_>) {
    if state.step > MAX_STEP {
        segments.followers = true;
        return;
    }
    let symbols = &mut segments.symbols;
    let mode = mode(symbols, state.mode);
    let (kind, length_index) = (mode >> 4, mode as u8 & 15);
    state.mode = mode as u8;
    // It was due at this frame.
    state.due = state.due.wrapping_add(segment_frames(length_index));
    if kind & 1 == 0 {
        let unit = step(length_index, state.step);
        let context = Context::new(length_index, state.w, state.prev_sign, unit);
        state.prev_sign = context.sign;
        state.w = number::<true>(symbols, &context, unit);
    }
    match kind as u8 {
        segment_type::W => state.k = 0,
        segment_type::K | segment_type::WK => state.k = slope(symbols, state),
        _ => (),
    }
}

/// A new slope: captured motion has few.
#[inline(never)]
fn slope(symbols: &mut Symbols<'_>, state: &ChannelState) -> i32 {
    let which = state.mode & 15 | SLOPE;
    let unit = step(which, state.step);
    number::<false>(symbols, &Context::new(which, state.k, 0, unit), unit)
}

/// A new acceleration or slope in raw units, read in line or by calls.
#[inline(always)]
fn number<const IN_LINE: bool>(symbols: &mut Symbols<'_>, context: &Context, unit: u32) -> i32 {
    let table = tables::number(context.index);
    let next = 1 + if IN_LINE { symbols.symbol_in_line(table) } else { symbols.symbol(table) };
    let mut size = next >> 1;
    if size > DIRECT {
        size = match size - DIRECT {
            bits @ 1..=GROUPS => group(bits) + if IN_LINE { symbols.few_bits(bits) } else { symbols.bits(bits) },
            _ => far(symbols),
        };
    }
    // All ones if it is negative.
    let sign = ((next & 1) as i32 - 1) ^ context.flip;
    (size.wrapping_mul(unit) as i32 ^ sign).wrapping_sub(sign)
}

/// The mode that follows `after`.
#[inline(always)]
fn mode(symbols: &mut Symbols<'_>, after: u8) -> u32 {
    let symbol = symbols.symbol_in_line(tables::mode(after));
    if symbol < DIRECT_MODES {
        return symbol;
    }
    (DIRECT_MODES + symbols.symbol(tables::mode(SECOND))).min(u32::from(START_MODE) - 1)
}

/// A magnitude behind the groups.
#[inline(never)]
fn far(symbols: &mut Symbols<'_>) -> u32 {
    let bits = symbols.symbol(&tables::FAR);
    // At most 2^32 + 2^7: it may wrap, but no well-formed number is so large.
    (group(GROUPS + 1) - 1).wrapping_add(1 << bits).wrapping_add(symbols.long_bits(bits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_symbols_are_the_mode_of_a_channel_without_segments() {
        let last = |high: u32| {
            // The last symbol of the modes' alphabet: another one follows.
            let at = Cursor::at(0, high << 12 | 0xfff);
            mode(&mut Symbols { at, input: Input(&[0; 8]) }, START_MODE)
        };
        let modes: Vec<u32> = (1 << 4..1 << 12).map(last).collect();
        assert_eq!(modes.iter().max(), Some(&(u32::from(START_MODE) - 1)));
        assert!(modes.iter().all(|&mode| mode >= DIRECT_MODES));
    }
}
