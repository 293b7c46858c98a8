//! A word in RAM that a reset of the processor does not clear.
#![allow(unsafe_code)]

use core::mem::MaybeUninit;
use portable_atomic::{AtomicU32, Ordering};

// Safety: the section holds no values that the start of the program would have to write.
#[unsafe(link_section = ".uninit.kept")]
static KEPT: MaybeUninit<AtomicU32> = MaybeUninit::uninit();

/// Writes the word.
pub fn keep(word: u32) {
    // Safety: any bits are a valid number.
    unsafe { KEPT.assume_init_ref() }.store(word, Ordering::Relaxed);
}

/// Reads the word: what was kept before the last reset, or anything after the power was off.
pub fn kept() -> u32 {
    // Safety: as above.
    unsafe { KEPT.assume_init_ref() }.load(Ordering::Relaxed)
}
