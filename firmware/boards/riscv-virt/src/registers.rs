//! The registers that the program uses, at their addresses (QEMU's hw/riscv/virt.c; the RISC-V ACLINT specification; NS16550).
#![allow(unsafe_code)]

use board_common::Register;

/// Names a register by its address.
const fn at<T: Copy>(address: usize) -> Register<T> {
    // Safety: every address below is a register of the machine that this program is linked for, aligned to its width.
    unsafe { Register::at(address) }
}

/// The serial line, an NS16550: registers of a byte.
pub mod uart {
    use super::{Register, at};
    pub const DATA: Register<u8> = at(0x1000_0000);
    pub const LINE_STATUS: Register<u8> = at(0x1000_0005);
}

/// Time, of 10 MHz: its lower half.
pub const MTIME: Register<u32> = at(0x0200_bff8);
