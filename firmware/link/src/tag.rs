//! Packets with a tag in place of the CRC, for lines that others can write to.

use core::hash::Hasher;

use crate::packet::{self, PARITY};
use crate::parity;
use siphasher::sip::SipHasher24;

/// Bytes of a tag. It replaces the CRC: a packet with a tag is 6 bytes longer.
pub const TAG: usize = 8;

/// A secret of 128 bits that both ends of a line share. Packets then carry a tag (SipHash-2-4, 64 bits) in place of the CRC, which only those who know
/// the key can compute: a forged packet passes with probability 2^-64. A tag does not hide the motion, and recorded packets can be replayed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TagKey([u8; 16]);

impl TagKey {
    /// Takes the bytes of the key, which should be random.
    pub const fn new(bytes: [u8; 16]) -> TagKey {
        TagKey(bytes)
    }

    /// Reads 32 hexadecimal digits. Returns `None` for anything else.
    pub fn from_hex(text: &str) -> Option<TagKey> {
        let mut bytes = [0; 16];
        if text.len() != 2 * bytes.len() {
            return None;
        }
        for (byte, pair) in bytes.iter_mut().zip(text.as_bytes().chunks_exact(2)) {
            for &digit in pair {
                *byte = *byte << 4 | char::from(digit).to_digit(16)? as u8;
            }
        }
        Some(TagKey(bytes))
    }

    /// Returns the tag of the concatenated parts.
    fn tag(&self, parts: [&[u8]; 2]) -> [u8; TAG] {
        let mut hasher = SipHasher24::new_with_key(&self.0);
        parts.into_iter().for_each(|part| hasher.write(part));
        hasher.finish().to_le_bytes()
    }

    /// Returns the bytes before the tag if the tag is theirs.
    pub(crate) fn without_tag<'b>(&self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let (bytes, tag) = bytes.split_last_chunk::<TAG>()?;
        // All bytes are compared, so that the time does not depend on how many are right.
        let wrong = self.tag([bytes, &[]]).iter().zip(tag).fold(0, |wrong, (own, theirs)| wrong | (own ^ theirs));
        if wrong == 0 { Some(bytes) } else { None }
    }
}

impl core::fmt::Debug for TagKey {
    /// Prints no part of the key.
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("TagKey")
    }
}

/// Returns the most bytes that a packet with a tag takes on the line, both zeros and parity included.
pub const fn tagged_line_len(payload: usize) -> usize {
    packet::line_len(payload + TAG - 2)
}

/// Encodes a packet with a tag in place of the CRC, for [`Receiver::with_tag_key`](packet::Receiver::with_tag_key), and with parity after it if `parity`
/// is true. Returns the number of bytes, or `None` if `out` is too small ([`tagged_line_len`] is always enough).
pub fn encode_with_tag(kind: u8, sequence: u8, payload: &[u8], key: &TagKey, parity: bool, out: &mut [u8]) -> Option<usize> {
    let head = [kind, sequence];
    let tag = key.tag([&head, payload]);
    let correction = if parity { parity::of(&[&head, payload, &tag]) } else { [0; PARITY] };
    packet::put(&head, payload, &tag, if parity { &correction } else { &[] }, out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packet::{Receiver, encode, line_len};

    fn received<const N: usize>(receiver: &mut Receiver<N>, bytes: &[u8]) -> Vec<u8> {
        bytes.iter().filter_map(|&byte| receiver.push(byte).map(|packet| packet.sequence)).collect()
    }

    const KEY: TagKey = TagKey::new(*b"0123456789abcdef");

    fn tagged(sequence: u8, payload: &[u8], key: &TagKey, parity: bool) -> Vec<u8> {
        let mut out = vec![0; tagged_line_len(payload.len())];
        let len = encode_with_tag(1, sequence, payload, key, parity, &mut out).expect("tagged_line_len is enough");
        out.truncate(len);
        out
    }

    #[test]
    fn packets_with_a_tag_are_received_by_who_shares_the_key_and_no_others_are() {
        for parity in [false, true] {
            let receiver = || if parity { Receiver::<64>::with_parity() } else { Receiver::new() };
            let forged = TagKey::new([0; 16]);
            let bytes = [
                tagged(1, b"abc", &KEY, parity),
                tagged(2, b"abc", &forged, parity),
                plain(3, b"abc"),
                tagged(4, b"", &KEY, parity),
            ]
            .concat();
            let mut own = receiver().with_tag_key(KEY);
            let sequences: Vec<u8> = received(&mut own, &bytes);
            assert_eq!((sequences, own.damaged()), (vec![1, 4], 2), "parity {parity}");
            assert!(received(&mut receiver(), &bytes).iter().all(|&sequence| sequence == 3));
        }
        let mut without = Receiver::<64>::new().with_tag_key(KEY);
        let bytes = tagged(1, b"abc", &KEY, false);
        for bit in 8..(bytes.len() - 1) * 8 {
            let mut bytes = bytes.clone();
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(received(&mut without, &bytes).is_empty(), "bit {bit}");
        }
    }

    #[test]
    fn the_tag_is_siphash_2_4() {
        // The reference vector of J.-P. Aumasson and D. J. Bernstein (2012), appendix A: 15 bytes.
        let key = TagKey::from_hex("000102030405060708090a0b0c0d0e0f").expect("32 digits");
        let bytes: Vec<u8> = (0..15).collect();
        assert_eq!(key.tag([&bytes[..2], &bytes[2..]]), 0xa129_ca61_49be_45e5u64.to_le_bytes());
        assert_eq!([TagKey::from_hex("00"), TagKey::from_hex(&"g".repeat(32)), TagKey::from_hex(&"ä".repeat(16))], [None; 3]);
    }

    fn plain(sequence: u8, payload: &[u8]) -> Vec<u8> {
        let mut out = vec![0; line_len(payload.len())];
        let len = encode(1, sequence, payload, &mut out).expect("line_len is enough");
        out.truncate(len);
        out
    }
}
