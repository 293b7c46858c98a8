//! The serial line's receive interrupt.
#![allow(unsafe_code)]

use board_common::uart_rx;
use cortex_m::peripheral::NVIC;
use stm32f4xx_hal::interrupt;
use stm32f4xx_hal::pac::{Interrupt, USART1};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::serial::{Event, Serial};

/// Enables the interrupt.
pub fn listen(mut serial: Serial<USART1>) -> Serial<USART1> {
    serial.listen(Event::RxNotEmpty);
    // Safety: no critical section relies on this interrupt's mask.
    unsafe { NVIC::unmask(Interrupt::USART1) };
    serial
}

#[interrupt]
fn USART1() {
    // Safety: nothing else reads these registers.
    let uart = unsafe { &*USART1::PTR };
    // Reading both registers clears the status: a byte was received, or one was lost. Noise on the line, or a line that is low, has a framing
    // error.
    let status = uart.sr().read();
    let byte = uart.dr().read().dr().bits() as u8;
    if status.rxne().bit_is_set() && status.fe().bit_is_clear() {
        uart_rx::push(byte);
    }
}
