//! Faults, and interrupts that nothing asked for: they end the emulator with a code that says what, or else are panics.
#![allow(unsafe_code)]

#[cfg(feature = "emulated-cortex-m")]
use crate::end::{Code, exit};
use cortex_m_rt::exception;

// Not Rust: the fault may be that of a stack that ran out, so that there is none until it starts anew.
core::arch::global_asm!(
    ".section .HardFault.user, \"ax\"",
    ".global HardFault",
    ".type HardFault, %function",
    ".thumb_func",
    "HardFault:",
    "ldr r0, =_stack_start",
    "mov sp, r0",
    "bl board_fault",
    ".pool"
);

// Safety: nothing else is named so.
#[unsafe(no_mangle)]
extern "C" fn board_fault() -> ! {
    #[cfg(feature = "emulated-cortex-m")]
    exit(Code::Fault);
    #[cfg(not(feature = "emulated-cortex-m"))]
    panic!("a fault of the processor: a bad access, or the stack ran out")
}

// The attribute declares the handler unsafe: an interrupt can strike anywhere. It touches nothing but the call.
#[exception]
unsafe fn DefaultHandler(_number: i16) {
    #[cfg(feature = "emulated-cortex-m")]
    exit(Code::Interrupt);
    #[cfg(not(feature = "emulated-cortex-m"))]
    panic!("interrupt {_number}, which nothing asked for")
}
