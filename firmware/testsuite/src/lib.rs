//! What the programs share: a panic or a fault ends the emulator with a code other than 0.
#![no_std]

pub mod clip;
pub mod paint;

pub use markers;

use core::panic::PanicInfo;

// Linked for what they provide: the critical section, the log's way out.
use cortex_m as _;
use defmt_semihosting as _;

/// Exit code of a panic.
pub const PANIC: i32 = 101;

/// Exit code of a fault.
pub const FAULT: i32 = 102;

#[panic_handler]
fn panic(_info: &PanicInfo) -> ! {
    semihosting::process::exit(PANIC)
}

// The attribute declares the handler unsafe: a fault can strike anywhere. It touches nothing but the exit call.
#[allow(unsafe_code)]
#[cortex_m_rt::exception]
unsafe fn HardFault(_frame: &cortex_m_rt::ExceptionFrame) -> ! {
    semihosting::process::exit(FAULT)
}
