//! The serial line to the board's interface chip, which is a serial port over USB.
#![allow(unsafe_code)]

use crate::nrf_hal::gpio::{Input, Output, Pin, PullUp, PushPull};
use crate::nrf_hal::pac::UARTE0;
use crate::nrf_hal::uarte::{Baudrate, Parity, Pins, Uarte};
use board_common::{FnSerial, SerialPort};
use cortex_m::singleton;
use embedded_hal_02::serial::{Read, Write};

/// Most bytes that are sent at once.
const CHUNK: usize = 64;

/// Sets the port up, once: its buffers are static.
pub fn new(uarte: UARTE0, txd: Pin<Output<PushPull>>, rxd: Pin<Input<PullUp>>) -> impl SerialPort {
    // Without the interface chip's power, the pull-up keeps the line idle. Safety: the HAL's type for this pin is a floating input; these are the bits of a
    // pin that nothing else has, and the port does not change its pull-up.
    let rxd = unsafe { Pin::from_psel_bits(rxd.psel_bits()) };
    let serial = Uarte::new(uarte, Pins { rxd, txd, cts: None, rts: None }, Parity::EXCLUDED, Baudrate::BAUD115200);
    let (Some(tx), Some(rx)) = (singleton!(: [u8; CHUNK] = [0; CHUNK]), singleton!(: [u8; 1] = [0])) else {
        unreachable!("the port is set up once")
    };
    let Ok((mut tx, mut rx)) = serial.split(tx, rx) else { unreachable!("the port supports buffers of these sizes") };
    let send = move |bytes: &[u8]| {
        for bytes in bytes.chunks(CHUNK) {
            for byte in bytes {
                // The buffer is empty and holds as many.
                let _ = tx.write(*byte);
            }
            while tx.flush().is_err() {}
        }
    };
    #[cfg(not(feature = "buffered"))]
    let poll = move || rx.read().ok().filter(|_| is_whole());
    #[cfg(feature = "buffered")]
    let poll = {
        let _ = rx.read();
        crate::uart_rx::listen(rx);
        || None
    };
    FnSerial { send, poll }
}

/// Returns whether no error of the line, such as a break or a missing stop bit, belongs to the byte that was read last, and forgets it.
pub fn is_whole() -> bool {
    // Safety: the driver does not use this register, in which a written 1 clears an error.
    unsafe {
        let errors = &(*UARTE0::ptr()).errorsrc;
        let found = errors.read().bits();
        errors.write(|w| w.bits(found));
        found == 0
    }
}
