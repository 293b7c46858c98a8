//! The serial line to the board's interface chip, which is a serial port over USB.

use crate::nrf_hal::gpio::{Floating, Input, Output, Pin, PushPull};
use crate::nrf_hal::pac::UARTE0;
use crate::nrf_hal::uarte::{Baudrate, Parity, Pins, Uarte};
use board_common::{FnSerial, SerialPort};
use cortex_m::singleton;
use embedded_hal_02::serial::{Read, Write};

/// Most bytes that are sent at once.
const CHUNK: usize = 64;

/// Sets the port up, once: its buffers are static.
pub fn new(uarte: UARTE0, txd: Pin<Output<PushPull>>, rxd: Pin<Input<Floating>>) -> impl SerialPort {
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
    let poll = move || rx.read().ok();
    #[cfg(feature = "buffered")]
    let poll = {
        let _ = rx.read();
        crate::uart_rx::listen(rx);
        || None
    };
    FnSerial { send, poll }
}
