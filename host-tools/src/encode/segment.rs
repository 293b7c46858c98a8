//! A segment's symbols: the mirror of `pantin::segment`.

use super::entropy::Symbols;
use pantin::layout::{K_STEPS, MAX_MAGNITUDE, W_STEPS, segment_type};
use pantin::segment::{self, Context, DIRECT_MODES};
use pantin::tables;

/// A segment: its mode, and how many steps its new acceleration and slope have (0 if it has none).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Type and index of the length.
    pub mode: u8,
    /// The new acceleration in its steps.
    pub w: i32,
    /// The new slope in its steps.
    pub k: i32,
}

impl Segment {
    /// Its length in frames.
    pub fn length(&self) -> usize {
        usize::from(pantin::length(self.mode))
    }

    /// Its type.
    pub fn kind(&self) -> u8 {
        self.mode >> 4
    }
}

/// What the next segment's statistics depend on: the mirror of a decoder's `ChannelState` without its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Running {
    /// Velocity.
    pub v: i32,
    /// Acceleration.
    pub w: i32,
    /// Slope.
    pub k: i32,
    /// The acceleration before, as the decoder keeps it.
    pub last: i16,
    /// Mode of the segment that ends.
    pub mode: u8,
    /// Index of the channel's step.
    pub step: u8,
}

/// The symbol of a number and, where it is too large for one, what is left over.
pub fn number_symbol(number: i32) -> (u32, Option<i32>) {
    let limit = MAX_MAGNITUDE as i32;
    let zigzag = |n: i32| ((n << 1) ^ (n >> 31)) as u32;
    if number.abs() < limit { (zigzag(number), None) } else { (zigzag(limit * number.signum()), Some(number.abs() - limit)) }
}

/// The symbol of a mode and, where it names the type alone, the length's index.
pub fn mode_symbol(mode: u8) -> (u32, Option<u32>) {
    match tables::MODES.iter().position(|&other| other == mode) {
        Some(symbol) => (symbol as u32, None),
        None => (DIRECT_MODES + u32::from(mode >> 4 & 1), Some(u32::from(mode & 15))),
    }
}

impl Running {
    /// Starts the segment: what the decoder's state is once it has read it. With `out`, writes its symbols.
    pub fn start(&mut self, segment: Segment, mut out: Option<&mut Symbols>) {
        let mode = segment.mode;
        let mut number = |context: Context, number: i32| {
            let Some(out) = out.as_deref_mut() else { return };
            let (symbol, excess) = number_symbol(if context.flipped { -number } else { number });
            out.symbol(tables::number(context.index), symbol);
            if let Some(excess) = excess {
                out.magnitude(&tables::EXCESS, excess);
            }
        };
        let before = i32::from(self.last) << segment::last_shift(self.step);
        self.last = segment::keep_last(self.w, self.step);
        if matches!(segment.kind(), segment_type::W | segment_type::WK) {
            let unit = segment::step(&W_STEPS, mode, self.step);
            number(Context::new(false, mode, self.w, before, unit), segment.w);
            self.w = segment.w.wrapping_mul(unit as i32);
        }
        if matches!(segment.kind(), segment_type::K | segment_type::WK) {
            let unit = segment::step(&K_STEPS, mode, self.step);
            number(Context::new(true, mode, self.k, 0, unit), segment.k);
            self.k = segment.k.wrapping_mul(unit as i32);
        } else {
            self.k = 0;
        }
        self.mode = mode;
    }

    /// Writes the mode's symbol; the numbers follow by [`Running::start`].
    pub fn put_mode(&self, mode: u8, out: &mut Symbols) {
        let (symbol, length) = mode_symbol(mode);
        out.symbol(tables::mode(self.mode), symbol);
        if let Some(length) = length {
            out.bits(length, 4);
        }
    }

    /// Goes on to the segment's end.
    pub fn run(&mut self, frames: usize) {
        for _ in 0..frames {
            self.v = self.v.wrapping_add(self.w);
            self.w = self.w.wrapping_add(self.k);
        }
    }
}
