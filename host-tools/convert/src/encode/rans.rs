//! The rANS encoder of FORMAT.md 5, for clips and for the payloads of packets.
//!
//! rANS is last in, first out: an encoder collects its digits in the order in which a decoder reads them, then codes them from the last to the first.

use pantin::codec::entropy::{LOW, SCALE_BITS, STATE_BYTES};

/// One field of the coder's state.
#[derive(Clone, Copy, Debug)]
pub enum Digit {
    /// A symbol: where its interval of 4096 starts, and the interval's size.
    Symbol {
        /// 0 to 4095.
        start: u32,
        /// 1 to 4096 - `start`.
        size: u32,
    },
    /// Bits that are all equally probable.
    Bits {
        /// Less than 2^`count`.
        value: u32,
        /// 0 to 8.
        count: u32,
    },
}

/// Returns the bytes from which a decoder reads `digits` in order, and after them the state `initial`, which lies in `LOW..LOW << 8`.
pub fn encode(digits: &[Digit], initial: u32) -> Vec<u8> {
    let mut state = initial;
    let mut bytes = vec![];
    let mut shrink = |state: &mut u32, limit: u32| {
        while *state >= limit {
            bytes.push(*state as u8);
            *state >>= 8;
        }
    };
    for digit in digits.iter().rev() {
        match *digit {
            Digit::Symbol { start, size } => {
                shrink(&mut state, (LOW >> SCALE_BITS << 8) * size);
                state = (state / size) << SCALE_BITS | (state % size + start);
            }
            Digit::Bits { value, count } => {
                shrink(&mut state, (LOW << 8) >> count);
                state = state << count | value;
            }
        }
    }
    bytes.extend(state.to_le_bytes().iter().take(STATE_BYTES));
    bytes.reverse();
    bytes
}
