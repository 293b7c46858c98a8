//! The binary range decoder of key clips: adaptive contexts that all start even, one multiplication a bit.

use super::layout::{CHANCE_BITS, CHANCES, EVEN, MAX_GAMMA, RATES, context};
use crate::blocks::Input;

/// A context: the chance of a 1 in the high 12 bits, the number of bits that came in the low 4.
type Context = u16;

/// Reads bits from the blocks of a motion. Any bytes are some bits.
pub(super) struct Bits<'a> {
    input: Input<'a>,
    position: u32,
    /// At least 2^24 between bits.
    range: u32,
    code: u32,
    contexts: [Context; context::COUNT_OF_ALL],
}

impl<'a> Bits<'a> {
    #[inline(always)]
    pub(super) fn new(input: Input<'a>, position: u32) -> Bits<'a> {
        let contexts = [(EVEN << 4) as Context; context::COUNT_OF_ALL];
        let mut bits = Bits { input, position, range: u32::MAX, code: 0, contexts };
        for _ in 0..4 {
            bits.shift();
        }
        bits.range = u32::MAX;
        bits
    }

    fn shift(&mut self) {
        self.range <<= 8;
        self.code = self.code << 8 | u32::from(self.input.byte(&mut self.position));
    }

    /// The next bit, which is 1 with this chance.
    #[inline(never)]
    fn split(&mut self, chance: u32) -> bool {
        // At least 2^12 times a chance of 40, at most all but as much.
        let ones = (self.range >> CHANCE_BITS) * chance;
        let bit = self.code < ones;
        if bit {
            self.range = ones;
        } else {
            self.code -= ones;
            self.range -= ones;
        }
        while self.range < 1 << 24 {
            self.shift();
        }
        bit
    }

    /// The next bit of a context, which learns from it.
    #[inline(never)]
    pub(super) fn bit(&mut self, context: usize) -> bool {
        let state = self.contexts.get(context).copied().unwrap_or((EVEN << 4) as Context);
        let (chance, count) = (u32::from(state >> 4), state & 15);
        let bit = self.split(chance);
        let rate = u32::from(RATES.get(usize::from(count)).copied().unwrap_or(0));
        // Below 2^28.
        let chance = if bit { chance + ((((1 << CHANCE_BITS) - chance) * rate) >> 16) } else { chance - ((chance * rate) >> 16) };
        let chance = chance.clamp(CHANCES[0], CHANCES[1]);
        if let Some(state) = self.contexts.get_mut(context) {
            *state = (chance << 4) as Context | (count + 1).min(15);
        }
        bit
    }

    /// The next `count` bits, the most significant first; 32 at most.
    #[inline(never)]
    pub(super) fn raw(&mut self, count: u32) -> u32 {
        (0..count).fold(0, |value, _| value << 1 | u32::from(self.split(EVEN)))
    }

    /// How many 1s come before a 0, up to `most`, after which none follows.
    #[inline(never)]
    pub(super) fn unary(&mut self, first: usize, most: u32) -> u32 {
        let mut ones = 0;
        while ones < most && self.bit(first + (ones as usize).min(context::LONG - 1)) {
            ones += 1;
        }
        ones
    }

    /// A number from 0: its length in unary, then raw bits.
    #[inline(never)]
    pub(super) fn gamma(&mut self, first: usize) -> u32 {
        let bits = self.unary(first, MAX_GAMMA);
        (1 << bits | self.raw(bits)) - 1
    }
}
