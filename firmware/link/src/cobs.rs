//! Consistent overhead byte stuffing (S. Cheshire and M. Baker, 1999): bytes without a zero, one longer a started 254.
//!
//! The crate of that name would bring a macro's parser into every firmware's build, and needs a frame's rest kept from it by hand
//! where one is too long.

/// What a run of 254 bytes and no zero after it begins with.
const FULL: u8 = 0xff;

/// Writes `parts`, one after the other, without zeros into `out`: how many bytes. None if they do not fit.
pub(crate) fn encode(parts: &[&[u8]], out: &mut [u8]) -> Option<usize> {
    let (mut code_at, mut at, mut code) = (0, 1, 1);
    for &byte in parts.iter().copied().flatten() {
        if code == FULL {
            *out.get_mut(code_at)? = code;
            (code_at, at, code) = (at, at + 1, 1);
        }
        if byte == 0 {
            *out.get_mut(code_at)? = code;
            (code_at, at, code) = (at, at + 1, 1);
        } else {
            *out.get_mut(at)? = byte;
            (at, code) = (at + 1, code + 1);
        }
    }
    *out.get_mut(code_at)? = code;
    Some(at)
}

/// Takes bytes that are not zero, one by one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decoder {
    /// Bytes of the run that are still to come.
    left: u8,
    /// A zero stands between the run and the next one.
    zero: bool,
}

impl Decoder {
    /// Before the first byte.
    pub(crate) const fn new() -> Decoder {
        Decoder { left: 0, zero: false }
    }

    /// Takes a byte, and hands on what it gives: at most one.
    pub(crate) fn feed(&mut self, byte: u8) -> Option<u8> {
        if let Some(left) = self.left.checked_sub(1) {
            self.left = left;
            return Some(byte);
        }
        let zero = self.zero;
        (self.left, self.zero) = (byte.saturating_sub(1), byte != FULL);
        zero.then_some(0)
    }

    /// Whether the bytes may end here.
    pub(crate) fn whole(&self) -> bool {
        self.left == 0
    }
}
