//! Start where no runtime crate is needed: the emulator enters at `_start` with everything in place but a stack.
//! A fault runs into the harness's time limit.
// The first instructions cannot be Rust: there is no stack yet.
#![allow(unsafe_code)]

#[cfg(target_arch = "arm")]
core::arch::global_asm!(
    ".section .text.start, \"ax\"",
    ".global _start",
    ".arm",
    "_start:",
    "ldr sp, =_stack_top",
    "bl start",
    ".pool"
);

#[cfg(target_arch = "riscv32")]
core::arch::global_asm!(".section .text.start, \"ax\"", ".global _start", "_start:", "la sp, _stack_top", "call start");

// SAFETY: nothing else is named so.
#[unsafe(no_mangle)]
extern "C" fn start() -> ! {
    crate::semihosted::main()
}
