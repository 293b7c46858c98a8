//! The registers that the program uses, at their addresses (LM3S6965 data sheet).
#![allow(unsafe_code)]

use board_common::Register;

/// Names a register by its address.
const fn at(address: usize) -> Register {
    // Safety: every address below is a register of the machine that this program is linked for, aligned to 4 bytes.
    unsafe { Register::at(address) }
}

/// Synchronous serial port 0 (PL022): the display.
pub mod ssi0 {
    use super::{Register, at};
    pub const CR0: Register = at(0x4000_8000);
    pub const CR1: Register = at(0x4000_8004);
    pub const DR: Register = at(0x4000_8008);
    pub const SR: Register = at(0x4000_800c);
    pub const CPSR: Register = at(0x4000_8010);
}

/// Port C; pin 7 is low for the display's commands and high for data.
pub mod gpio_c {
    use super::{Register, at};
    /// Data of pin 7 alone: the address masks the other pins.
    pub const PIN_7: Register = at(0x4000_6200);
    pub const DIR: Register = at(0x4000_6400);
    pub const DEN: Register = at(0x4000_651c);
}

/// Port E; pins 0 to 3 are up, down, left and right.
pub mod gpio_e {
    use super::{Register, at};
    pub const PINS_0_TO_3: Register = at(0x4002_403c);
    pub const DEN: Register = at(0x4002_451c);
}

/// Port F; pin 1 is select.
pub mod gpio_f {
    use super::{Register, at};
    pub const PIN_1: Register = at(0x4002_5008);
    pub const DEN: Register = at(0x4002_551c);
}

/// Serial line 0 (PL011).
pub mod uart0 {
    use super::{Register, at};
    pub const DR: Register = at(0x4000_c000);
    pub const FR: Register = at(0x4000_c018);
    #[cfg(feature = "link")]
    pub const LCRH: Register = at(0x4000_c02c);
}

/// Ethernet controller.
#[cfg(feature = "ethernet")]
pub mod mac {
    use super::{Register, at};
    pub const RCTL: Register = at(0x4004_8008);
    pub const TCTL: Register = at(0x4004_800c);
    pub const DATA: Register = at(0x4004_8010);
    pub const IA0: Register = at(0x4004_8014);
    pub const IA1: Register = at(0x4004_8018);
    pub const NP: Register = at(0x4004_8034);
    pub const TR: Register = at(0x4004_8038);
}

/// System control.
pub mod system {
    use super::{Register, at};
    pub const RCGC1: Register = at(0x400f_e104);
    pub const RCGC2: Register = at(0x400f_e108);
}
