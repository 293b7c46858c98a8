//! The serial line's receive interrupt.
#![allow(unsafe_code)]

use crate::rp_hal::pac::{Interrupt, UART0, interrupt};
use crate::rp_hal::uart::{Enabled, UartPeripheral, ValidUartPinout};
use board_common::uart_rx;
use cortex_m::peripheral::NVIC;

/// Enables the interrupt.
pub fn listen<P: ValidUartPinout<UART0>>(mut serial: UartPeripheral<Enabled, UART0, P>) -> UartPeripheral<Enabled, UART0, P> {
    serial.enable_rx_interrupt();
    // Safety: no critical section relies on this interrupt's mask.
    unsafe { NVIC::unmask(Interrupt::UART0_IRQ) };
    serial
}

#[interrupt]
fn UART0_IRQ() {
    // Safety: nothing else reads the data register.
    let uart = unsafe { &*UART0::PTR };
    while uart.uartfr().read().rxfe().bit_is_clear() {
        let received = uart.uartdr().read();
        // Noise on the line, or a line that is low, has a framing error.
        if received.fe().bit_is_clear() && received.be().bit_is_clear() {
            uart_rx::push(received.data().bits());
        }
    }
}
