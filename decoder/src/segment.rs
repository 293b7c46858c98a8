//! One segment: its mode, then its acceleration, its slope, both, or neither.

use crate::blocks::Input;
use crate::channel::{ChannelState, length};
use crate::entropy::Symbols;
use crate::layout::{DIRECT, FAR, FAR_BITS, GROUPS, K_STEPS, START_MODE, W_STEPS, group, segment_type};
use crate::tables;

/// Bytes that one segment takes at most, CRC included: a mode's symbol and 4 bits, then twice a number's symbol, 5 bits and
/// 31 bits in four parts; no symbol or part takes more than two bytes.
pub(crate) const MAX_SEGMENT_BYTES: u32 = 32;

/// Symbols of the mode's alphabet that name type and length at once; two more name types WK and NONE, whose length follows.
pub const DIRECT_MODES: u32 = 32;

/// The step of an acceleration (`steps` is [`W_STEPS`]) or a slope ([`K_STEPS`]), in raw units a frame^2 or a frame^3.
pub fn step(steps: &[u32; 16], mode: u8, channel_step: u8) -> u32 {
    let even = steps.get(usize::from(mode & 15)).copied().unwrap_or(1);
    // At most 2^20 * 181 / 128 < 2^21, then shifted up by (MAX_STEP >> 1) - 20 = 9.
    let scaled = if channel_step & 1 == 0 { even } else { (even * 181) >> 7 };
    let exponent = u32::from(channel_step >> 1);
    if exponent >= 20 { scaled << (exponent - 20) } else { (scaled >> (20 - exponent)).max(1) }
}

/// What the last accelerations tell about the next one: which statistics it has, and whether its sign is turned around.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Context {
    /// Index into the contexts of [`tables`].
    pub index: u8,
    /// Whether the symbol tells the opposite number.
    pub flipped: bool,
}

/// Contexts of w and k together.
pub const CONTEXTS: usize = 96;

impl Context {
    /// For a segment of `mode`: `now` is the running w (or k, if `slope`), `before` the one before it, `step` the new one's.
    pub fn new(slope: bool, mode: u8, now: i32, before: i32, step: u32) -> Context {
        let length_class = match mode & 15 {
            0 => 0,
            1 | 2 => 1,
            3..=6 => 2,
            _ => 3,
        };
        // step < 2^30, so nothing here passes 2^32.
        let half = step.div_ceil(2);
        let size = now.unsigned_abs();
        let a = if size < half {
            0
        } else if size < half + step {
            1
        } else if size < half + 2 * step {
            2
        } else {
            3
        };
        let b = if before.unsigned_abs() < half { 0 } else { before.signum() };
        let flipped = if a == 0 { b < 0 } else { now < 0 };
        let b = if flipped { -b } else { b };
        let index = ((u8::from(slope) * 4 + length_class) * 4 + a) * 3 + (b + 1) as u8;
        Context { index, flipped }
    }
}

/// The scale of [`ChannelState`]'s `last`: raw units are shifted down by this much.
pub fn last_shift(channel_step: u8) -> u32 {
    u32::from(channel_step >> 1).saturating_sub(12)
}

/// `w` as `last` keeps it.
pub fn keep_last(w: i32, channel_step: u8) -> i16 {
    (w >> last_shift(channel_step)).clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}

/// Reads the segment that follows the one that `state` has ended.
#[inline(never)]
pub(crate) fn read(state: &mut ChannelState, symbols: &mut Symbols, input: &Input<'_>) {
    let symbol = symbols.mode(input, tables::mode(state.mode));
    let mode = if symbol < DIRECT_MODES {
        tables::MODES.get(symbol as usize).copied().unwrap_or(0)
    } else {
        let mode = (segment_type::WK + (symbol & 1) as u8) << 4 | symbols.bits(input, 4) as u8;
        if mode == START_MODE { START_MODE - 1 } else { mode }
    };
    let kind = mode >> 4;
    let before = i32::from(state.last) << last_shift(state.step);
    state.last = keep_last(state.w, state.step);
    if kind == segment_type::W || kind == segment_type::WK {
        let unit = step(&W_STEPS, mode, state.step);
        let context = Context::new(false, mode, state.w, before, unit);
        state.w = number(symbols, input, context).wrapping_mul(unit as i32);
    }
    if kind == segment_type::K || kind == segment_type::WK {
        let unit = step(&K_STEPS, mode, state.step);
        let context = Context::new(true, mode, state.k, 0, unit);
        state.k = number(symbols, input, context).wrapping_mul(unit as i32);
    } else {
        state.k = 0;
    }
    state.mode = mode;
    // It was due at this frame.
    state.due = state.due.wrapping_add(length(mode));
}

#[inline(never)]
fn number(symbols: &mut Symbols, input: &Input<'_>, context: Context) -> i32 {
    let symbol = symbols.number(input, tables::number(context.index));
    let index = symbol.div_ceil(2);
    let size = if index <= DIRECT {
        index
    } else if index < FAR {
        group(index - DIRECT) + symbols.bits(input, index - DIRECT)
    } else {
        let bits = symbols.bits(input, FAR_BITS);
        // At most 2^31 + 2^7: it may wrap, but no well-formed number is so large.
        group(GROUPS + 1) - 1 + (1 << bits) + symbols.long_bits(input, bits)
    };
    let negative = (symbol & 1 != 0) != context.flipped;
    if negative { (size as i32).wrapping_neg() } else { size as i32 }
}
