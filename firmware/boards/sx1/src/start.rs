//! Start and faults. Interrupts stay off.
// Neither the first instructions nor those of a fault can be Rust: there is no stack.
#![allow(unsafe_code)]

use board_common::{Code, exit};
use core::panic::PanicInfo;

core::arch::global_asm!(
    ".arm",
    ".section .text.start, \"ax\"",
    ".global _start",
    "_start:",
    "ldr sp, =_stack_top",
    "bl board_start",
    "_fault:",
    // Each processor mode has its own stack pointer.
    "ldr sp, =_stack_top",
    "bl board_fault",
    ".pool",
    ".section .vectors, \"ax\"",
    // Reset, undefined instruction, supervisor call, the two aborts, one that is reserved, and the two interrupts.
    ".rept 8",
    "ldr pc, [pc, #24]",
    ".endr",
    ".word _start",
    ".rept 7",
    ".word _fault",
    ".endr",
);

// Safety: no other symbol has this name.
#[unsafe(no_mangle)]
extern "C" fn board_start() -> ! {
    crate::main()
}

// Safety: as above.
#[unsafe(no_mangle)]
extern "C" fn board_fault() -> ! {
    exit(Code::Fault)
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    crate::log::until_panic();
    // The place without the message, which would link the library's formatting.
    if let Some(place) = info.location() {
        defmt::error!("panic in {}, line {}", place.file(), place.line());
    }
    exit(Code::Panic)
}
