//! Traps end the emulator: no interrupt is enabled, so each is a fault. The stack's end is guarded.
#![allow(unsafe_code)]

use board_common::{Code, exit};
use riscv::register::{Permission, Range, pmpaddr0, pmpcfg0};

// Not Rust: the fault may be that of a stack that ran out, so that there is none until it starts anew. riscv-rt has the processor
// trap to this name.
core::arch::global_asm!(
    ".section .trap.start, \"ax\"",
    ".global _start_trap",
    ".balign 4",
    "_start_trap:",
    "la sp, _stack_start",
    "call board_fault"
);

// Safety: nothing else is named so.
#[unsafe(no_mangle)]
extern "C" fn board_fault() -> ! {
    exit(Code::Fault)
}

/// Forbids the memory below the stack, by the processor's memory protection: growing into it is a fault instead of a riddle.
pub fn guard_stack() {
    unsafe extern "C" {
        static _guard_start: u8;
        static _guard_end: u8;
    }
    let (start, end) = ((&raw const _guard_start).addr(), (&raw const _guard_end).addr());
    // Safety: nothing lies there. A region of 2^n bytes is told as its address with n - 3 ones below it, in words of four bytes.
    unsafe {
        pmpaddr0::write(start >> 2 | ((end - start) / 8 - 1));
        pmpcfg0::set_pmp(0, Range::NAPOT, Permission::NONE, true);
    }
}
