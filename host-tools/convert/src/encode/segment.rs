//! A segment's symbols: the mirror of `pantin::codec::segment`.

use super::entropy::{Alphabet, Sink};
use pantin::codec::layout::{DIRECT, FAR_NUMBER, GROUPS, group, segment_type};
use pantin::codec::segment::{Context, DIRECT_MODES, SECOND, SLOPE, step};

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

/// A number as it is written: a symbol, then where that is [`FAR_NUMBER`] the number of bits, then the bits.
pub struct NumberCode {
    /// The symbol in the number's context.
    pub symbol: u32,
    /// Value and number of the bits.
    pub bits: (u32, u32),
}

impl NumberCode {
    /// The code of a number whose sign is already turned as its context says.
    pub fn of(number: i32) -> NumberCode {
        let size = number.unsigned_abs();
        let symbol = |index: u32| if number < 0 { 2 * index - 1 } else { 2 * index };
        if size <= DIRECT {
            return NumberCode { symbol: symbol(size), bits: (0, 0) };
        }
        for bits in 1..=GROUPS {
            if size < group(bits + 1) {
                return NumberCode { symbol: symbol(DIRECT + bits), bits: (size - group(bits), bits) };
            }
        }
        let rest = size - group(GROUPS + 1) + 1;
        let bits = rest.ilog2();
        NumberCode { symbol: symbol(FAR_NUMBER), bits: (rest - (1 << bits), bits) }
    }

    /// Whether the number of bits is written too.
    pub fn far(&self) -> bool {
        self.symbol.div_ceil(2) == FAR_NUMBER
    }
}

/// The symbol of a mode and, where it does not name the mode, the one that follows and does.
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
            let code = NumberCode::of(if context.flip != 0 { -number } else { number });
            out.symbol(Alphabet::Number(context.index), code.symbol);
            let (value, count) = code.bits;
            if code.far() {
                out.symbol(Alphabet::Far, count);
            }
            out.bits(value, count);
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
        } else if segment.kind() == segment_type::W {
            self.k = 0;
        }
        self.mode = mode;
    }

    /// Writes the mode's symbol; the numbers follow by [`Running::start`].
    pub fn put_mode(&self, mode: u8, out: &mut dyn Sink) {
        let (symbol, second) = mode_symbol(mode);
        out.symbol(Alphabet::Mode(self.mode), symbol);
        if let Some(second) = second {
            out.symbol(Alphabet::Mode(SECOND), second);
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
