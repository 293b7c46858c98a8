//! The registers that the program uses, at their addresses (OMAP310 Technical Reference Manual).
#![allow(unsafe_code)]

use board_common::Register;

/// Names a register by its address.
const fn at<T: Copy>(address: usize) -> Register<T> {
    // Safety: every address below is a register of the machine that this program is linked for, of the width that it is named with,
    // aligned to it.
    unsafe { Register::at(address) }
}

/// The display's controller.
pub mod lcd {
    use super::{Register, at};
    pub const CONTROL: Register = at(0xfffe_c000);
    pub const TIMING_0: Register = at(0xfffe_c004);
    pub const TIMING_1: Register = at(0xfffe_c008);
    pub const TIMING_2: Register = at(0xfffe_c00c);
}

/// The display's DMA channel. Addresses are split into halves of 16 bits.
pub mod lcd_dma {
    use super::{Register, at};
    pub const CONTROL: Register<u16> = at(0xfffe_db00);
    pub const TOP_LOW: Register<u16> = at(0xfffe_db02);
    pub const TOP_HIGH: Register<u16> = at(0xfffe_db04);
    pub const BOTTOM_LOW: Register<u16> = at(0xfffe_db06);
    pub const BOTTOM_HIGH: Register<u16> = at(0xfffe_db08);
}

/// Serial line 1 (16550).
pub mod uart1 {
    use super::{Register, at};
    pub const DATA: Register<u8> = at(0xfffb_0000);
    pub const LINE_STATUS: Register<u8> = at(0xfffb_0014);
}

/// Timer 1: counts down, at half of 12 MHz.
pub mod timer1 {
    use super::{Register, at};
    pub const CONTROL: Register = at(0xfffe_c500);
    pub const LOAD: Register = at(0xfffe_c504);
    pub const READ: Register = at(0xfffe_c508);
}
