//! A guard at the stack's end, where the processor has a memory protection unit.
#![allow(unsafe_code)]

use cortex_m::peripheral::MPU;

/// The guarded region between data and stack has 2^12 bytes.
const GUARD_BITS: u32 = 12;

/// Guards the end of the stack with the memory protection unit: an overflow is a fault instead of corrupted data.
pub fn guard_stack() {
    unsafe extern "C" {
        static mut __sheap: u8;
    }
    let end_of_data = (&raw const __sheap).addr() as u32;
    let start = end_of_data.next_multiple_of(1 << GUARD_BITS);
    // Safety: these registers are the unit's own. The region holds no data, and all other memory keeps its access rights (PRIVDEFENA).
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
