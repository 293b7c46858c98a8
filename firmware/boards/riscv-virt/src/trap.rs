//! Traps end the emulator: no interrupt is enabled, so each is a fault. The stack's end is guarded.
#![allow(unsafe_code)]

use board_common::{Code, exit};
use riscv::register::{Permission, Range, pmpaddr0, pmpcfg0};

// Not Rust: after a stack overflow there is no stack before the pointer is set back. riscv-rt makes the processor
// trap to this name.
core::arch::global_asm!(
    ".section .trap.start, \"ax\"",
    ".global _start_trap",
    ".balign 4",
    "_start_trap:",
    "la sp, _stack_start",
    "call board_fault"
);

// Safety: no other symbol has this name.
#[unsafe(no_mangle)]
extern "C" fn board_fault() -> ! {
    exit(Code::Fault)
}

/// Protects the memory below the stack with the processor's memory protection: a stack overflow is a fault instead of corrupted data.
pub fn guard_stack() {
    unsafe extern "C" {
        static _guard_start: u8;
        static _guard_end: u8;
    }
    let (start, end) = ((&raw const _guard_start).addr(), (&raw const _guard_end).addr());
    // Safety: the region holds no data. A region of 2^n bytes is encoded as its address with n - 3 ones below it, in words of four bytes.
    unsafe {
        pmpaddr0::write(start >> 2 | ((end - start) / 8 - 1));
        pmpcfg0::set_pmp(0, Range::NAPOT, Permission::NONE, true);
    }
}
