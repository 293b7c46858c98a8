//! The chip's own USB port, USB-Serial-JTAG: the cable that flashes the board carries the serial line too.

use board_common::{FnSerial, SerialPort};
use esp_hal::Blocking;
use esp_hal::peripherals::USB_DEVICE;
use esp_hal::time::{Duration, Instant};
use esp_hal::usb_serial_jtag::{UsbSerialJtag, UsbSerialJtagTx};

/// How long a PC that has the port closed, or does not read it, holds the board up, once.
const MAX_WAIT: Duration = Duration::from_millis(50);

/// Sets the port up. Returns it, and a function to be called before each look for a received byte. The port holds 64 bytes and lets the PC wait until they are
/// read: nothing is lost, and no interrupt is needed.
pub fn new(device: USB_DEVICE<'static>) -> (impl SerialPort, impl FnMut()) {
    let (mut rx, tx) = UsbSerialJtag::new(device).split();
    let mut sender = Sender { tx, is_stuck: false };
    let send = move |bytes: &[u8]| sender.send(bytes);
    #[cfg(not(feature = "buffered"))]
    let (poll, fill) = (move || rx.read_byte().ok(), || {});
    #[cfg(feature = "buffered")]
    let (poll, fill) = {
        use board_common::uart_rx::{free, push};
        let fill = move || {
            while free() > 0
                && let Ok(byte) = rx.read_byte()
            {
                push(byte);
            }
        };
        (|| None, fill)
    };
    (FnSerial { send, poll }, fill)
}

struct Sender {
    tx: UsbSerialJtagTx<'static, Blocking>,
    /// No PC took what was sent last: bytes for which there is no room are dropped until one does.
    is_stuck: bool,
}

impl Sender {
    fn send(&mut self, bytes: &[u8]) {
        let begun = Instant::now();
        for byte in bytes {
            while self.tx.write_byte_nb(*byte).is_err() {
                if self.is_stuck || begun.elapsed() > MAX_WAIT {
                    self.is_stuck = true;
                    return;
                }
            }
        }
        self.is_stuck = false;
        // A packet that is not full goes now.
        let _ = self.tx.flush_tx_nb();
    }
}
