//! A guard at the stack's end, where the processor has a memory protection unit.
#![allow(unsafe_code)]

use cortex_m::peripheral::MPU;

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
