//! What came over the line, heard by interrupt.
#![allow(unsafe_code)]

use board_common::Inbox;
use cortex_m::peripheral::NVIC;
use rp2040_hal::pac::{Interrupt, UART0, interrupt};
use rp2040_hal::uart::{Enabled, UartPeripheral, ValidUartPinout};

static RECEIVED: Inbox = Inbox::new();

/// Starts listening.
pub fn listen<P: ValidUartPinout<UART0>>(line: &mut UartPeripheral<Enabled, UART0, P>) {
    line.enable_rx_interrupt();
    // Safety: no critical section is built on this interrupt's being masked.
    unsafe { NVIC::unmask(Interrupt::UART0_IRQ) };
}

/// The next byte, if there is one.
pub fn take() -> Option<u8> {
    RECEIVED.take()
}

#[interrupt]
fn UART0_IRQ() {
    // Safety: nothing else reads the line.
    let line = unsafe { &*UART0::PTR };
    while line.uartfr().read().rxfe().bit_is_clear() {
        RECEIVED.put(line.uartdr().read().data().bits());
    }
}
