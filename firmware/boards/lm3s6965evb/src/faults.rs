//! Whatever goes wrong ends the emulator with a code that says what.
#![allow(unsafe_code)]

use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};
use cortex_m::peripheral::MPU;
use cortex_m_rt::{ExceptionFrame, exception};

/// Exit codes of the emulator.
#[derive(Clone, Copy)]
pub enum Code {
    Done = 0,
    BadClip = 2,
    /// As Rust programs do.
    Panic = 101,
    /// A fault of the processor: a bad access, or the stack ran into the data.
    Fault = 102,
    /// An interrupt that nothing asked for.
    Interrupt = 103,
}

/// Ends the emulator.
pub fn exit(code: Code) -> ! {
    semihosting::process::exit(code as i32)
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    static PANICKED: AtomicBool = AtomicBool::new(false);
    // A panic of the log itself would come round for ever.
    if !PANICKED.load(Ordering::Relaxed) {
        PANICKED.store(true, Ordering::Relaxed);
        defmt::error!("{}", defmt::Display2Format(info));
    }
    exit(Code::Panic)
}

#[exception]
unsafe fn HardFault(_frame: &ExceptionFrame) -> ! {
    exit(Code::Fault)
}

#[exception]
unsafe fn DefaultHandler(_number: i16) {
    exit(Code::Interrupt)
}

/// Size of the stretch between data and stack that faults when touched: 2^12 bytes.
const GUARD_BITS: u32 = 12;

/// Guards the end of the stack by the memory protection unit: growing into the data is a fault instead of a riddle.
pub fn guard_stack() {
    unsafe extern "C" {
        static mut __sheap: u8;
    }
    let end_of_data = (&raw const __sheap).addr() as u32;
    let start = end_of_data.next_multiple_of(1 << GUARD_BITS);
    // Safety: the addresses are the unit's; the region holds nothing, and all other memory stays as it was (PRIVDEFENA).
    unsafe {
        let unit = &*MPU::PTR;
        unit.rnr.write(0);
        unit.rbar.write(start);
        // No access, no execution, enabled.
        unit.rasr.write(1 << 28 | (GUARD_BITS - 1) << 1 | 1);
        unit.ctrl.write(1 << 2 | 1);
    }
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}
