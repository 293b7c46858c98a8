//! What answers on the I2C bus, for who wires a display and sees nothing.

use crate::SerialPort;
use board_drivers::i2c_wires::Wires;
use embedded_hal::i2c::I2c;

const DIGITS: &[u8; 16] = b"0123456789abcdef";

/// Sends a line such as `I2C: 0x3c` over the serial port: the addresses that answer, or that nothing does, or that a wire is held low. `wires` is what
/// they were like before; a device that was clocked free gets a line of its own.
pub fn report_bus(serial: &mut impl SerialPort, wires: Wires, bus: &mut impl I2c) {
    if let Wires::Freed(clocks) = wires {
        serial.send(b"I2C: a device held SDA low and let go after ");
        serial.send(&[b'0' + clocks % 10]);
        serial.send(b" clocks\r\n");
    }
    serial.send(b"I2C:");
    let mut any = false;
    let found = |address: u8| {
        any = true;
        let digit = |value: u8| DIGITS[usize::from(value & 15)];
        serial.send(&[b' ', b'0', b'x', digit(address >> 4), digit(address)]);
    };
    let is_held = wires == Wires::Held || board_drivers::scan::scan(bus, found).is_err();
    serial.send(match (is_held, any) {
        (true, _) => b" SDA or SCL is held low: a wire on GND, or a display without power\r\n".as_slice(),
        (false, true) => b"\r\n",
        (false, false) => b" nothing answers\r\n",
    });
}
