//! The receive buffer of the serial line, filled by its interrupt: a serial port holds few bytes, and a picture takes longer than these.

use core::cell::RefCell;
use critical_section::Mutex;
use heapless::Deque;

/// Bytes that the buffer holds: more than one packet of an update. The sender waits for the answer to a packet before it sends the next.
const CAPACITY: usize = 512;

static RECEIVED: Mutex<RefCell<Deque<u8, CAPACITY>>> = Mutex::new(RefCell::new(Deque::new()));

/// Adds a byte, in an interrupt handler. While the buffer is full, bytes are dropped, and the packet's CRC fails.
pub fn push(byte: u8) {
    critical_section::with(|section| {
        if let Ok(mut bytes) = RECEIVED.borrow(section).try_borrow_mut() {
            let _ = bytes.push_back(byte);
        }
    });
}

/// Returns how many bytes the buffer has room for.
pub fn free() -> usize {
    critical_section::with(|section| RECEIVED.borrow(section).try_borrow().map_or(0, |bytes| CAPACITY - bytes.len()))
}

/// Takes the next byte, if there is one.
pub fn pop() -> Option<u8> {
    critical_section::with(|section| RECEIVED.borrow(section).try_borrow_mut().ok()?.pop_front())
}
