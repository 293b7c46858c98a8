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
/// The table of a segment's mode.
pub type ModeTable = [u16; 33];
/// The table of an acceleration or a slope.
pub type NumberTable = [u16; 26];

/// Fifteen entries from `at` on.
#[inline(always)]
fn window(table: &Table, at: usize) -> &[u16; 15] {
    table.get(at..).and_then(|rest| rest.first_chunk()).unwrap_or(&[0; 15])
}

/// How many of the entries are at most `low`: four comparisons.
#[inline(always)]
fn passed(entries: &[u16; 15], low: u16) -> usize {
    let mut count = 0;
    if entries[7] <= low {
        count = 8;
    }
    if entries[count + 3] <= low {
        count += 4;
    }
    if entries[count + 1] <= low {
        count += 2;
    }
    if entries[count] <= low {
        count += 1;
    }
    count
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
    pub(crate) fn start(input: &Input<'_>, mut position: u32) -> Cursor {
        let mut state = 0;
        for _ in 0..STATE_BYTES {
            state = (state << 8) | u32::from(input.byte(&mut position));
        }
        Cursor::at(position, state)
    }

    /// Goes on where another reader was.
    pub(crate) fn at(position: u32, state: u32) -> Cursor {
        // No well-formed stream holds a state outside; one inside never becomes 0, so that every refill ends.
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
    /// Shifts bytes in until the state is in range: two at most after any symbol of a well-formed stream.
    #[inline(always)]
    fn refill(&mut self) {
        while self.at.state < LOW {
            self.at.state = (self.at.state << 8) | u32::from(self.input.byte(&mut self.at.position));
        }
    }

    #[inline(always)]
    fn low(&self) -> u16 {
        (self.at.state & ((1 << SCALE_BITS) - 1)) as u16
    }

    /// Takes the symbol that the state's low digits name.
    #[inline(always)]
    fn take(&mut self, table: &Table, symbol: usize) -> u32 {
        let low = u32::from(self.low());
        let end = table.get(symbol).map_or(1 << SCALE_BITS, |&end| u32::from(end));
        let start = table.get(symbol.wrapping_sub(1)).map_or(0, |&start| u32::from(start));
        // state < 2^24, so the product stays below 2^24.
        self.at.state = end.wrapping_sub(start) * (self.at.state >> SCALE_BITS) + low - start;
        self.refill();
        symbol as u32
    }

    /// The next symbol of the alphabet `table`: an index of at most `table.len()`.
    #[inline(never)]
    pub(crate) fn symbol(&mut self, table: &Table) -> u32 {
        let low = self.low();
        let symbol = table.iter().take_while(|&&next| next <= low).count();
        self.take(table, symbol)
    }

    /// The same for a segment's mode, by bisection.
    #[inline(always)]
    pub(crate) fn mode(&mut self, table: &ModeTable) -> u32 {
        let low = self.low();
        let [first, second, rest @ ..] = table;
        let symbol = if low < *first {
            0
        } else if low < *second {
            1
        } else {
            2 + if low < rest[15] { passed(window(rest, 0), low) } else { 16 + passed(window(rest, 16), low) }
        };
        self.take(table, symbol)
    }

    /// The same for a number, by bisection.
    #[inline(always)]
    pub(crate) fn number(&mut self, table: &NumberTable) -> u32 {
        let low = self.low();
        let symbol = if low < table[10] { passed(window(table, 0), low) } else { 11 + passed(window(table, 11), low) };
        self.take(table, symbol)
    }

    /// The next `count` bits, 8 at most.
    #[inline(never)]
    pub(crate) fn bits(&mut self, count: u32) -> u32 {
        let value = self.at.state & ((1 << count) - 1);
        self.at.state >>= count;
        self.refill();
        value
    }

    /// The next `count` bits, 32 at most, the least significant first.
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
