//! What came over the line, heard by interrupt.
#![allow(unsafe_code)]

use board_common::Inbox;
use cortex_m::peripheral::NVIC;
use stm32f4xx_hal::interrupt;
use stm32f4xx_hal::pac::{Interrupt, USART1};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::serial::{Event, Serial};

static RECEIVED: Inbox = Inbox::new();

/// Starts listening.
pub fn listen(line: &mut Serial<USART1>) {
    line.listen(Event::RxNotEmpty);
    // Safety: no critical section is built on this interrupt's being masked.
    unsafe { NVIC::unmask(Interrupt::USART1) };
}

/// The next byte, if there is one.
pub fn take() -> Option<u8> {
    RECEIVED.take()
}

#[interrupt]
fn USART1() {
    // Safety: nothing else reads the line.
    let line = unsafe { &*USART1::PTR };
    // Reading both clears what the status says: that a byte is there, or that one was lost.
    let status = line.sr().read();
    let byte = line.dr().read().dr().bits() as u8;
    if status.rxne().bit_is_set() {
        RECEIVED.put(byte);
    }
}
