//! The Rust decoder and the one that was written from FORMAT.md alone read damaged clips alike. `cargo xtask mutants` reads more.

use harness::differential::{self, Counts, Decoder};
use harness::setup;
use hostile::fix;
use hostile::mutants::{REFUSED, read, stream_refuses};
use pantin::codec::layout::{BLOCK_BYTES, CRC_BYTES, HAS_EVENTS, HAS_RIG};

/// Mutants of the golden vectors: a few seconds.
const MUTANTS: usize = 4000;
/// Mutants of banks, which have many clips.
const BANKS: usize = 600;

/// Fails with the first of the differences.
fn alike(counts: &Counts) {
    if let Some(first) = counts.differing.first() {
        panic!(
            "{} differ; {}\nRust:        {}\nindependent: {}",
            counts.differing.len(),
            first.bytes.escape_ascii(),
            first.rust,
            first.independent
        );
    }
}

/// A rig of one joint that has one channel.
fn rig(kind: u8) -> Vec<u8> {
    // Unit, exponent, y is up, one joint, no scalars; the joint: one channel, no parent, its kind, offset, no name.
    let mut rig = vec![1, 0, 1, 1, 0, 1, 0, kind, 0, 0, 0, 0];
    rig.extend([0; CRC_BYTES]);
    fix::rig(&mut rig);
    rig
}

/// Bytes of a clip's payload up to its number of events, with that.
const HEAD: usize = 5;

/// A clip of ten frames with this payload after its number of events.
fn clip(kind: u8, events: u8, payload: &[u8]) -> Vec<u8> {
    let rig = rig(kind);
    let mut bytes = vec![0, 0, 0, HAS_RIG | HAS_EVENTS, rig.len() as u8];
    bytes.extend(rig);
    // 120 frames per second, ten frames, exponent 0.
    let head: [u8; HEAD] = [1, 10, 0, events | 0x80, events >> 7];
    let motion = [&head, payload].concat();
    let blocks = motion.len().div_ceil(BLOCK_BYTES).max(1);
    // A length that takes as many bytes as the right one, which `fix` puts in.
    bytes.extend(if motion.len() + CRC_BYTES * blocks < 0x80 { vec![0] } else { vec![0x80, 1] });
    for block in motion.chunks(BLOCK_BYTES) {
        bytes.extend(block);
        bytes.extend([0; CRC_BYTES]);
    }
    fix::clip(&mut bytes);
    bytes
}

#[test]
fn mutants_of_the_golden_vectors_are_read_alike() {
    if setup::host_only("the independent decoder") {
        return;
    }
    let counts = differential::run(&Decoder::JavaScript, MUTANTS, 1, |_| {}).unwrap();
    println!("{} agreed, {} refused", counts.agreed, counts.refused);
    alike(&counts);
    assert!(counts.agreed > MUTANTS / 4 && counts.refused > MUTANTS / 20, "{} agreed, {} refused", counts.agreed, counts.refused);
}

#[test]
fn mutants_of_banks_are_read_alike() {
    if setup::host_only("the independent decoder") {
        return;
    }
    let counts = differential::run_banks(&Decoder::JavaScript, BANKS, 1, |_| {}).unwrap();
    println!("{} agreed, {} refused", counts.agreed, counts.refused);
    alike(&counts);
    assert!(counts.agreed > BANKS / 4 && counts.refused > BANKS / 20, "{} agreed, {} refused", counts.agreed, counts.refused);
}

/// Payloads that end before, at and after the end of the last event: in the second block, and with the last byte of the first.
#[test]
fn events_that_extend_past_the_payload_are_refused() {
    let in_second = [0, 7].repeat(128);
    let with_first = [&[0, 7].repeat(123)[..], &[0, 0x87, 1]].concat();
    assert_eq!(HEAD + with_first.len(), BLOCK_BYTES);
    for (count, events) in [(128, in_second), (124, with_first)] {
        let payload = [&events[..], &[9; 16]].concat();
        let clips: Vec<Vec<u8>> = (0..payload.len()).map(|len| clip(3, count, &payload[..len])).collect();
        for (len, bytes) in clips.iter().enumerate() {
            let refused = len < events.len();
            assert_eq!(read(bytes) == REFUSED, refused, "{len} bytes after the number of events");
            assert_eq!(stream_refuses(bytes, &rig(3)), refused, "{len} bytes in a stream");
        }
        if !setup::host_only("the independent decoder") {
            let mut counts = Counts::default();
            counts.add(clips).unwrap();
            alike(&counts);
            assert_eq!((counts.refused, counts.agreed), (events.len(), 16));
        }
    }
}

#[test]
fn kinds_13_to_15_are_refused_on_a_joint() {
    let clips: Vec<Vec<u8>> = (0..=15).map(|kind| clip(kind, 0, &[])).collect();
    for (kind, bytes) in clips.iter().enumerate() {
        assert_eq!(read(bytes) == REFUSED, kind >= 13, "kind {kind}");
    }
    if !setup::host_only("the independent decoder") {
        let mut counts = Counts::default();
        counts.add(clips).unwrap();
        alike(&counts);
        assert_eq!((counts.refused, counts.agreed), (3, 13));
    }
}
