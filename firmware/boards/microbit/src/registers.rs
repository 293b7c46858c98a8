//! The registers that the program uses, at their addresses (nRF51 Series Reference Manual).
#![allow(unsafe_code)]

use board_common::Register;

/// Names a register by its address.
const fn at(address: usize) -> Register {
    // Safety: every address below is a register of the machine that this program is linked for, aligned to 4 bytes.
    unsafe { Register::at(address) }
}

/// The serial line.
pub mod uart {
    use super::{Register, at};
    pub const START_RECEIVER: Register = at(0x4000_2000);
    pub const START_TRANSMITTER: Register = at(0x4000_2008);
    pub const RECEIVED: Register = at(0x4000_2108);
    pub const TRANSMITTED: Register = at(0x4000_211c);
    #[cfg(feature = "update")]
    pub const INTERRUPTS: Register = at(0x4000_2304);
    pub const ENABLE: Register = at(0x4000_2500);
    pub const RXD: Register = at(0x4000_2518);
    pub const TXD: Register = at(0x4000_251c);
}

/// Timer 0, at 16 MHz.
pub mod timer0 {
    use super::{Register, at};
    pub const START: Register = at(0x4000_8000);
    pub const CAPTURE_0: Register = at(0x4000_8040);
    pub const BIT_MODE: Register = at(0x4000_8508);
    pub const PRESCALER: Register = at(0x4000_8510);
    pub const CC_0: Register = at(0x4000_8540);
}

/// The flash's controller.
pub mod nvmc {
    use super::{Register, at};
    pub const READY: Register = at(0x4001_e400);
    pub const CONFIG: Register = at(0x4001_e504);
    pub const ERASE_PAGE: Register = at(0x4001_e508);
}

/// The processor's interrupts.
#[cfg(feature = "update")]
pub mod nvic {
    use super::{Register, at};
    pub const ENABLE: Register = at(0xe000_e100);
}
