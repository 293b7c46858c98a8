//! Whatever goes wrong ends the emulator with a code that says what.
#![allow(unsafe_code)]

use crate::end::{Code, exit};
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};
use cortex_m_rt::exception;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    // A panic of the log itself would come round for ever.
    if !PANICKED.load(Ordering::Relaxed) {
        PANICKED.store(true, Ordering::Relaxed);
        // Where, without its words: those would bring in the library's formatting.
        if let Some(place) = info.location() {
            defmt::error!("panic in {}, line {}", place.file(), place.line());
        }
    }
    exit(Code::Panic)
}

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
    exit(Code::Fault)
}

// The attribute declares the handler unsafe: an interrupt can strike anywhere. It touches nothing but the exit call.
#[exception]
unsafe fn DefaultHandler(_number: i16) {
    exit(Code::Interrupt)
}
