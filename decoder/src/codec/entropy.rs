//! Range-variant asymmetric numeral system (rANS; Duda 2013), static tables, byte by byte.
//!
//! Any bytes decode to some symbols: nothing behind it can fail. One multiplication a symbol, no division.

use crate::blocks::Input;
use crate::bytes::Reader;

/// Probabilities are multiples of 2^-12.
pub const SCALE_BITS: u32 = 12;
/// The state lies in `LOW..LOW << 8` between symbols.
pub const LOW: u32 = 1 << 16;
/// Bytes of the state at the start of a stream.
pub const STATE_BYTES: usize = 3;

/// An alphabet's cumulative probabilities in 2^-12: the low 12 bits of entry i are where symbol i starts; the last symbol ends
/// at 2^12. The high 4 bits of entry i say at which symbol to begin to look for a number of [`SIXTEENTH`] i.
pub type Table = [u16];

/// Bits of a number's place within the sixteenth that the high bits of a [`Table`] speak of.
pub const SIXTEENTH: u32 = SCALE_BITS - 4;

/// Where a symbol starts, by its entry.
#[inline(always)]
pub const fn start(entry: u16) -> u32 {
    entry as u32 & ((1 << SCALE_BITS) - 1)
}

/// How far symbols have been read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cursor {
    /// The next byte, counted from the motion's first.
    pub(crate) position: u32,
    state: u32,
}

impl Cursor {
    /// Starts at `position`.
    #[inline(never)]
    pub(crate) fn start(input: &Input<'_>, position: u32) -> Cursor {
        let mut reader = Reader::of_blocks(input, position);
        let state = reader.state();
        Cursor::at(reader.position, state)
    }

    /// Goes on where another reader was.
    pub(crate) fn at(position: u32, state: u32) -> Cursor {
        // No well-formed stream holds a state outside; from one inside, two bytes lead back into the range.
        Cursor { position, state: state.clamp(LOW, (LOW << 8) - 1) }
    }

    /// What [`Cursor::at`] takes.
    pub(crate) fn state(&self) -> u32 {
        self.state
    }
}

/// Reads symbols from the blocks of a motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Symbols<'a> {
    pub(crate) at: Cursor,
    pub(crate) input: Input<'a>,
}

impl Symbols<'_> {
    /// Shifts bytes in until the state is in range: two at most, as a symbol leaves LOW >> 12 or more, and 8 bits LOW >> 8.
    #[inline(always)]
    fn refill(&mut self) {
        if self.at.state < LOW {
            self.at.state = (self.at.state << 8) | u32::from(self.input.byte(&mut self.at.position));
            if self.at.state < LOW {
                self.second_byte();
            }
        }
    }

    /// Few symbols are so rare that they need it.
    #[cold]
    #[inline(never)]
    fn second_byte(&mut self) {
        self.at.state = (self.at.state << 8) | u32::from(self.input.byte(&mut self.at.position));
    }

    /// The next symbol of the alphabet `table`.
    #[inline(never)]
    pub(crate) fn symbol(&mut self, table: &Table) -> u32 {
        self.symbol_in_line(table)
    }

    /// The same where calls would cost too much.
    #[cfg_attr(not(target_arch = "wasm32"), inline(always))]
    pub(crate) fn symbol_in_line(&mut self, table: &Table) -> u32 {
        let state = self.at.state;
        let low = state & ((1 << SCALE_BITS) - 1);
        let mut symbol = table.get((low >> SIXTEENTH) as usize).map_or(0, |&entry| usize::from(entry >> SCALE_BITS));
        let mut from = table.get(symbol).map_or(0, |&entry| start(entry));
        let size = loop {
            let next = table.get(symbol + 1).map_or(1 << SCALE_BITS, |&entry| start(entry));
            if low < next {
                break next.wrapping_sub(from);
            }
            from = next;
            symbol += 1;
        };
        // state < 2^24, so the product stays below 2^24.
        self.at.state = size * (state >> SCALE_BITS) + low.wrapping_sub(from);
        self.refill();
        symbol as u32
    }

    /// The next `count` bits, 8 at most.
    #[inline(never)]
    pub(crate) fn bits(&mut self, count: u32) -> u32 {
        self.few_bits(count)
    }

    /// The same where calls would cost too much.
    #[inline(always)]
    pub(crate) fn few_bits(&mut self, count: u32) -> u32 {
        let value = self.at.state & ((1 << count) - 1);
        self.at.state >>= count;
        self.refill();
        value
    }

    /// The next `count` bits, 32 at most, the least significant first.
    #[inline(always)]
    pub(crate) fn long_bits(&mut self, count: u32) -> u32 {
        let mut value = 0;
        let mut shift = 0;
        while shift < count {
            let part = (count - shift).min(8);
            value |= self.bits(part) << shift;
            shift += part;
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_read_only_while_the_state_is_below_its_range() {
        // The state before, the bits that are read, then the state and the number of bytes that were shifted in.
        for (state, bits, after, bytes) in [
            (LOW << 4, 4, LOW, 0),
            ((LOW << 4) - 1, 4, ((LOW - 1) << 8) | 0xa0, 1),
            // 2^8, and a byte of 0: the state is at the lower end of its range after the first one.
            (LOW, 8, LOW, 1),
            (LOW - 1, 8, (0xff << 16) | 0xa0b0, 2),
        ] {
            let input = Input(if after == LOW { &[0, 0xb0] } else { &[0xa0, 0xb0] });
            let mut symbols = Symbols { at: Cursor { position: 0, state }, input };
            symbols.bits(bits);
            assert_eq!((symbols.at.state, symbols.at.position), (after, bytes), "{state:#x}");
        }
    }
}
