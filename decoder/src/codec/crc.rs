//! CRC-16/IBM-3740 ("CCITT-FALSE"): polynomial 0x1021, initial value 0xFFFF, no reflection, no final xor.
//!
//! It detects every single-bit error, and every burst of up to 16 bits, in a block of [`crate::layout::BLOCK_BYTES`].

use crate::layout::{MAGIC, VERSION};

/// The value before the first byte.
pub const INITIAL: u16 = 0xffff;

/// Continues `crc` over one byte, without a table.
#[inline(always)]
pub(crate) fn push(crc: u16, byte: u8) -> u16 {
    // The byte's quotient by the polynomial; x^16 leaves x^12 + x^5 + 1.
    let quotient = (crc >> 8) ^ u16::from(byte);
    let quotient = quotient ^ (quotient >> 4);
    (crc << 8) ^ (quotient << 12) ^ (quotient << 5) ^ quotient
}

/// Continues `crc` over two bytes, in two thirds of the instructions of twice [`push`].
#[inline(always)]
fn push_pair(crc: u16, pair: [u8; 2]) -> u16 {
    let top = crc ^ u16::from_be_bytes(pair);
    // Their quotient: x^32 divided by the polynomial is x^16 + x^12 + x^8 + x^5 + x^4.
    let part = top ^ (top >> 4);
    let quotient = part ^ (part >> 8) ^ (top >> 11);
    (quotient << 12) ^ (quotient << 5) ^ quotient
}

/// Continues `crc` over `bytes`. Not inlined: it is small, and called in many places.
#[inline(never)]
pub fn update(crc: u16, bytes: &[u8]) -> u16 {
    let (pairs, last) = bytes.as_chunks::<2>();
    let crc = pairs.iter().fold(crc, |crc, &pair| push_pair(crc, pair));
    last.iter().fold(crc, |crc, &byte| push(crc, byte))
}

/// The CRC of `bytes` alone.
pub fn of(bytes: &[u8]) -> u16 {
    update(INITIAL, bytes)
}

/// The CRC of a file's first four bytes. Bit 7 of `flags`, which no file has, stands for the version of key clips.
pub(crate) fn of_front(flags: u8) -> u16 {
    #[cfg(feature = "keys")]
    let [version, flags] = [VERSION + (flags >> 7), flags & 0x7f];
    #[cfg(not(feature = "keys"))]
    let version = VERSION;
    of(&[MAGIC[0], MAGIC[1], version, flags])
}

/// What a motion's first block goes on from: the CRC of the file's first four bytes and the motion's length. Bit 7 of `flags`, which no file has,
/// stands for the version of key clips.
pub fn of_prefix(flags: u8, motion_len: u32) -> u16 {
    update(of_front(flags), &motion_len.to_le_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn check_value_of_the_catalogue() {
        assert_eq!(of(b"123456789"), 0x29b1);
    }

    #[test]
    fn pairs_are_two_bytes() {
        for step in 0..65_536u32 {
            let (crc, pair) = ((step.wrapping_mul(40_503) >> 3) as u16, (step as u16).to_be_bytes());
            assert_eq!(push_pair(crc, pair), pair.into_iter().fold(crc, push), "{crc:x} {pair:?}");
        }
    }

    #[test]
    fn may_be_taken_in_parts() {
        assert_eq!(update(of(b"1234"), b"56789"), of(b"123456789"));
    }
}
