//! A guard at the stack's end, where the processor has a memory protection unit or a limit of the stack.
#![allow(unsafe_code)]

/// Guards the end of the stack: an overflow is a fault instead of corrupted data.
pub fn guard_stack() {
    unsafe extern "C" {
        static mut __sheap: u8;
    }
    guard((&raw const __sheap).addr() as u32);
}

/// By the stack's limit, which the processor compares with its stack pointer.
#[cfg(armv8m)]
fn guard(end_of_data: u32) {
    // Safety: the stack pointer is above the limit, or the next push is the fault that is asked for.
    unsafe { cortex_m::register::msplim::write(end_of_data.next_multiple_of(8)) };
}

/// By the memory protection unit.
#[cfg(not(armv8m))]
fn guard(end_of_data: u32) {
    /// The guarded region between data and stack has 2^12 bytes.
    const GUARD_BITS: u32 = 12;
    let start = end_of_data.next_multiple_of(1 << GUARD_BITS);
    // Safety: these registers are the unit's own. The region holds no data, and all other memory keeps its access rights (PRIVDEFENA).
    unsafe {
        let unit = &*cortex_m::peripheral::MPU::PTR;
        unit.rnr.write(0);
        unit.rbar.write(start);
        // No access, no execution, enabled.
        unit.rasr.write(1 << 28 | (GUARD_BITS - 1) << 1 | 1);
        unit.ctrl.write(1 << 2 | 1);
    }
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}
