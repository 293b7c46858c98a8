//! Collects the fields of a packet's payload, and how many bits they cost.

use pantin::codec::entropy::{LOW, SCALE_BITS};
use pantin_convert::rans::{self, Digit};
use pantin_link::wire::{Coder, Table};

/// The fields of a payload in the order in which a receiver reads them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Writer {
    digits: Vec<Digit>,
    /// Bits of the fields so far, without the coder's final state.
    pub(crate) cost_bits: f64,
}

impl Coder for Writer {
    fn symbol(&mut self, table: &Table, symbol: u32) -> u32 {
        let start = table.iter().take(symbol as usize).map(|&size| u32::from(size)).sum();
        let size = u32::from(table[symbol as usize]);
        self.cost_bits += f64::from(SCALE_BITS) - f64::from(size).log2();
        self.digits.push(Digit::Symbol { start, size });
        symbol
    }

    fn few_bits(&mut self, count: u32, value: u32) -> u32 {
        self.cost_bits += f64::from(count);
        self.digits.push(Digit::Bits { value, count });
        value
    }
}

impl Writer {
    /// Appends the fields of `other`.
    pub(crate) fn append(&mut self, other: &Writer) {
        self.digits.extend_from_slice(&other.digits);
        self.cost_bits += other.cost_bits;
    }

    /// Returns the payload. A receiver must find `check` at its end.
    pub(crate) fn finish(&self, check: u16) -> Vec<u8> {
        rans::encode(&self.digits, LOW | u32::from(check))
    }
}
