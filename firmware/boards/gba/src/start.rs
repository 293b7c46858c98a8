//! The cartridge's header, start, and the interrupt handler.
// The header is data at a fixed place, and neither the first instructions nor an interrupt handler can be Rust: there is no stack, and
// registers are kept by the BIOS.
#![allow(unsafe_code)]

use portable_atomic::{AtomicU32, Ordering};

core::arch::global_asm!(
    ".arm",
    ".section .text.start, \"ax\"",
    ".global _start",
    "_start:",
    "b 1f",
    // 156 bytes that a real console's BIOS compares with a bitmap of its own; `gbafix` puts them here.
    ".space 156",
    ".ascii \"PANTIN\"",
    ".space 6",
    // Game and maker code.
    ".ascii \"APTE00\"",
    // Fixed value; unit code and device type 0; reserved; version 0.
    ".byte 0x96, 0, 0",
    ".space 7",
    ".byte 0",
    // Minus the sum of the bytes from the title on, minus 0x19.
    ".byte 0xfd",
    ".space 2",
    "1:",
    // Interrupts have a stack of their own, at which the BIOS lets it begin, and supervisor calls too.
    "ldr sp, =_stack_top",
    "ldr r0, =_fast_load",
    "ldr r1, =_fast_start",
    "ldr r2, =_fast_end",
    "2:",
    "cmp r1, r2",
    "ldrlo r3, [r0], #4",
    "strlo r3, [r1], #4",
    "blo 2b",
    "ldr r2, =_zero_end",
    "mov r3, #0",
    "3:",
    "cmp r1, r2",
    "strlo r3, [r1], #4",
    "blo 3b",
    // The BIOS calls the handler that this word names.
    "ldr r0, =0x03007ffc",
    "ldr r1, =board_interrupt",
    "str r1, [r0]",
    "ldr r0, =board_start",
    "mov lr, pc",
    "bx r0",
    "4: b 4b",
    ".pool",
    // The handler for the one interrupt that is enabled. The BIOS has saved r0 to r3, r12 and lr.
    ".section .fast.interrupt, \"ax\"",
    "board_interrupt:",
    "mov r0, #0x04000000",
    "mov r1, #1",
    // The BIOS waits for this copy of the request.
    "ldrh r2, [r0, #-8]",
    "orr r2, r2, r1",
    "strh r2, [r0, #-8]",
    "add r0, r0, #0x200",
    "strh r1, [r0, #2]",
    "ldr r0, =BLANKS",
    "ldr r2, [r0]",
    "add r2, r2, #1",
    "str r2, [r0]",
    "bx lr",
    ".pool",
    // Signed and unsigned division: a figure has hundreds a picture, and the compiler's own takes twice as long. The quotient's bits from
    // the highest that can be 1 on, without a branch.
    ".section .fast.divide, \"ax\"",
    ".global __aeabi_idiv, __aeabi_uidiv",
    "__aeabi_uidiv:",
    "mov r12, #0",
    "b 5f",
    "__aeabi_idiv:",
    "eor r12, r0, r1",
    "cmp r0, #0",
    "rsblt r0, r0, #0",
    "cmp r1, #0",
    "rsblt r1, r1, #0",
    "5:",
    "mov r2, #31",
    "mov r3, r1",
    ".irp by, 16, 8, 4, 2, 1",
    "cmp r3, r0, lsr #\\by",
    "movls r3, r3, lsl #\\by",
    "subls r2, r2, #\\by",
    ".endr",
    "add r2, r2, r2, lsl #1",
    "mov r3, #0",
    // It jumps over three instructions for each bit that is left out; `pc` is two instructions ahead.
    "add pc, pc, r2, lsl #2",
    "nop",
    ".set bit, 31",
    ".rept 32",
    "cmp r0, r1, lsl #bit",
    "adc r3, r3, r3",
    "subcs r0, r0, r1, lsl #bit",
    ".set bit, bit - 1",
    ".endr",
    "cmp r12, #0",
    "rsblt r0, r3, #0",
    "movge r0, r3",
    "bx lr",
    // Waits for the interrupt: returns at once if it came since the last call.
    ".global board_sleep",
    "board_sleep:",
    "mov r0, #0",
    "mov r1, #1",
    "swi 0x040000",
    "bx lr",
    ".pool",
);

/// Vertical blanks since the start. The interrupt handler counts them.
#[unsafe(no_mangle)]
static BLANKS: AtomicU32 = AtomicU32::new(0);

/// Returns the number of vertical blanks since the start.
#[inline(always)]
pub fn blanks() -> u32 {
    BLANKS.load(Ordering::Relaxed)
}

/// Sleeps until the next vertical blank; returns at once if one has begun since the last call.
pub fn sleep() {
    unsafe extern "C" {
        safe fn board_sleep();
    }
    board_sleep();
}

// Safety: no other symbol has this name.
#[unsafe(no_mangle)]
extern "C" fn board_start() -> ! {
    crate::main()
}
