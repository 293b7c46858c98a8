//! What answers on the I2C bus, for who wires a display and sees nothing.

use crate::SerialPort;
use embedded_hal::i2c::I2c;

const DIGITS: &[u8; 16] = b"0123456789abcdef";

/// Sends a line such as `I2C: 0x3c` over the serial port: the addresses that answer, or that nothing does.
pub fn report_bus(serial: &mut impl SerialPort, bus: &mut impl I2c) {
    serial.send(b"I2C:");
    let mut any = false;
    board_drivers::scan::scan(bus, |address| {
        any = true;
        let digit = |value: u8| DIGITS[usize::from(value & 15)];
        serial.send(&[b' ', b'0', b'x', digit(address >> 4), digit(address)]);
    });
    serial.send(if any { b"\r\n" } else { b" nothing answers\r\n" });
}
