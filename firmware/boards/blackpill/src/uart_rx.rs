//! The serial line's receive interrupt.
#![allow(unsafe_code)]

use crate::board::{PORT_INTERRUPT, Port};
use board_common::uart_rx;
use cortex_m::peripheral::NVIC;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::serial::{Event, Serial};

/// Enables the interrupt, whose handler calls [`receive`].
pub fn listen(mut serial: Serial<Port>) -> Serial<Port> {
    serial.listen(Event::RxNotEmpty);
    // Safety: no critical section relies on this interrupt's mask.
    unsafe { NVIC::unmask(PORT_INTERRUPT) };
    serial
}

/// Takes a byte from the port.
pub fn receive() {
    // Safety: nothing else reads these registers.
    let uart = unsafe { &*Port::PTR };
    // Reading both registers clears the status: a byte was received, or one was lost. Noise on the line, or a line that is low, has a framing
    // error.
    let status = uart.sr().read();
    let byte = uart.dr().read().dr().bits() as u8;
    if status.rxne().bit_is_set() && status.fe().bit_is_clear() {
        uart_rx::push(byte);
    }
}
