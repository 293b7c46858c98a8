//! Consistent overhead byte stuffing (S. Cheshire and M. Baker, 1999): removes zeros and adds one byte for every 254 started.
//!
//! The crate `cobs` would add a macro parser to every firmware build, and has no way to skip the rest of a frame that is too long.

/// The code byte of a run of 254 bytes that no zero follows.
const FULL: u8 = 0xff;

/// Encodes the concatenated `parts` into `out`. Returns the number of bytes written, or `None` if `out` is too small.
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

/// Decodes bytes one by one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decoder {
    /// Bytes of the run that have not arrived yet.
    left: u8,
    /// Whether a zero comes between this run and the next.
    zero: bool,
}

impl Decoder {
    /// Waits for the first byte.
    pub(crate) const fn new() -> Decoder {
        Decoder { left: 0, zero: false }
    }

    /// Takes a byte other than zero, and returns the decoded byte if there is one.
    pub(crate) fn feed(&mut self, byte: u8) -> Option<u8> {
        if let Some(left) = self.left.checked_sub(1) {
            self.left = left;
            return Some(byte);
        }
        let zero = self.zero;
        (self.left, self.zero) = (byte.saturating_sub(1), byte != FULL);
        zero.then_some(0)
    }

    /// Returns whether the encoded bytes may end here.
    pub(crate) fn whole(&self) -> bool {
        self.left == 0
    }
}
