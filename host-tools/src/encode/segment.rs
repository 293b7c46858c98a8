//! A segment's symbols: the mirror of `pantin::codec::segment`.

use super::entropy::{Alphabet, Sink};
use pantin::codec::layout::{DIRECT, FAR, FAR_BITS, GROUPS, group, segment_type};
use pantin::codec::segment::{Context, DIRECT_MODES, MODE_BITS, SLOPE, step};

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
        usize::from(pantin::codec::segment_frames(self.mode))
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
    /// Sign of the acceleration before, as the decoder keeps it.
    pub turn: i8,
    /// Mode of the segment that ends.
    pub mode: u8,
    /// Index of the channel's step.
    pub step: u8,
}

/// The symbol of a number, and the bits that follow it: their value and count, in the order of reading.
pub fn number_symbol(number: i32) -> (u32, [(u32, u32); 2]) {
    let size = number.unsigned_abs();
    let symbol = |index: u32| if number < 0 { 2 * index - 1 } else { 2 * index };
    if size <= DIRECT {
        return (symbol(size), [(0, 0); 2]);
    }
    for bits in 1..=GROUPS {
        if size < group(bits + 1) {
            return (symbol(DIRECT + bits), [(size - group(bits), bits), (0, 0)]);
        }
    }
    let rest = size - group(GROUPS + 1) + 1;
    let bits = rest.ilog2();
    (symbol(FAR), [(bits, FAR_BITS), (rest - (1 << bits), bits)])
}

/// The symbol of a mode and, where it does not name the mode, the bits that do.
pub fn mode_symbol(mode: u8) -> (u32, Option<u32>) {
    let mode = u32::from(mode);
    if mode < DIRECT_MODES { (mode, None) } else { (DIRECT_MODES, Some(mode - DIRECT_MODES)) }
}

impl Running {
    /// Starts the segment: what the decoder's state is once it has read it. With `out`, writes its symbols.
    pub fn start(&mut self, segment: Segment, mut out: Option<&mut dyn Sink>) {
        let mode = segment.mode;
        let mut number = |context: Context, number: i32| {
            let Some(out) = out.as_deref_mut() else { return };
            let (symbol, bits) = number_symbol(if context.flip != 0 { -number } else { number });
            out.symbol(Alphabet::Number(context.index), symbol);
            bits.iter().for_each(|&(value, count)| out.bits(value, count));
        };
        let length = mode & 15;
        if matches!(segment.kind(), segment_type::W | segment_type::WK) {
            let unit = step(length, self.step);
            let context = Context::new(length, self.w, self.turn, unit);
            number(context, segment.w);
            (self.w, self.turn) = (segment.w.wrapping_mul(unit as i32), context.sign);
        }
        if matches!(segment.kind(), segment_type::K | segment_type::WK) {
            let unit = step(length | SLOPE, self.step);
            number(Context::new(length | SLOPE, self.k, 0, unit), segment.k);
            self.k = segment.k.wrapping_mul(unit as i32);
        } else {
            self.k = 0;
        }
        self.mode = mode;
    }

    /// Writes the mode's symbol; the numbers follow by [`Running::start`].
    pub fn put_mode(&self, mode: u8, out: &mut dyn Sink) {
        let (symbol, bits) = mode_symbol(mode);
        out.symbol(Alphabet::Mode(self.mode), symbol);
        if let Some(bits) = bits {
            out.bits(bits, MODE_BITS);
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
