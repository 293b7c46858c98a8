//! Adaptive contexts: what a decoder's contexts are after each bit, and what the bits cost.

use super::range::Split;
use pantin::codec::keys::{CHANCE_BITS, CHANCES, EVEN, MAX_GAMMA, MAX_LENGTH, RATES, context, length_class};
use std::sync::LazyLock;

/// Where bits go: to a file, or on the scales.
#[derive(Clone, Debug)]
pub struct Coder {
    contexts: Vec<(u16, u8)>,
    /// The bits so far, unless they are only weighed.
    splits: Option<Vec<Split>>,
    /// What they cost, in 2^-16 bits.
    pub cost: u64,
}

/// -log2 of each chance in 2^-12, in 2^-16: by squaring in integers, so that it is the same on every machine.
static COSTS: LazyLock<Vec<u64>> = LazyLock::new(|| (0..=1u64 << CHANCE_BITS).map(cost).collect());

fn cost(chance: u64) -> u64 {
    if chance == 0 {
        return u64::from(CHANCE_BITS + 1) << 16;
    }
    let whole = 63 - chance.leading_zeros();
    let (mut mantissa, mut log) = (chance << (31 - whole), u64::from(whole));
    for _ in 0..16 {
        mantissa = (mantissa * mantissa) >> 31;
        log <<= 1;
        if mantissa >> 32 != 0 {
            mantissa >>= 1;
            log |= 1;
        }
    }
    (u64::from(CHANCE_BITS) << 16) - log
}

impl Coder {
    /// Before the first bit.
    pub fn new() -> Coder {
        Coder { contexts: vec![(EVEN as u16, 0); context::COUNT_OF_ALL], splits: Some(Vec::new()), cost: 0 }
    }

    /// The same contexts, for bits that are only weighed.
    pub fn scales(&self) -> Coder {
        Coder { contexts: self.contexts.clone(), splits: None, cost: 0 }
    }

    /// The bits.
    pub fn finish(self) -> Vec<Split> {
        self.splits.unwrap_or_default()
    }

    fn split(&mut self, chance: u16, bit: bool) {
        let all = 1usize << CHANCE_BITS;
        self.cost += COSTS[if bit { usize::from(chance) } else { all - usize::from(chance) }];
        if let Some(splits) = &mut self.splits {
            splits.push((chance, bit));
        }
    }

    /// A bit of a context.
    pub fn bit(&mut self, context: usize, bit: bool) {
        let (chance, count) = self.contexts[context];
        self.split(chance, bit);
        let (chance, rate) = (u32::from(chance), u32::from(RATES[usize::from(count)]));
        let towards =
            if bit { chance + ((((1 << CHANCE_BITS) - chance) * rate) >> 16) } else { chance - ((chance * rate) >> 16) };
        self.contexts[context] = (towards.clamp(CHANCES[0], CHANCES[1]) as u16, (count + 1).min(15));
    }

    /// Bits of even chances, the most significant first.
    pub fn raw(&mut self, value: u32, count: u32) {
        (0..count).rev().for_each(|bit| self.split(EVEN as u16, value >> bit & 1 != 0));
    }

    /// A number of at most `most` in ones, and a zero unless it is `most`.
    pub fn unary(&mut self, first: usize, value: u32, most: u32) {
        let at = |one: u32| first + (one as usize).min(context::LONG - 1);
        (0..value).for_each(|one| self.bit(at(one), true));
        if value < most {
            self.bit(at(value), false);
        }
    }

    /// A number from 0 to 2^13 - 2.
    pub fn gamma(&mut self, first: usize, value: u32) {
        let bits = u32::BITS - 1 - (value + 1).leading_zeros();
        self.unary(first, bits, MAX_GAMMA);
        self.raw((value + 1) & ((1 << bits) - 1), bits);
    }

    /// A residual; returns its length in bits.
    pub fn residual(&mut self, other: bool, before: Option<u32>, value: i32) -> u32 {
        let first = context::LENGTH + (4 * usize::from(other) + before.map_or(0, length_class)) * context::LONG;
        let (size, bits) = (value.unsigned_abs(), u32::BITS - value.unsigned_abs().leading_zeros());
        self.unary(first, bits, MAX_LENGTH);
        if let Some(below) = bits.checked_sub(1) {
            self.bit(context::NEGATIVE + usize::from(other), value < 0);
            self.raw(size & ((1 << below) - 1), below);
        }
        bits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_are_logarithms() {
        for chance in 1..=4096u64 {
            let log = -(chance as f64 / 4096.0).log2() * 65536.0;
            assert!((cost(chance) as f64 - log).abs() < 2.0, "{chance}: {} {log}", cost(chance));
        }
    }
}
