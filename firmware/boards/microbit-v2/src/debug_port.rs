//! The debug port, which the program keeps open.
#![allow(unsafe_code)]

use board_common::Register;
use board_drivers::nrf52::{Registers, open_debug_port};

/// The chip's registers.
struct Chip;

impl Registers for Chip {
    fn read(&mut self, address: usize) -> u32 {
        // Safety: the only caller reads registers of this chip.
        unsafe { Register::at(address) }.read()
    }

    fn write(&mut self, address: usize, value: u32) {
        // Safety: the only caller writes registers of this chip, and a word of the configuration that nothing borrows.
        unsafe { Register::at(address) }.write(value);
    }
}

/// Opens the debug port, now and after the next reset.
///
/// `first_build` is the first of the chip's builds that need it.
pub fn open(first_build: u8) {
    open_debug_port(&mut Chip, first_build);
}
