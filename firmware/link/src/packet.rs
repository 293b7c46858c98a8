//! Packets on a line: kind, sequence, payload and CRC, encoded by COBS, between zeros.
//!
//! ```text
//! 00  COBS( kind u8, sequence u8, payload, CRC-16/IBM-3740 u16 of all before it, least significant byte first )  00
//! ```
//!
//! A zero only ever ends a packet, so any damage ends at the next zero. Two adjacent packets may share one zero. A single byte between two zeros is
//! a **key** of a terminal on the same line.
//!
//! ```
//! use pantin_link::packet::{self, Receiver, kind};
//!
//! let mut line = [0; packet::line_len(3)];
//! let len = packet::encode(kind::MOTION, 7, b"abc", &mut line).unwrap();
//! let mut receiver = Receiver::<16>::new();
//! let mut received = false;
//! for &byte in &line[..len] {
//!     if let Some(packet) = receiver.push(byte) {
//!         assert_eq!((packet.sequence, packet.payload), (7, &b"abc"[..]));
//!         received = true;
//!     }
//! }
//! assert!(received);
//! ```

#[cfg(feature = "key")]
pub use crate::tag::{TAG, TagKey, encode_with_tag, tagged_line_len};
use crate::{cobs, parity};
use pantin::codec::crc;

/// Packet kinds: the first byte of a packet.
pub mod kind {
    use core::ops::RangeInclusive;

    /// Describes the clip: LINK.md 3.
    pub const HEAD: u8 = 0x01;
    /// Segments and refreshes: LINK.md 5.
    pub const MOTION: u8 = 0x02;
    /// Describes the channels: LINK.md 4.
    pub const STARTS: u8 = 0x03;
    /// An event of the clip: LINK.md 5a. It has the sequence of the packet before it.
    pub const EVENT: u8 = 0x04;
    /// Messages of a clip update: `pantin-store`.
    pub const UPDATES: RangeInclusive<u8> = 0x10..=0x1f;
}

/// Bytes of a packet in addition to its payload, before COBS encoding.
pub const OVERHEAD: usize = 4;

/// Parity bytes after the CRC, if both ends have agreed on parity: they correct 4 wrong bytes.
pub use crate::parity::PARITY;

/// Returns the most bytes that a packet takes on the line, both zeros and parity included.
pub const fn line_len(payload: usize) -> usize {
    let len = payload + OVERHEAD + PARITY;
    len + len.div_ceil(254) + 2
}

/// An intact packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packet<'a> {
    /// One of [`kind`].
    pub kind: u8,
    /// The sender's packet counter, modulo 256.
    pub sequence: u8,
    /// The content.
    pub payload: &'a [u8],
}

/// Encodes a packet with a zero before and after it. Returns the number of bytes, or `None` if `out` is too small ([`line_len`] is always enough).
/// After another packet the first zero may be omitted.
pub fn encode(kind: u8, sequence: u8, payload: &[u8], out: &mut [u8]) -> Option<usize> {
    put(&[kind, sequence], payload, &sum(&[kind, sequence], payload), &[], out)
}

/// Encodes a packet with parity after the CRC, for [`Receiver::with_parity`]. The payload has at most 243 bytes.
pub fn encode_with_parity(kind: u8, sequence: u8, payload: &[u8], out: &mut [u8]) -> Option<usize> {
    let head = [kind, sequence];
    let crc = sum(&head, payload);
    put(&head, payload, &crc, &parity::of(&[&head, payload, &crc]), out)
}

fn sum(head: &[u8], payload: &[u8]) -> [u8; 2] {
    crc::update(crc::of(head), payload).to_le_bytes()
}

pub(crate) fn put(head: &[u8], payload: &[u8], check: &[u8], parity: &[u8], out: &mut [u8]) -> Option<usize> {
    let (first, rest) = out.split_first_mut()?;
    let len = cobs::encode(&[head, payload, check, parity], rest)?;
    *rest.get_mut(len)? = 0;
    *first = 0;
    Some(len + 2)
}

/// Finds packets of at most `N` bytes (payload, [`OVERHEAD`] and parity) in the bytes of a line. Damaged packets are counted and dropped; random
/// bytes pass the CRC with probability 2^-16.
#[derive(Clone, Debug)]
pub struct Receiver<const N: usize> {
    bytes: [u8; N],
    len: usize,
    cobs: cobs::Decoder,
    /// Bytes since the last zero, before decoding.
    run_bytes: usize,
    first: u8,
    /// A confirmed key; 0 if there is none.
    key: u8,
    /// A single byte that may still be the first byte of a damaged packet; 0 if there is none.
    pending_key: u8,
    /// Whether the last packet was damaged: a single byte may be its last one.
    after_damage: bool,
    damaged: u32,
    /// Corrects packets with parity: a pointer, so that programs without parity do not link the code.
    correct: Option<fn(&mut [u8]) -> bool>,
    /// The key of the packets' tags.
    #[cfg(feature = "key")]
    tag_key: Option<TagKey>,
}

impl<const N: usize> Default for Receiver<N> {
    fn default() -> Self {
        Receiver::new()
    }
}

impl<const N: usize> Receiver<N> {
    /// Waits for the first byte.
    pub const fn new() -> Self {
        let cobs = cobs::Decoder::new();
        Receiver {
            bytes: [0; N],
            len: 0,
            cobs,
            run_bytes: 0,
            first: 0,
            key: 0,
            pending_key: 0,
            after_damage: false,
            damaged: 0,
            correct: None,
            #[cfg(feature = "key")]
            tag_key: None,
        }
    }

    /// The same, for packets with parity.
    pub const fn with_parity() -> Self {
        Receiver { correct: Some(parity::correct), ..Self::new() }
    }

    /// Takes only packets with a tag of this key: all others count as damaged. Letters ([`Receiver::take_key`]) have no tag.
    #[cfg(feature = "key")]
    pub const fn with_tag_key(self, key: TagKey) -> Self {
        Receiver { tag_key: Some(key), ..self }
    }

    /// Takes a byte from the line, and returns the packet that it completes.
    pub fn push(&mut self, byte: u8) -> Option<Packet<'_>> {
        if byte == 0 {
            return self.end();
        }
        if self.run_bytes == 0 {
            (self.len, self.cobs, self.first) = (0, cobs::Decoder::new(), byte);
        }
        self.run_bytes = self.run_bytes.saturating_add(1);
        if let Some(byte) = self.cobs.feed(byte) {
            if let Some(place) = self.bytes.get_mut(self.len) {
                *place = byte;
            }
            self.len = self.len.saturating_add(1);
        }
        None
    }

    fn end(&mut self) -> Option<Packet<'_>> {
        let since = core::mem::take(&mut self.run_bytes);
        if since < 2 {
            confirm_key(&mut self.pending_key, &mut self.key);
            if since == 0 {
                self.after_damage = false;
            } else if !self.after_damage {
                self.pending_key = self.first;
            }
            return None;
        }
        // A damaged COBS code byte puts zeros in wrong places but keeps the length, so parity may correct it.
        let whole = self.cobs.whole() || self.correct.is_some();
        // `None` for a packet that was too long.
        let bytes = self.bytes.get_mut(..self.len).filter(|_| whole);
        let correct = self.correct;
        let unmended = |bytes| match correct {
            Some(correct) => without_parity(bytes, correct),
            None => Some(bytes),
        };
        let packet = bytes.and_then(unmended).and_then(|bytes| {
            #[cfg(feature = "key")]
            if let Some(key) = &self.tag_key {
                return packet_of(key.without_tag(bytes)?);
            }
            open(bytes)
        });
        self.after_damage = packet.is_none();
        if self.after_damage {
            self.damaged = self.damaged.wrapping_add(1);
            self.pending_key = 0;
        } else {
            confirm_key(&mut self.pending_key, &mut self.key);
        }
        packet
    }

    /// Returns the key that was pressed since the last call. A single byte between two zeros is a key once an intact packet, another single byte or a
    /// second zero follows it, and no damaged packet precedes it: a bit error that creates a zero within a packet presses no key.
    pub fn take_key(&mut self) -> Option<u8> {
        Some(core::mem::take(&mut self.key)).filter(|&key| key != 0)
    }

    /// Returns the key also if it is the only byte after the last zero. Call this when no byte has arrived for a while: if the byte was the first of a packet,
    /// that packet is lost.
    pub fn take_key_after_timeout(&mut self) -> Option<u8> {
        if self.run_bytes == 1 {
            self.run_bytes = 0;
            return Some(self.first);
        }
        confirm_key(&mut self.pending_key, &mut self.key);
        self.take_key()
    }

    /// Returns the number of damaged packets, modulo 2^32. Pieces count: a zero created by a bit error makes two.
    pub fn damaged(&self) -> u32 {
        self.damaged
    }
}

/// Confirms the pending key: what follows it does not belong to the same packet.
fn confirm_key(pending: &mut u8, key: &mut u8) {
    if *pending != 0 {
        *key = core::mem::take(pending);
    }
}

/// Returns the bytes before the parity, corrected if necessary.
fn without_parity(bytes: &mut [u8], correct: fn(&mut [u8]) -> bool) -> Option<&mut [u8]> {
    let len = bytes.len().checked_sub(PARITY)?;
    if correct(bytes) { bytes.get_mut(..len) } else { None }
}

/// Returns the packet if the CRC of its decoded bytes is right.
fn open(bytes: &[u8]) -> Option<Packet<'_>> {
    let (bytes, sum) = bytes.split_last_chunk()?;
    if crc::of(bytes) == u16::from_le_bytes(*sum) { packet_of(bytes) } else { None }
}

/// Splits the bytes of a packet without its CRC or tag.
fn packet_of(bytes: &[u8]) -> Option<Packet<'_>> {
    let &[kind, sequence, ref payload @ ..] = bytes else { return None };
    Some(Packet { kind, sequence, payload })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn line(kind: u8, sequence: u8, payload: &[u8]) -> Vec<u8> {
        let mut out = vec![0xaa; line_len(payload.len())];
        let len = encode(kind, sequence, payload, &mut out).expect("line_len is enough");
        out.truncate(len);
        out
    }

    fn received<const N: usize>(receiver: &mut Receiver<N>, bytes: &[u8]) -> Vec<(u8, u8, Vec<u8>)> {
        bytes.iter().filter_map(|&byte| receiver.push(byte).map(|p| (p.kind, p.sequence, p.payload.to_vec()))).collect()
    }

    #[test]
    fn a_packet_on_the_line() {
        let bytes = line(kind::MOTION, 7, &[0, 0x55]);
        let crc = pantin::codec::crc::of(&[kind::MOTION, 7, 0, 0x55]).to_le_bytes();
        assert_eq!(bytes, [0, 3, kind::MOTION, 7, 4, 0x55, crc[0], crc[1], 0]);
    }

    #[test]
    fn room_that_is_too_small_is_told() {
        let whole = line(1, 2, &[3; 300]);
        for len in 0..whole.len() {
            assert_eq!(encode(1, 2, &[3; 300], &mut vec![0; len]), None);
        }
    }

    #[test]
    fn keys_share_the_line() {
        let mut receiver = Receiver::<16>::new();
        let mut bytes = line(1, 1, b"abc");
        bytes.extend([b'q']);
        bytes.extend(line(1, 2, b"def"));
        assert_eq!(received(&mut receiver, &bytes).len(), 2);
        assert_eq!((receiver.take_key(), receiver.take_key(), receiver.damaged()), (Some(b'q'), None, 0));
        receiver.push(b'h');
        assert_eq!(receiver.take_key(), None);
        assert_eq!((receiver.take_key_after_timeout(), receiver.take_key_after_timeout()), (Some(b'h'), None));
        assert_eq!(received(&mut receiver, &line(1, 3, b"ghi")).len(), 1);
    }

    #[test]
    fn a_zero_that_a_flipped_bit_makes_presses_no_key() {
        let payload: Vec<u8> = (1..=40).collect();
        let good = line(1, 1, &payload);
        for torn in 1..good.len() - 1 {
            let mut bad = good.clone();
            bad[torn] = 0;
            let mut receiver = Receiver::<64>::new();
            let mut keys = vec![];
            for byte in [&good[..], &bad, &good, &[0, 0, b'q', 0, 0], &bad[..bad.len() - 1], &[0, 0, b'w', 0, 0]].concat() {
                receiver.push(byte);
                keys.extend(receiver.take_key());
            }
            assert_eq!(keys, b"qw", "byte {torn}");
        }
    }

    #[test]
    fn one_that_is_too_long_is_damaged_and_the_next_is_not() {
        let mut receiver = Receiver::<8>::new();
        let bytes = [line(1, 1, &[9; 5]), line(1, 2, &[9; 4]), line(1, 3, &[9; 400]), line(1, 4, &[])].concat();
        let got: Vec<_> = received(&mut receiver, &bytes).iter().map(|packet| packet.1).collect();
        assert_eq!((got, receiver.damaged()), (vec![2, 4], 2));
    }

    #[test]
    fn parity_mends_any_flips_in_four_bytes_of_a_packet() {
        let payload: Vec<u8> = (0..90u32).map(|i| (i * 37 % 181) as u8).collect();
        let mut whole = vec![0; line_len(payload.len())];
        let len = encode_with_parity(kind::MOTION, 9, &payload, &mut whole).expect("line_len is enough");
        whole.truncate(len);
        let mut missed = 0;
        for at in 1..len - 1 {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x10;
            let mut receiver = Receiver::<128>::with_parity();
            missed += usize::from(received(&mut receiver, &bytes) != [(kind::MOTION, 9, payload.clone())]);
        }
        // Parity corrects COBS code bytes too, unless the runs shift.
        assert!(missed <= 2, "{missed} of {len}");
    }

    proptest! {
        #[test]
        fn what_is_sent_arrives(kind: u8, sequence: u8, payload in prop::collection::vec(any::<u8>(), 0..700), shared: bool) {
            let mut receiver = Receiver::<800>::new();
            let bytes = line(kind, sequence, &payload);
            let twice = [&bytes[..], &bytes[usize::from(shared)..]].concat();
            prop_assert!(bytes[1..bytes.len() - 1].iter().all(|&byte| byte != 0));
            let expected = (kind, sequence, payload);
            prop_assert_eq!(received(&mut receiver, &twice), vec![expected.clone(), expected]);
            prop_assert_eq!(receiver.damaged(), 0);
        }

        #[test]
        fn any_bytes_at_all_and_then_two_packets(noise in prop::collection::vec(any::<u8>(), 0..600)) {
            let mut receiver = Receiver::<64>::new();
            received(&mut receiver, &noise);
            // Whatever the noise began ends at the first zero.
            let got = received(&mut receiver, &[line(1, 5, b"first"), line(1, 6, b"second")].concat());
            prop_assert_eq!(got, vec![(1, 5, b"first".to_vec()), (1, 6, b"second".to_vec())]);
        }

        #[test]
        fn a_byte_lost_inserted_or_flipped_costs_that_packet_alone(at in 1usize..12, what in 0u8..3, byte: u8) {
            let mut bytes = line(1, 1, b"damaged");
            match what {
                0 => { bytes.remove(at); }
                1 => bytes.insert(at, byte),
                _ => bytes[at] ^= byte.max(1),
            }
            let whole = line(1, 1, b"damaged");
            bytes.extend(line(1, 2, b"whole"));
            let mut receiver = Receiver::<64>::new();
            let got = received(&mut receiver, &bytes);
            prop_assert_eq!(got.last(), Some(&(1, 2, b"whole".to_vec())));
            // Only a zero inserted beside another zero is no damage.
            prop_assert!(got.len() == 1 || bytes.iter().filter(|&&b| b != 0).eq(whole.iter().chain(&line(1, 2, b"whole")).filter(|&&b| b != 0)));
        }
    }
}
