//! What came over the line, heard by interrupt: the serial port holds six bytes, and a picture takes longer than those.
#![allow(unsafe_code)]

use crate::registers::{nvic, uart};
use board_common::Inbox;

/// The serial port's interrupt, and the bit of a byte received.
const UART: u32 = 2;
const RECEIVED_BIT: u32 = 2;

static RECEIVED: Inbox = Inbox::new();

/// Starts listening.
pub fn start() {
    uart::INTERRUPTS.write(1 << RECEIVED_BIT);
    nvic::ENABLE.write(1 << UART);
}

/// The next byte, if there is one.
pub fn take() -> Option<u8> {
    RECEIVED.take()
}

extern "C" fn hear() {
    while uart::RECEIVED.read() != 0 {
        // Before the byte is fetched: fetching it lets the next one in.
        uart::RECEIVED.write(0);
        RECEIVED.put(uart::RXD.read() as u8);
    }
}

/// A place of the vector table.
#[repr(C)]
pub union Vector {
    handler: extern "C" fn(),
    none: usize,
}

// Safety: the linker script places what is in this section, and of this name, behind the processor's exceptions: number 2 is the
// serial port's (nRF51 Series Reference Manual). No other interrupt is enabled.
#[unsafe(link_section = ".vector_table.interrupts")]
#[unsafe(no_mangle)]
pub static __INTERRUPTS: [Vector; 3] = [Vector { none: 0 }, Vector { none: 0 }, Vector { handler: hear }];
