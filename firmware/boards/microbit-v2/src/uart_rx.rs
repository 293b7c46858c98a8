//! The serial line's receive interrupt: the port writes one byte at a time to memory.
#![allow(unsafe_code)]

use crate::nrf_hal::pac::{NVIC, UARTE0, interrupt};
use crate::nrf_hal::uarte::UarteRx;
use board_common::uart_rx;
use core::cell::RefCell;
use cortex_m::interrupt::Mutex;
use embedded_hal_02::serial::Read;

static PORT: Mutex<RefCell<Option<UarteRx<UARTE0>>>> = Mutex::new(RefCell::new(None));

/// Enables the interrupt of a port that waits for its first byte.
pub fn listen(port: UarteRx<UARTE0>) {
    cortex_m::interrupt::free(|section| PORT.borrow(section).replace(Some(port)));
    // Safety: nothing else writes this register, and no critical section relies on this interrupt's mask.
    unsafe {
        (*UARTE0::ptr()).intenset.write(|w| w.endrx().set_bit());
        NVIC::unmask(interrupt::UARTE0_UART0);
    }
}

#[interrupt]
fn UARTE0_UART0() {
    cortex_m::interrupt::free(|section| {
        let Ok(mut port) = PORT.borrow(section).try_borrow_mut() else { return };
        // The first call takes the byte, or an error. The second one asks for the next byte.
        for _ in 0..2 {
            if let Some(Ok(byte)) = port.as_mut().map(Read::read)
                && crate::serial::is_whole()
            {
                uart_rx::push(byte);
            }
        }
    });
}
