//! Instructions that do nothing, between which an emulator counts instructions. Memory counts as touched, so that stores stay on
//! their side of them.
#![allow(unsafe_code)]

/// Begins a stretch.
#[inline(always)]
pub fn start() {
    // Safety: moves a register to itself.
    unsafe { core::arch::asm!("mov r9, r9", options(nostack, preserves_flags)) }
}

/// Ends it.
#[inline(always)]
pub fn stop() {
    // Safety: as above.
    unsafe { core::arch::asm!("mov r10, r10", options(nostack, preserves_flags)) }
}
