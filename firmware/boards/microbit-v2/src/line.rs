//! The serial line to the board's interface chip, which is a serial port on its USB.

use cortex_m::singleton;
#[cfg(not(feature = "update"))]
use embedded_hal_02::serial::Read;
use embedded_hal_02::serial::Write;
use nrf52833_hal::gpio::{Floating, Input, Output, Pin, PushPull};
use nrf52833_hal::pac::UARTE0;
#[cfg(not(feature = "update"))]
use nrf52833_hal::uarte::UarteRx;
use nrf52833_hal::uarte::{Baudrate, Parity, Pins, Uarte, UarteTx};

/// Bytes that are sent at once.
const ROOM: usize = 64;

/// The line, of 115,200 bits a second.
pub struct Line {
    out: UarteTx<UARTE0>,
    #[cfg(not(feature = "update"))]
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
            #[cfg(not(feature = "update"))]
            Ok((out, into)) => Line { out, into },
            #[cfg(feature = "update")]
            Ok((out, into)) => {
                crate::received::listen(into);
                Line { out }
            }
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
        #[cfg(feature = "update")]
        return crate::received::take();
        #[cfg(not(feature = "update"))]
        self.into.read().ok()
    }
}
