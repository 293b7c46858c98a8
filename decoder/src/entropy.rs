//! Range-variant asymmetric numeral system (rANS; Duda 2013), static tables, byte by byte.
//!
//! Any bytes decode to some symbols: nothing behind it can fail. One multiplication a symbol, no division.

use crate::blocks::Input;

/// Probabilities are multiples of 2^-12.
pub const SCALE_BITS: u32 = 12;
/// The state lies in `LOW..LOW << 8` between symbols.
pub const LOW: u32 = 1 << 16;
/// Bytes of the state at the start of a stream.
pub const STATE_BYTES: usize = 3;

/// Cumulative probabilities of an alphabet: entry i is where symbol i + 1 starts; the last symbol ends at 2^12.
pub type Table = [u16];

/// Reads symbols from the blocks of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Symbols {
    /// The next byte, counted from the motion's first.
    pub(crate) position: u32,
    state: u32,
}

impl Symbols {
    /// Starts at `position`.
    pub(crate) fn start(input: &Input<'_>, position: u32) -> Symbols {
        let mut symbols = Symbols { position, state: 0 };
        for _ in 0..STATE_BYTES {
            symbols.state = (symbols.state << 8) | u32::from(input.byte(&mut symbols.position));
        }
        symbols
    }

    /// Shifts bytes in until the state is in range: two at most after any symbol of a well-formed stream.
    #[inline]
    fn refill(&mut self, input: &Input<'_>) {
        while self.state < LOW {
            self.state = (self.state << 8) | u32::from(input.byte(&mut self.position));
            if self.state == 0 {
                // Only a malformed stream gets here; any state in range ends the loop.
                self.state = LOW;
            }
        }
    }

    /// The next symbol of the alphabet `table`: an index of at most `table.len()`.
    pub(crate) fn symbol(&mut self, input: &Input<'_>, table: &Table) -> u32 {
        let low = (self.state & ((1 << SCALE_BITS) - 1)) as u16;
        let mut symbol = 0;
        let mut start = 0;
        let mut end = 1 << SCALE_BITS;
        for &next in table {
            if low < next {
                end = next;
                break;
            }
            start = next;
            symbol += 1;
        }
        // state < 2^24, so the product stays below 2^24.
        self.state = u32::from(end.wrapping_sub(start)) * (self.state >> SCALE_BITS) + u32::from(low - start);
        self.refill(input);
        symbol
    }

    /// The next `count` bits, 8 at most.
    pub(crate) fn bits(&mut self, input: &Input<'_>, count: u32) -> u32 {
        let value = self.state & ((1 << count) - 1);
        self.state >>= count;
        self.refill(input);
        value
    }

    /// The next `count` bits, 32 at most, the least significant first.
    pub(crate) fn long_bits(&mut self, input: &Input<'_>, count: u32) -> u32 {
        let mut value = 0;
        let mut shift = 0;
        while shift < count {
            let part = (count - shift).min(8);
            value |= self.bits(input, part) << shift;
            shift += part;
        }
        value
    }
}
