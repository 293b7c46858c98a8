//! The fields of a payload, coded by rANS with static tables (FORMAT.md 5). One description serves both ends: a [`Coder`] returns what it reads, or what
//! it was given to write.
//!
//! The encoder starts at 2^16 plus a 16-bit **check**, which the decoder must find at the payload's end, with no byte left. It ties a packet to its
//! session without costing a byte, and adds to the CRC.

/// The probabilities of an alphabet's symbols in 2^-12: each at least 1, in total 4096.
pub type Table = [u16];

const SCALE_BITS: u32 = 12;
/// Between symbols, the state is in `LOW..LOW << 8`.
const LOW: u32 = 1 << 16;

/// Reads the fields of a payload, or writes them.
pub trait Coder {
    /// Codes a symbol of an alphabet.
    fn symbol(&mut self, table: &Table, symbol: u32) -> u32;

    /// Codes at most 8 bits.
    fn few_bits(&mut self, count: u32, value: u32) -> u32;

    /// Codes at most 32 bits, the least significant first.
    fn bits(&mut self, count: u32, value: u32) -> u32 {
        let (mut read, mut shift) = (0, 0);
        while shift < count {
            let part = (count - shift).min(8);
            read |= self.few_bits(part, value >> shift & ((1 << part) - 1)) << shift;
            shift += part;
        }
        read
    }

    /// Codes a signed number: its length in bits (a symbol of 33), the bits below the highest, and the sign.
    fn magnitude(&mut self, table: &Table, value: i32) -> i32 {
        let size = value.unsigned_abs();
        let Some(below) = self.symbol(table, u32::BITS - size.leading_zeros()).checked_sub(1) else { return 0 };
        let below = below.min(31);
        let read = 1 << below | self.bits(below, size & !(1 << below));
        if self.few_bits(1, u32::from(value < 0)) == 0 { read as i32 } else { (read as i32).wrapping_neg() }
    }
}

/// Reads the fields of a payload.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SymbolReader<'a> {
    bytes: &'a [u8],
    state: u32,
    /// Whether more was read than the payload has.
    past: bool,
}

impl<'a> SymbolReader<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let mut reader = SymbolReader { bytes, state: 0, past: false };
        for _ in 0..3 {
            reader.shift();
        }
        // No valid payload starts below LOW. From here on the state is never 0, so every refill ends.
        reader.state = reader.state.max(LOW);
        reader
    }

    fn shift(&mut self) {
        let byte = if let Some((&first, rest)) = self.bytes.split_first() {
            self.bytes = rest;
            first
        } else {
            self.past = true;
            0
        };
        self.state = self.state << 8 | u32::from(byte);
    }

    fn refill(&mut self) {
        while self.state < LOW {
            self.shift();
        }
    }

    /// Returns whether more was read than the payload has.
    pub(crate) fn past(&self) -> bool {
        self.past
    }

    /// Returns whether this is the payload's end and `check` is the check that the encoder started with.
    pub(crate) fn ends_with(&self, check: u16) -> bool {
        !self.past && self.bytes.is_empty() && self.state == LOW | u32::from(check)
    }
}

impl Coder for SymbolReader<'_> {
    fn symbol(&mut self, table: &Table, _: u32) -> u32 {
        let mut low = self.state & ((1 << SCALE_BITS) - 1);
        let mut symbol = 0;
        for &size in table {
            let size = u32::from(size);
            if low < size {
                // Both factors are less than 2^12.
                self.state = size * (self.state >> SCALE_BITS) + low;
                self.refill();
                break;
            }
            low -= size;
            symbol += 1;
        }
        symbol
    }

    fn few_bits(&mut self, count: u32, _: u32) -> u32 {
        let value = self.state & ((1 << count) - 1);
        self.state >>= count;
        self.refill();
        value
    }
}
