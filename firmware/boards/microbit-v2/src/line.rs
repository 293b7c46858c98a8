//! The serial line to the board's interface chip, which is a serial port on its USB.

use cortex_m::singleton;
use embedded_hal_02::serial::{Read, Write};
use nrf52833_hal::gpio::{Floating, Input, Output, Pin, PushPull};
use nrf52833_hal::pac::UARTE0;
use nrf52833_hal::uarte::{Baudrate, Parity, Pins, Uarte, UarteRx, UarteTx};

/// Bytes that are sent at once.
const ROOM: usize = 64;

/// The line, of 115,200 bits a second.
pub struct Line {
    out: UarteTx<UARTE0>,
    into: UarteRx<UARTE0>,
}

impl Line {
    /// Once only: its rooms are those of the whole program.
    pub fn new(line: UARTE0, txd: Pin<Output<PushPull>>, rxd: Pin<Input<Floating>>) -> Self {
        let line = Uarte::new(line, Pins { rxd, txd, cts: None, rts: None }, Parity::EXCLUDED, Baudrate::BAUD115200);
        let (Some(out), Some(into)) = (singleton!(: [u8; ROOM] = [0; ROOM]), singleton!(: [u8; 1] = [0])) else {
            unreachable!("the line is set up once")
        };
        match line.split(out, into) {
            Ok((out, into)) => Line { out, into },
            Err(_) => unreachable!("its rooms are of sizes that it takes"),
        }
    }

    /// Sends bytes.
    pub fn send(&mut self, bytes: &[u8]) {
        for bytes in bytes.chunks(ROOM) {
            for byte in bytes {
                // The room is empty and takes as many.
                let _ = self.out.write(*byte);
            }
            while self.out.flush().is_err() {}
        }
    }

    /// A byte that has come.
    pub fn receive(&mut self) -> Option<u8> {
        self.into.read().ok()
    }
}
