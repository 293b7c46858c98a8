//! Faults and unhandled interrupts. They end the emulator with an exit code of their own; on other boards they panic.
#![allow(unsafe_code)]

#[cfg(feature = "emulated-cortex-m")]
use crate::exit::{Code, exit};
use cortex_m_rt::exception;

// Not Rust: after a stack overflow there is no stack before the pointer is set back.
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

// Safety: no other symbol has this name.
#[unsafe(no_mangle)]
extern "C" fn board_fault() -> ! {
    #[cfg(feature = "emulated-cortex-m")]
    exit(Code::Fault);
    #[cfg(not(feature = "emulated-cortex-m"))]
    panic!("processor fault: an invalid access, or a stack overflow")
}

// The attribute demands an unsafe function, since an interrupt can occur anywhere. This one touches no data.
#[exception]
unsafe fn DefaultHandler(_number: i16) {
    #[cfg(feature = "emulated-cortex-m")]
    exit(Code::Interrupt);
    #[cfg(not(feature = "emulated-cortex-m"))]
    panic!("interrupt {_number} has no handler")
}
