//! Stack use, measured: the free stack is painted, the work runs, and what it has left unpainted is counted.
#![allow(unsafe_code)]

use core::hint::black_box;
use core::ops::Range;

/// Bytes painted: more than anything measured takes.
const DEPTH: usize = 2048;

/// Bytes that the painting function may take for itself, unpainted.
const OWN: usize = 64;

const PAINT: u32 = 0x5a5a_a5a5;

/// Bytes of stack that a call of `work` takes; what takes less than 64 counts as 64. It is called through a pointer, so
/// nothing of it is inlined here.
#[inline(never)]
pub fn used(work: &mut dyn FnMut()) -> usize {
    let painted = paint();
    black_box(work)();
    let mut address = painted.start;
    // SAFETY: aligned, and memory; painted by `paint`.
    while address < painted.end && unsafe { (address as *const u32).read_volatile() } == PAINT {
        address += 4;
    }
    painted.end + OWN - address
}

/// Paints below its own frame, which is where a function called next has its own.
#[inline(never)]
fn paint() -> Range<usize> {
    let mut here = 0_u32;
    let top = black_box(&raw mut here) as usize & !3;
    let painted = top - DEPTH..top - OWN;
    let mut address = painted.start;
    while address < painted.end {
        // SAFETY: aligned, and below this function's frame: nothing lives there, programs that measure leave DEPTH bytes of
        // stack, and no interrupt is on.
        unsafe { (address as *mut u32).write_volatile(PAINT) }
        address += 4;
    }
    painted
}
