//! Regions of known length between the harness's markers: 2 instructions a turn, for 1000, 10 and 250 turns, twice.
#![no_std]
#![no_main]
// The loop must be these very instructions and no others.
#![allow(unsafe_code)]

use core::arch::asm;
use testsuite as _;

#[cortex_m_rt::entry]
fn main() -> ! {
    for turns in [1000, 10, 250, 1000, 10, 250] {
        counted(turns);
    }
    semihosting::process::exit(0)
}

fn counted(turns: u32) {
    // SAFETY: changes nothing but the one register, which is declared. `turns` is not 0.
    unsafe {
        asm!("mov r9, r9", "2:", "subs {turns}, {turns}, #1", "bne 2b", "mov r10, r10", turns = inout(reg) turns => _);
    }
}
