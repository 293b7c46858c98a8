//! What came over the line, heard by interrupt: the serial port holds six bytes, and a picture takes longer than those.
#![allow(unsafe_code)]

use crate::registers::{nvic, uart};
use core::cell::RefCell;
use critical_section::Mutex;
use heapless::Deque;

/// The serial port's interrupt, and the bit of a byte received.
const UART: u32 = 2;
const RECEIVED_BIT: u32 = 2;

/// More than a packet of an update, of which the next comes only when the one before was answered.
static RECEIVED: Mutex<RefCell<Deque<u8, 512>>> = Mutex::new(RefCell::new(Deque::new()));

/// Starts listening.
pub fn start() {
    uart::INTERRUPTS.write(1 << RECEIVED_BIT);
    nvic::ENABLE.write(1 << UART);
}

/// The next byte, if there is one.
pub fn take() -> Option<u8> {
    critical_section::with(|section| RECEIVED.borrow(section).try_borrow_mut().ok()?.pop_front())
}

extern "C" fn hear() {
    critical_section::with(|section| {
        while uart::RECEIVED.read() != 0 {
            // Before the byte is fetched: fetching it lets the next one in.
            uart::RECEIVED.write(0);
            let byte = uart::RXD.read() as u8;
            if let Ok(mut received) = RECEIVED.borrow(section).try_borrow_mut() {
                // A line that sends more than was asked for loses it, and the packet's CRC tells.
                let _ = received.push_back(byte);
            }
        }
    });
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
