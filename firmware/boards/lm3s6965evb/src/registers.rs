//! The registers that the program uses, at their addresses (LM3S6965 data sheet).
#![allow(unsafe_code)]

use core::ptr;

/// A 32-bit register.
#[derive(Clone, Copy)]
pub struct Register(usize);

impl Register {
    pub fn read(self) -> u32 {
        // Safety: every address below is a register of the machine that this program is linked for, aligned to 4 bytes.
        unsafe { ptr::read_volatile(ptr::with_exposed_provenance(self.0)) }
    }

    pub fn write(self, value: u32) {
        // Safety: as above.
        unsafe { ptr::write_volatile(ptr::with_exposed_provenance_mut(self.0), value) }
    }
}

/// Synchronous serial port 0 (PL022): the display.
pub mod ssi0 {
    use super::Register;
    pub const CR0: Register = Register(0x4000_8000);
    pub const CR1: Register = Register(0x4000_8004);
    pub const DR: Register = Register(0x4000_8008);
    pub const SR: Register = Register(0x4000_800c);
    pub const CPSR: Register = Register(0x4000_8010);
}

/// Port C; pin 7 tells the display commands from data.
pub mod gpio_c {
    use super::Register;
    /// Data of pin 7 alone: the address masks the others.
    pub const PIN_7: Register = Register(0x4000_6200);
    pub const DIR: Register = Register(0x4000_6400);
    pub const DEN: Register = Register(0x4000_651c);
}

/// Port E; pins 0 to 3 are up, down, left and right.
pub mod gpio_e {
    use super::Register;
    pub const PINS_0_TO_3: Register = Register(0x4002_403c);
    pub const DEN: Register = Register(0x4002_451c);
}

/// Port F; pin 1 is select.
pub mod gpio_f {
    use super::Register;
    pub const PIN_1: Register = Register(0x4002_5008);
    pub const DEN: Register = Register(0x4002_551c);
}

/// Serial line 0 (PL011).
pub mod uart0 {
    use super::Register;
    pub const DR: Register = Register(0x4000_c000);
    pub const FR: Register = Register(0x4000_c018);
}

/// System control.
pub mod system {
    use super::Register;
    pub const RCGC1: Register = Register(0x400f_e104);
    pub const RCGC2: Register = Register(0x400f_e108);
}
