//! What came over the line, heard by interrupt: a byte at a time is brought into memory.
#![allow(unsafe_code)]

use board_common::Inbox;
use core::cell::RefCell;
use cortex_m::interrupt::Mutex;
use embedded_hal_02::serial::Read;
use nrf52833_hal::pac::{NVIC, UARTE0, interrupt};
use nrf52833_hal::uarte::UarteRx;

static RECEIVED: Inbox = Inbox::new();
static LINE: Mutex<RefCell<Option<UarteRx<UARTE0>>>> = Mutex::new(RefCell::new(None));

/// Starts listening.
pub fn listen(mut line: UarteRx<UARTE0>) {
    // Asks for the first byte.
    let _ = line.read();
    cortex_m::interrupt::free(|section| LINE.borrow(section).replace(Some(line)));
    // Safety: nothing else touches that register, and no critical section is built on this interrupt's being masked.
    unsafe {
        (*UARTE0::ptr()).intenset.write(|w| w.endrx().set_bit());
        NVIC::unmask(interrupt::UARTE0_UART0);
    }
}

/// The next byte, if there is one.
pub fn take() -> Option<u8> {
    RECEIVED.take()
}

#[interrupt]
fn UARTE0_UART0() {
    cortex_m::interrupt::free(|section| {
        let Ok(mut line) = LINE.borrow(section).try_borrow_mut() else { return };
        // Takes the byte, or that there was an error, and then asks for the next.
        for _ in 0..2 {
            if let Some(Ok(byte)) = line.as_mut().map(Read::read) {
                RECEIVED.put(byte);
            }
        }
    });
}
