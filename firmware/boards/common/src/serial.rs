//! Serial ports.

use embedded_hal_nb::nb;
use embedded_hal_nb::serial::{Read, Write};

/// A serial port of 8-bit bytes, usually at 115,200 baud.
pub trait SerialPort {
    /// Sends bytes, and waits where the port's buffer is full. There is no handshake: bytes that cannot be sent are dropped.
    fn send(&mut self, bytes: &[u8]);

    /// Returns the next byte received, or `None` without waiting. With the feature `buffered` the program takes its bytes from `uart_rx` instead.
    fn poll(&mut self) -> Option<u8>;
}

/// A serial port with the traits of `embedded-hal-nb`.
#[derive(Debug)]
pub struct NbSerial<P>(pub P);

impl<P: Read + Write> SerialPort for NbSerial<P> {
    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let _ = nb::block!(self.0.write(*byte));
        }
    }

    #[inline(always)]
    fn poll(&mut self) -> Option<u8> {
        self.0.read().ok()
    }
}

/// A serial port of two functions.
#[derive(Clone, Copy, Debug)]
pub struct FnSerial<S, P> {
    /// Sends bytes.
    pub send: S,
    /// Returns the next byte received.
    pub poll: P,
}

impl<S: FnMut(&[u8]), P: FnMut() -> Option<u8>> SerialPort for FnSerial<S, P> {
    #[inline(always)]
    fn send(&mut self, bytes: &[u8]) {
        (self.send)(bytes);
    }

    #[inline(always)]
    fn poll(&mut self) -> Option<u8> {
        (self.poll)()
    }
}
