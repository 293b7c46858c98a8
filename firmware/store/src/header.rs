//! The header of a clip in its slot.
//!
//! | at | bytes | what |
//! |--:|--:|---|
//! | 0 | 4 | `PTN` and 1 |
//! | 4 | 4 | length of the clip, bytes |
//! | 8 | 4 | CRC-32 of the clip |
//! | 12 | 4 | sequence: one more than that of the previous clip, modulo 2^32 |
//! | 16 | 28 | name, UTF-8, padded with zeros |
//! | 44 | 4 | CRC-32 of the 44 bytes before it |
//!
//! Numbers are little-endian. The CRC-32 is CRC-32/ISO-HDLC, as in zip and PNG. The rest of the block stays erased.

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

/// Bytes of a header.
pub const HEADER_BYTES: usize = 48;
/// Most bytes of a name.
pub const NAME_BYTES: usize = 28;

const MAGIC: [u8; 4] = *b"PTN\x01";

/// Without a table: it saves a kilobyte of flash, and the checksum is not time-critical.
const CRC_32: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// Returns the CRC-32/ISO-HDLC of the bytes.
pub fn crc_32(bytes: &[u8]) -> u32 {
    CRC_32.checksum(bytes)
}

/// The name of a clip: at most [`NAME_BYTES`] bytes of UTF-8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name([u8; NAME_BYTES]);

impl Name {
    /// Takes as many whole characters of `name` as fit.
    pub fn new(name: &str) -> Name {
        let end = (0..=NAME_BYTES).rev().find(|&end| name.is_char_boundary(end)).unwrap_or(0);
        Name::of_bytes(name.as_bytes().get(..end).unwrap_or_default())
    }

    /// Takes bytes that may be invalid UTF-8 or too long.
    pub(crate) fn of_bytes(bytes: &[u8]) -> Name {
        let mut name = [0; NAME_BYTES];
        name.iter_mut().zip(bytes).for_each(|(place, &byte)| *place = byte);
        Name(name)
    }

    /// Returns the name, or "clip" if it is empty or no UTF-8.
    pub fn as_str(&self) -> &str {
        let letters = self.0.split(|&byte| byte == 0).next().unwrap_or_default();
        match core::str::from_utf8(letters) {
            Ok(letters) if !letters.is_empty() => letters,
            _ => "clip",
        }
    }

    pub(crate) fn bytes(&self) -> &[u8; NAME_BYTES] {
        &self.0
    }
}

/// Length, checksum and name of a clip, as a header or a sender states them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClipInfo {
    /// Length in bytes.
    pub length: u32,
    /// CRC-32 of these bytes.
    pub crc: u32,
    /// The name that a board shows.
    pub name: Name,
}

impl ClipInfo {
    /// Describes a clip. Returns `None` for 4 GiB and more.
    pub fn of(clip: &[u8], name: &str) -> Option<ClipInfo> {
        Some(ClipInfo { length: u32::try_from(clip.len()).ok()?, crc: crc_32(clip), name: Name::new(name) })
    }
}

/// A slot's header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// The clip.
    pub info: ClipInfo,
    /// Determines which of two clips is newer.
    pub sequence: u32,
}

impl Header {
    /// Reads a header. Returns `None` if the bytes are too few or the CRC is wrong.
    pub fn read(bytes: &[u8]) -> Option<Header> {
        let (fields, crc) = bytes.get(..HEADER_BYTES)?.split_last_chunk()?;
        if crc_32(fields) != u32::from_le_bytes(*crc) {
            return None;
        }
        let name = fields.strip_prefix(&MAGIC)?;
        let (length, rest) = number(name)?;
        let (crc, rest) = number(rest)?;
        let (sequence, name) = number(rest)?;
        Some(Header { info: ClipInfo { length, crc, name: Name::of_bytes(name) }, sequence })
    }

    /// Returns the header's bytes.
    pub fn bytes(&self) -> [u8; HEADER_BYTES] {
        let ClipInfo { length, crc, name } = &self.info;
        let mut bytes = [0; HEADER_BYTES];
        let numbers = [*length, *crc, self.sequence].map(u32::to_le_bytes);
        let fields = MAGIC.iter().chain(numbers.as_flattened()).chain(name.bytes());
        bytes.iter_mut().zip(fields).for_each(|(place, &byte)| *place = byte);
        if let Some((fields, crc)) = bytes.split_last_chunk_mut() {
            *crc = crc_32(fields).to_le_bytes();
        }
        bytes
    }

    /// Returns whether this header was written after `other`, if fewer than 2^31 were written in between.
    pub fn is_newer_than(&self, other: &Header) -> bool {
        self.sequence.wrapping_sub(other.sequence).cast_signed() > 0
    }
}

/// Splits a little-endian number off the front.
pub(crate) fn number(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (number, rest) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*number), rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn check_value_of_the_catalogue() {
        assert_eq!(crc_32(b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn the_bytes_of_a_header() {
        let header = Header { info: ClipInfo::of(b"123456789", "walk").unwrap(), sequence: 0x0102 };
        let bytes = header.bytes();
        assert_eq!(bytes[..20], *b"PTN\x01\x09\0\0\0\x26\x39\xf4\xcb\x02\x01\0\0walk");
        assert_eq!(bytes[20..44], [0; 24]);
        assert_eq!(bytes[44..], crc_32(&bytes[..44]).to_le_bytes());
    }

    #[test]
    fn names_end_at_whole_letters() {
        assert_eq!(Name::new("walk").as_str(), "walk");
        assert_eq!(Name::new(&"ä".repeat(20)).as_str(), "ä".repeat(14));
        assert_eq!(Name::new(&format!("a{}", "ä".repeat(20))).as_str(), format!("a{}", "ä".repeat(13)));
        assert_eq!(Name::of_bytes(&[0xff; 40]).as_str(), "clip");
        assert_eq!(Name::new("").as_str(), "clip");
    }

    #[test]
    fn the_newer_one_is_told_past_the_last_number() {
        let header = |sequence| Header { info: ClipInfo::of(b"", "").unwrap(), sequence };
        assert!(header(0).is_newer_than(&header(u32::MAX)));
        assert!(!header(u32::MAX).is_newer_than(&header(0)));
        assert!(!header(7).is_newer_than(&header(7)));
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_and_no_bit_of_it_may_flip(length: u32, crc: u32, sequence: u32, name: String, bit in 0..HEADER_BYTES * 8) {
            let header = Header { info: ClipInfo { length, crc, name: Name::new(&name) }, sequence };
            let mut bytes = header.bytes();
            prop_assert_eq!(Header::read(&bytes), Some(header));
            bytes[bit / 8] ^= 1 << (bit % 8);
            prop_assert_eq!(Header::read(&bytes), None);
        }

        #[test]
        fn anything_else_is_none(bytes in prop::collection::vec(any::<u8>(), 0..100)) {
            prop_assert_eq!(Header::read(&bytes), None);
        }
    }
}
