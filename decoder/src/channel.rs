//! One channel: its state, the three additions, and how its start is read.

use crate::blocks::Input;
use crate::entropy::Symbols;
use crate::layout::{FIRST_STEP, LENGTHS, MAX_STEP, START_MODE, STEP_BITS, STEP_CHANGES};
use crate::rig::Kind;
use crate::tables;

/// No next channel: the end of a list.
pub(crate) const NIL: u16 = 0x3ff;

/// A moving channel between two frames: 20 bytes. Its position p stands in the pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChannelState {
    /// Velocity, acceleration, slope: what p, v and w grow by (METHOD 2.2).
    pub(crate) v: i32,
    pub(crate) w: i32,
    pub(crate) k: i32,
    /// Index of p in the pose.
    pub(crate) slot: u16,
    /// Bits 0 to 9: the next channel in the same list; bits 10 to 15: the mode of the running segment.
    pub(crate) link: u16,
    /// The acceleration that the last new one took over from, in 2^-12 channel steps; it is a context of the next.
    pub(crate) last: i16,
    /// The frame at which the running segment ends, modulo 256.
    pub(crate) due: u8,
    /// Index of the channel's step.
    pub(crate) step: u8,
}

impl ChannelState {
    pub(crate) fn next(&self) -> u16 {
        self.link & NIL
    }

    pub(crate) fn set_next(&mut self, next: u16) {
        self.link = (self.link & !NIL) | (next & NIL);
    }

    pub(crate) fn mode(&self) -> u8 {
        (self.link >> 10) as u8
    }

    pub(crate) fn set_mode(&mut self, mode: u8) {
        self.link = self.next() | u16::from(mode) << 10;
    }

    /// Frames of the running segment, 0 if there was none yet.
    pub(crate) fn length(&self) -> u8 {
        if self.mode() == START_MODE { 0 } else { length(self.mode()) }
    }

    /// `n` frames at once, backwards if negative, bit for bit what `n` times the three additions give; |n| < 2^9.
    pub(crate) fn hop(&mut self, p: &mut i32, n: i32) {
        // C(n, 2) < 2^18. C(n, 3) = C(n, 2) (n - 2) / 3 is whole: times the inverse of 3 modulo 2^32, it is divided.
        let c2 = (n * (n - 1)) >> 1;
        let c3 = c2.wrapping_mul(n - 2).wrapping_mul(0xaaaa_aaab_u32 as i32);
        let grow = |a: i32, b: i32, x: i32| a.wrapping_add(b.wrapping_mul(x));
        *p = grow(grow(grow(*p, n, self.v), c2, self.w), c3, self.k);
        self.v = grow(grow(self.v, n, self.w), c2, self.k);
        self.w = grow(self.w, n, self.k);
    }
}

/// Frames of a segment of this mode.
pub const fn length(mode: u8) -> u8 {
    LENGTHS[(mode & 15) as usize]
}

/// What the channels read so far tell about the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Opening {
    status: u8,
    steps: [u8; 2],
}

impl Default for Opening {
    fn default() -> Self {
        Opening { status: 0, steps: [FIRST_STEP; 2] }
    }
}

/// A channel's step in raw units: 2^(index / 2).
pub const fn step_size(index: u8) -> u32 {
    let whole = 1u32 << (index >> 1);
    // 181 / 128 is the square root of 2, to 0.01 %.
    if index & 1 == 0 {
        whole
    } else if whole < 128 {
        (whole * 181) >> 7
    } else {
        (whole >> 7) * 181
    }
}

impl Opening {
    /// The next channel's start: its step's index, and `Some` velocity if it moves.
    pub(crate) fn read(&mut self, symbols: &mut Symbols, input: &Input<'_>, kind: Kind) -> (Option<i32>, Option<(i32, u8)>) {
        let status = symbols.symbol(input, tables::status(self.status)) as u8;
        self.status = status.min(2);
        if status == 0 {
            return (None, None);
        }
        let class = usize::from(kind.is_position());
        let change = symbols.symbol(input, &tables::STEP_CHANGE);
        let step = if change < STEP_CHANGES {
            self.steps.get(class).copied().unwrap_or(FIRST_STEP).wrapping_add(unzigzag(change) as u8)
        } else {
            symbols.bits(input, STEP_BITS) as u8
        };
        let step = step.min(MAX_STEP);
        if let Some(last) = self.steps.get_mut(class) {
            *last = step;
        }
        let grid = step_size(step);
        let p = magnitude(symbols, input, &tables::POSITION).wrapping_mul((grid >> 1).max(1) as i32);
        if status == 1 {
            return (Some(p), None);
        }
        let v = magnitude(symbols, input, &tables::VELOCITY).wrapping_mul((grid >> 2).max(1) as i32);
        (Some(p), Some((v, step)))
    }
}

/// 0, 1, 2, 3, ... as 0, -1, 1, -2, ...
pub(crate) const fn unzigzag(n: u32) -> i32 {
    (n >> 1) as i32 ^ -((n & 1) as i32)
}

/// A signed number: the symbol is its length in bits, then come the bits below the highest, then the sign.
pub(crate) fn magnitude(symbols: &mut Symbols, input: &Input<'_>, table: &[u16]) -> i32 {
    let bits = symbols.symbol(input, table);
    let Some(below) = bits.checked_sub(1) else { return 0 };
    let value = (1 << below.min(31)) | symbols.long_bits(input, below.min(31)) as i32;
    if symbols.bits(input, 1) == 0 { value } else { value.wrapping_neg() }
}
