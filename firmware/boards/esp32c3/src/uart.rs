//! The serial port.

use board_common::{FnSerial, SerialPort};
use esp_hal::gpio::interconnect::{PeripheralInput, PeripheralOutput};
use esp_hal::peripherals::UART0;
use esp_hal::uart::{Config, Uart};

const BAUD: u32 = 115_200;

/// Sets the port up on its pins.
pub fn new(uart: UART0<'static>, tx: impl PeripheralOutput<'static>, rx: impl PeripheralInput<'static>) -> impl SerialPort {
    let Ok(serial) = Uart::new(uart, Config::default().with_baudrate(BAUD)) else { unreachable!("the port supports this rate") };
    #[cfg(feature = "buffered")]
    let serial = crate::uart_rx::listen(serial);
    let (mut rx, mut tx) = serial.with_tx(tx).with_rx(rx).split();
    let send = move |mut bytes: &[u8]| {
        while !bytes.is_empty() {
            let sent = tx.write(bytes).unwrap_or(bytes.len());
            bytes = bytes.get(sent..).unwrap_or_default();
        }
    };
    let poll = move || {
        let mut byte = [0];
        // A byte with an error is dropped.
        rx.read_buffered(&mut byte).ok().filter(|read| *read > 0).map(|_| byte[0])
    };
    FnSerial { send, poll }
}
