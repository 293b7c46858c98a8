//! Memory for keys: words in the states behind those of the moving channels, from the last state on towards the first.
//!
//! A player lends states alone, so that a room holds a key clip as it holds any other. A state is five words.

use super::layout::STATE_WORDS;
use crate::channel::ChannelState;

/// The state of a word, counted from the last, and which of its words it is.
fn place(at: usize) -> (usize, usize) {
    // Words are numbered in 16 bits: this is at / 5, without a division.
    let state = ((at as u32 * 52_429) >> 18) as usize;
    (state, at - STATE_WORDS * state)
}

/// A word, 0 where there is none.
#[inline(never)]
pub(super) fn get(states: &[ChannelState], at: usize) -> i32 {
    let (back, which) = place(at);
    let Some(state) = states.get(states.len().wrapping_sub(1 + back)) else { return 0 };
    match which {
        0 => state.v,
        1 => state.w,
        2 => state.k,
        3 => i32::from(state.slot) | i32::from(state.due) << 16 | i32::from(state.mode) << 24,
        _ => i32::from(state.step) | i32::from(state.prev_sign as u8) << 8 | i32::from(state.next) << 16,
    }
}

/// Sets a word.
#[inline(never)]
pub(super) fn set(states: &mut [ChannelState], at: usize, word: i32) {
    let (back, which) = place(at);
    let index = states.len().wrapping_sub(1 + back);
    let Some(state) = states.get_mut(index) else { return };
    match which {
        0 => state.v = word,
        1 => state.w = word,
        2 => state.k = word,
        3 => (state.slot, state.due, state.mode) = (word as u16, (word >> 16) as u8, (word >> 24) as u8),
        _ => (state.step, state.prev_sign, state.next) = (word as u8, (word >> 8) as i8, (word >> 16) as u16),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_kept() {
        let mut states = [ChannelState::NEW; 3];
        let word = |at: usize| (at as i32).wrapping_mul(0x9e37_79b9_u32 as i32);
        (0..15).for_each(|at| set(&mut states, at, word(at)));
        assert!((0..15).all(|at| get(&states, at) == word(at)));
        set(&mut states, 15, 1);
        assert_eq!(get(&states, 15), 0);
        assert!((0..0x10000).all(|at| place(at) == (at / 5, at % 5)));
    }
}
