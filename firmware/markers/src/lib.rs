//! The instructions between which the counting plugin counts; they do nothing, and no compiler emits them. Memory counts as
//! touched, so that stores stay on their side of them.
#![no_std]
#![allow(unsafe_code)]

use core::arch::asm;

/// Counting starts behind this. Measured code and its markers belong in a function that is never inlined: the compiler may
/// move instructions that touch no memory across.
#[inline(always)]
pub fn start() {
    // SAFETY: copies a register to itself, or sets the one that is always zero.
    #[cfg(not(target_arch = "riscv32"))]
    unsafe {
        asm!("mov r9, r9", options(nostack, preserves_flags))
    }
    #[cfg(target_arch = "riscv32")]
    unsafe {
        asm!("slti x0, x0, 0x101", options(nostack, preserves_flags))
    }
}

/// Counting stops before this.
#[inline(always)]
pub fn stop() {
    // SAFETY: copies a register to itself, or sets the one that is always zero.
    #[cfg(not(target_arch = "riscv32"))]
    unsafe {
        asm!("mov r10, r10", options(nostack, preserves_flags))
    }
    #[cfg(target_arch = "riscv32")]
    unsafe {
        asm!("slti x0, x0, 0x102", options(nostack, preserves_flags))
    }
}
