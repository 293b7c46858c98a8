//! What came over the line, heard by interrupt: a serial port holds few bytes, and a picture takes longer than those.

use core::cell::RefCell;
use critical_section::Mutex;
use heapless::Deque;

/// Bytes that wait: more than a packet of an update, of which the next comes only when the one before was answered.
const ROOM: usize = 512;

/// Bytes in the order in which they came.
#[derive(Debug)]
pub struct Inbox(Mutex<RefCell<Deque<u8, ROOM>>>);

impl Inbox {
    /// An empty one.
    #[allow(clippy::new_without_default)]
    pub const fn new() -> Self {
        Inbox(Mutex::new(RefCell::new(Deque::new())))
    }

    /// Takes a byte in. A line that sends more than was asked for loses it, and the packet's CRC tells.
    pub fn put(&self, byte: u8) {
        critical_section::with(|section| {
            if let Ok(mut bytes) = self.0.borrow(section).try_borrow_mut() {
                let _ = bytes.push_back(byte);
            }
        });
    }

    /// The next byte, if there is one.
    pub fn take(&self) -> Option<u8> {
        critical_section::with(|section| self.0.borrow(section).try_borrow_mut().ok()?.pop_front())
    }
}
