//! CRC-16/IBM-3740 ("CCITT-FALSE"): polynomial 0x1021, initial value 0xFFFF, no reflection, no final xor.
//!
//! It detects every single-bit error, and every burst of up to 16 bits, in a block of [`crate::layout::BLOCK_BYTES`].

use crate::layout::{MAGIC, VERSION};

/// The value before the first byte.
pub const INITIAL: u16 = 0xffff;

/// The remainder of one nibble: 32 bytes of flash in place of 512.
const NIBBLE: [u16; 16] = nibble_table();

const fn nibble_table() -> [u16; 16] {
    let mut table = [0; 16];
    let mut n = 0;
    while n < 16 {
        let mut crc = (n as u16) << 12;
        let mut bit = 0;
        while bit < 4 {
            crc = if crc & 0x8000 != 0 { (crc << 1) ^ 0x1021 } else { crc << 1 };
            bit += 1;
        }
        table[n] = crc;
        n += 1;
    }
    table
}

/// Continues `crc` over one byte.
#[inline(always)]
pub(crate) fn push(crc: u16, byte: u8) -> u16 {
    let high = (crc << 4) ^ NIBBLE[usize::from((crc >> 12) as u8 & 0xf) ^ usize::from(byte >> 4)];
    (high << 4) ^ NIBBLE[usize::from((high >> 12) as u8 & 0xf) ^ usize::from(byte & 0xf)]
}

/// Continues `crc` over `bytes`.
pub fn update(crc: u16, bytes: &[u8]) -> u16 {
    bytes.iter().fold(crc, |crc, &byte| push(crc, byte))
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
    fn may_be_taken_in_parts() {
        assert_eq!(update(of(b"1234"), b"56789"), of(b"123456789"));
    }
}
