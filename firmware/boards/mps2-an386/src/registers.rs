//! The registers that the program uses, at their addresses (Arm DAI 0386 and 0505, DDI 0479).
#![allow(unsafe_code)]

use board_common::Register;

/// Names a register by its address.
const fn at(address: usize) -> Register {
    // Safety: every address below is a register of the machine that this program is linked for, aligned to 4 bytes.
    unsafe { Register::at(address) }
}

/// Serial line 0 (CMSDK APB UART).
pub mod uart0 {
    use super::{Register, at};
    use crate::UART0;
    pub const DATA: Register = at(UART0);
    pub const STATE: Register = at(UART0 + 4);
    pub const CTRL: Register = at(UART0 + 8);
    pub const BAUDDIV: Register = at(UART0 + 0x10);
}
