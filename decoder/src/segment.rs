//! One segment: its mode, then its acceleration, its slope, both, or neither.

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
#[inline(always)]
pub fn step(steps: &[u32; 16], mode: u8, channel_step: u8) -> u32 {
    let even = steps[usize::from(mode & 15)];
    // At most 2^20 * 181 / 128 < 2^21, then shifted up by (MAX_STEP >> 1) - 20 = 9.
    let scaled = if channel_step & 1 == 0 { even } else { (even * 181) >> 7 };
    let exponent = u32::from(channel_step >> 1);
    if exponent >= 20 { scaled << ((exponent - 20) & 31) } else { (scaled >> (20 - exponent)).max(1) }
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
        let length_class = (LENGTH_CLASSES >> (2 * (mode & 15))) as u8 & 3;
        // step < 2^30, so nothing here passes 2^32.
        let half = (step + 1) >> 1;
        let size = now.unsigned_abs();
        let mut a = 0;
        let mut turned = before;
        let b = if before.unsigned_abs() < half { 0 } else { before.signum() };
        if size >= half {
            a = 1 + u8::from(size >= half + step) + u8::from(size >= half + 2 * step);
            turned = now;
        } else if b == 0 {
            turned = 0;
        }
        let flip = turned >> 31;
        let b = (b ^ flip) - flip;
        let index = (length_class + 4 * u8::from(slope)) * 12 + a * 3 + (b + 1) as u8;
        Context { index, flipped: flip != 0 }
    }
}

/// Classes of lengths, two bits each: 1, 2 and 3, 4 to 8, longer.
const LENGTH_CLASSES: u32 = 0xffff_ea94;

/// The scale of [`ChannelState`]'s `last`: raw units are shifted down by this much.
pub fn last_shift(channel_step: u8) -> u32 {
    u32::from(channel_step >> 1).saturating_sub(12)
}

/// `w` as `last` keeps it.
pub fn keep_last(w: i32, channel_step: u8) -> i16 {
    (w >> last_shift(channel_step)).clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}

/// Reads the segment that follows the one that `state` has ended.
pub(crate) fn read(state: &mut ChannelState, symbols: &mut Symbols<'_>) {
    let mode = mode(symbols, state.mode);
    let before = i32::from(state.last) << last_shift(state.step);
    state.last = keep_last(state.w, state.step);
    let kind = mode >> 4;
    if kind == segment_type::W || kind == segment_type::WK {
        state.w = coefficient(symbols, false, mode, state.step, state.w, before);
    }
    state.k = if kind == segment_type::K || kind == segment_type::WK {
        coefficient(symbols, true, mode, state.step, state.k, 0)
    } else {
        0
    };
    state.mode = mode;
    // It was due at this frame.
    state.due = state.due.wrapping_add(length(mode));
}

/// The mode that follows `after`.
#[inline(never)]
fn mode(symbols: &mut Symbols<'_>, after: u8) -> u8 {
    let symbol = symbols.mode(tables::mode(after));
    if let Some(&mode) = tables::MODES.get(symbol as usize) {
        return mode;
    }
    let mode = (segment_type::WK + (symbol & 1) as u8) << 4 | symbols.bits(4) as u8;
    if mode == START_MODE { START_MODE - 1 } else { mode }
}

/// A new acceleration, or slope, in raw units.
#[inline(never)]
fn coefficient(symbols: &mut Symbols<'_>, slope: bool, mode: u8, channel_step: u8, now: i32, before: i32) -> i32 {
    let unit = step(if slope { &K_STEPS } else { &W_STEPS }, mode, channel_step);
    let context = Context::new(slope, mode, now, before, unit);
    let symbol = symbols.number(tables::number(context.index));
    let index = (symbol + 1) >> 1;
    let mut size = unit.wrapping_mul(index);
    if index > DIRECT {
        size = unit.wrapping_mul(far(symbols, index));
    }
    let negative = (symbol & 1 != 0) != context.flipped;
    if negative { (size as i32).wrapping_neg() } else { size as i32 }
}

/// A magnitude above [`DIRECT`].
#[inline(never)]
fn far(symbols: &mut Symbols<'_>, index: u32) -> u32 {
    if index < FAR {
        return group(index - DIRECT) + symbols.bits(index - DIRECT);
    }
    let bits = symbols.bits(FAR_BITS);
    // At most 2^31 + 2^7: it may wrap, but no well-formed number is so large.
    (group(GROUPS + 1) - 1 + (1 << bits)).wrapping_add(symbols.long_bits(bits))
}
