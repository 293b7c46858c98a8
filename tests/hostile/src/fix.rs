//! Repairs what the first checks would refuse, and nothing else.

use pantin::Bank;
use pantin::codec::keys::{KEY_FLAGS, KEY_VERSION};
use pantin::codec::layout::{
    BANK_MAGIC, BLOCK_BYTES, CRC_BYTES, HAS_EVENT_NAMES, HAS_INDEX, HAS_RIG, HAS_SECTIONS, KNOWN_FLAGS, MAGIC, VERSION, section,
};
use pantin::codec::{crc, varint};

/// Makes the CRC of a rig or of event names right, if they are long enough to have one.
pub fn rig(bytes: &mut [u8]) {
    if let Some((body, stored)) = bytes.split_last_chunk_mut::<CRC_BYTES>() {
        *stored = crc::of(body).to_le_bytes();
    }
}

/// Makes a bank's magic, version and CRCs right, as far as its sections can be told; the clips stay as they are.
pub fn bank(bytes: &mut [u8]) {
    let Some((front, mut rest)) = bytes.split_at_mut_checked(3) else { return };
    front.copy_from_slice(&[BANK_MAGIC[0], BANK_MAGIC[1], VERSION]);
    while let Some((&mut kind, after)) = rest.split_first_mut() {
        let Some((len, digits)) = varint(after) else { return };
        let Some((body, behind)) = after[digits..].split_at_mut_checked(len) else { return };
        if matches!(kind, section::RIG | section::CONTENTS) {
            rig(body);
        }
        rest = behind;
    }
}

/// Makes the clips of a bank that opens right, as [`clip`] does, as far as that leaves them their lengths.
pub fn clips_of_bank(bytes: &mut [u8]) {
    let Ok(bank) = Bank::new_checked(bytes) else { return };
    let clips: Vec<(usize, Vec<u8>)> = bank
        .entries()
        .map(|entry| {
            let mut mended = entry.bytes().to_vec();
            clip(&mut mended);
            (entry.bytes().as_ptr().addr() - bytes.as_ptr().addr(), mended)
        })
        .zip(bank.entries())
        .filter_map(|(mended, entry)| (mended.1.len() == entry.bytes().len()).then_some(mended))
        .collect();
    for (at, mended) in clips {
        bytes[at..at + mended.len()].copy_from_slice(&mended);
    }
}

/// Makes magic, version, flags, the motion's length and all CRCs of a clip of segments right.
pub fn clip(bytes: &mut Vec<u8>) {
    of_version(bytes, VERSION, KNOWN_FLAGS);
}

/// The same of a key clip.
pub fn key_clip(bytes: &mut Vec<u8>) {
    of_version(bytes, KEY_VERSION, KEY_FLAGS);
}

fn of_version(bytes: &mut Vec<u8>, version: u8, known_flags: u8) {
    bytes.resize(bytes.len().max(8), 0);
    bytes[..2].copy_from_slice(&MAGIC);
    bytes[2] = version;
    bytes[3] &= known_flags;
    let flags = bytes[3];
    let mut at = 4;
    if flags & HAS_RIG != 0 {
        let Some((len, digits)) = varint(&bytes[at..]) else { return };
        at += digits;
        let Some(body) = bytes[at..].get_mut(..len) else { return };
        rig(body);
        at += len;
    }
    let Some((len, digits)) = varint(&bytes[at..]) else { return };
    let mut motion = bytes.split_off(at).split_off(digits);
    // What follows the motion: its bytes, where there are lengths, end where these say.
    let mut rest =
        if flags & (HAS_INDEX | HAS_EVENT_NAMES | HAS_SECTIONS) != 0 { motion.split_off(len.min(motion.len())) } else { vec![] };
    let seed = crc::update(crc::of(&bytes[..4]), &(motion.len() as u32).to_le_bytes());
    let last = put_part(bytes, &motion, seed);
    if flags & HAS_INDEX != 0 {
        let (len, digits) = varint(&rest).unwrap_or((0, rest.len()));
        let mut index = rest.split_off(digits);
        rest = if flags & (HAS_EVENT_NAMES | HAS_SECTIONS) != 0 { index.split_off(len.min(index.len())) } else { vec![] };
        put_part(bytes, &index, pantin::codec::index_seed(last, index.len() as u32));
    }
    if flags & HAS_EVENT_NAMES != 0 {
        let (len, digits) = varint(&rest).unwrap_or((0, rest.len()));
        let mut names = rest.split_off(digits);
        rest = if flags & HAS_SECTIONS != 0 { names.split_off(len.min(names.len())) } else { vec![] };
        names.resize(names.len().max(CRC_BYTES), 0);
        rig(&mut names);
        put_varint(bytes, names.len());
        bytes.extend_from_slice(&names);
    }
    if flags & HAS_SECTIONS != 0 {
        bytes.extend_from_slice(&rest);
    }
}

/// A length and as many bytes of blocks, with their CRCs made right; the last of which it returns.
fn put_part(out: &mut Vec<u8>, blocks: &[u8], mut seed: u16) -> u16 {
    put_varint(out, blocks.len());
    let mut last = seed;
    for block in blocks.chunks(BLOCK_BYTES + CRC_BYTES) {
        let body = &block[..block.len().saturating_sub(CRC_BYTES)];
        last = crc::update(seed, body);
        out.extend_from_slice(body);
        out.extend_from_slice(&last.to_le_bytes()[..block.len() - body.len()]);
        seed = crc::INITIAL;
    }
    last
}

/// A length and how many bytes it takes.
fn varint(bytes: &[u8]) -> Option<(usize, usize)> {
    varint::get(bytes).map(|(len, digits)| (len as usize, digits))
}

fn put_varint(out: &mut Vec<u8>, value: usize) {
    varint::put(value as u32, &mut |byte| out.push(byte));
}
