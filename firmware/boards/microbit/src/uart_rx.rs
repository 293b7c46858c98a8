//! The serial line's receive interrupt. Without it the port holds six bytes, and a picture takes longer than these.
#![allow(unsafe_code)]

use crate::registers::{nvic, uart};
use board_common::uart_rx;

/// The number of the serial port's interrupt, and the bit of the event "byte received".
const UART: u32 = 2;
const RECEIVED_BIT: u32 = 2;

/// Enables the interrupt.
pub fn listen() {
    uart::INTERRUPTS.write(1 << RECEIVED_BIT);
    nvic::ENABLE.write(1 << UART);
}

extern "C" fn on_receive() {
    while let Some(byte) = crate::board::poll() {
        uart_rx::push(byte);
    }
}

/// An entry of the vector table.
#[repr(C)]
pub union Vector {
    handler: extern "C" fn(),
    none: usize,
}

// Safety: the linker script places what is in this section under this name after the processor's exceptions. Number 2 is the
// serial port's (nRF51 Series Reference Manual). No other interrupt is enabled.
#[unsafe(link_section = ".vector_table.interrupts")]
#[unsafe(no_mangle)]
pub static __INTERRUPTS: [Vector; 3] = [Vector { none: 0 }, Vector { none: 0 }, Vector { handler: on_receive }];
