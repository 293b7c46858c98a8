//! Writes what `pantin::codec::entropy` reads. rANS is last in, first out: symbols are gathered, then coded from the last to the first.

use super::rans::{self, Digit};
use pantin::codec::entropy::{LOW, SCALE_BITS, Table, start};
use pantin::codec::tables;

/// What a symbol is of: the format's tables by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Alphabet {
    /// Whether a channel rests, is constant, moves or follows, in this context.
    Status(u8),
    /// How a channel's step differs from the one before.
    StepChange,
    /// Bits of a first position.
    Position,
    /// Bits of a first velocity.
    Velocity,
    /// A segment's mode in this context: the mode before, or [`pantin::codec::segment::SECOND`].
    Mode(u8),
    /// An acceleration or slope in this context.
    Number(u8),
    /// Bits of a number beyond all groups.
    Far,
}

impl Alphabet {
    /// Its table.
    pub fn table(self) -> &'static Table {
        match self {
            Alphabet::Status(after) => tables::status(after),
            Alphabet::StepChange => &tables::STEP_CHANGE,
            Alphabet::Position => &tables::POSITION,
            Alphabet::Velocity => &tables::VELOCITY,
            Alphabet::Mode(after) => tables::mode(after),
            Alphabet::Number(context) => tables::number(context),
            Alphabet::Far => &tables::FAR,
        }
    }
}

/// Takes symbols in the order in which a decoder reads them.
pub trait Sink {
    /// Takes a symbol.
    fn symbol(&mut self, alphabet: Alphabet, symbol: u32);

    /// Takes `count` bits, 32 at most, the least significant first.
    fn bits(&mut self, value: u32, count: u32);

    /// A signed number: its length in bits as a symbol, the bits below the highest, the sign.
    fn magnitude(&mut self, alphabet: Alphabet, value: i32) {
        let size = value.unsigned_abs();
        let bits = u32::BITS - size.leading_zeros();
        self.symbol(alphabet, bits);
        if bits > 0 {
            self.bits(size & !(1 << (bits - 1)), bits - 1);
            self.bits(u32::from(value < 0), 1);
        }
    }
}

/// Symbols in the order in which a decoder reads them.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    digits: Vec<Digit>,
}

/// Probabilities in 2^-12 of an alphabet's symbols.
pub fn sizes(table: &Table) -> impl Iterator<Item = u32> + '_ {
    (0..table.len() as u32).map(|symbol| stretch(table, symbol).1)
}

/// Start and size of a symbol's stretch of 4096.
pub fn stretch(table: &Table, symbol: u32) -> (u32, u32) {
    let start = start(table[symbol as usize]);
    let end = table.get(symbol as usize + 1).map_or(1 << SCALE_BITS, |&next| pantin::codec::entropy::start(next));
    (start, end - start)
}

/// What a symbol costs, in bits.
pub fn cost(table: &Table, symbol: u32) -> f64 {
    f64::from(SCALE_BITS) - f64::from(stretch(table, symbol).1).log2()
}

impl Symbols {
    /// The bytes. A decoder reads zeros past the end, so those that it would read there are left out.
    pub fn finish(&self) -> Vec<u8> {
        let mut bytes = rans::encode(&self.digits, LOW);
        while bytes.last() == Some(&0) {
            bytes.pop();
        }
        bytes
    }
}

impl Sink for Symbols {
    fn symbol(&mut self, alphabet: Alphabet, symbol: u32) {
        let (start, size) = stretch(alphabet.table(), symbol);
        self.digits.push(Digit::Symbol { start, size });
    }

    fn bits(&mut self, mut value: u32, mut count: u32) {
        while count > 0 {
            let part = count.min(8);
            self.digits.push(Digit::Bits { value: value & ((1 << part) - 1), count: part });
            value = value.checked_shr(part).unwrap_or(0);
            count -= part;
        }
    }
}

/// What [`Sink::magnitude`] costs, in bits.
pub fn magnitude_cost(table: &Table, value: i32) -> f64 {
    let bits = u32::BITS - value.unsigned_abs().leading_zeros();
    cost(table, bits) + f64::from(bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin::codec::entropy::SIXTEENTH;
    use pantin::codec::layout::STATUS_CONTEXTS;
    use pantin::codec::segment::{CONTEXTS, MODE_CONTEXTS};

    #[test]
    fn tables_are_probabilities_and_their_hints_never_lead_past_the_symbol() {
        let few = [Alphabet::StepChange, Alphabet::Position, Alphabet::Velocity, Alphabet::Far];
        let contexts = (0..STATUS_CONTEXTS as u8).map(Alphabet::Status).chain((0..MODE_CONTEXTS as u8).map(Alphabet::Mode));
        let contexts = contexts.chain((0..CONTEXTS as u8).map(Alphabet::Number)).chain(few);
        for alphabet in contexts {
            let table = alphabet.table();
            assert!(sizes(table).all(|size| size > 0) && sizes(table).sum::<u32>() == 1 << SCALE_BITS, "{alphabet:?}");
            for (sixteenth, entry) in (0..16).zip(table) {
                let hint = u32::from(entry >> SCALE_BITS);
                assert!(stretch(table, hint).0 <= sixteenth << SIXTEENTH, "{alphabet:?}, sixteenth {sixteenth}: {hint}");
            }
        }
    }
}
