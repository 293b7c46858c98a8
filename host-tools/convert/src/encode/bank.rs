//! Banks: clips of one rig in one file (decoder/FORMAT.md section 16), and clips with and without their rig.

use super::clip::assembled;
use super::{index, same_rig, varint};
use crate::encode::rig;
use crate::memory::Memory;
use anyhow::{Context, Result, bail, ensure};
use pantin::codec::crc;
use pantin::codec::keys::{KEY_VERSION, KEYS};
use pantin::codec::layout::*;
use pantin::{Bank, Clip, Rig};
use std::collections::HashMap;
use std::sync::Arc;

pub use super::travel::travel;

/// Most bytes of a clip's name.
pub const MOST_NAME_BYTES: usize = 255;

/// Most values of channels at frames that are played to make a clip's snapshots again: a few seconds.
const MOST_REPLAYED: u64 = 1 << 30;

/// A clip for a bank.
#[derive(Clone, Debug)]
pub struct Named {
    /// Its name in the bank.
    pub name: String,
    /// Where it is from, for errors.
    pub place: String,
    /// Its file, with or without its rig.
    pub clip: Vec<u8>,
    /// Its rig. Clips of one bank share it.
    pub rig: Arc<[u8]>,
}

/// A rig that was checked, and its bytes.
#[derive(Clone, Copy, Debug)]
pub struct CheckedRig<'a> {
    bytes: &'a [u8],
    rig: Rig<'a>,
}

impl<'a> CheckedRig<'a> {
    /// Checks `bytes`, all of them one rig with its CRC.
    pub fn new(bytes: &'a [u8]) -> Result<CheckedRig<'a>> {
        Ok(CheckedRig { bytes, rig: Rig::new_checked(bytes)? })
    }

    /// The rig of a bank.
    pub fn of(bank: &Bank<'a>) -> CheckedRig<'a> {
        CheckedRig { bytes: bank.rig_bytes(), rig: bank.rig() }
    }
}

/// The bank of these clips, which must have one rig and different names.
pub fn encode(clips: &[Named]) -> Result<Vec<u8>> {
    let Some(first) = clips.first() else { bail!("a bank holds at least one clip") };
    let rig = CheckedRig::new(&first.rig).with_context(|| first.place.clone())?;
    let (mut contents, mut bodies) = (Vec::new(), Vec::new());
    let mut named = HashMap::new();
    for Named { name, place, clip, rig: own } in clips {
        ensure!(!name.is_empty(), "{place}: a clip of a bank needs a name");
        ensure!(name.len() <= MOST_NAME_BYTES, "{place}: a name of {} bytes; at most {MOST_NAME_BYTES}", name.len());
        if let Some(other) = named.insert(name, place) {
            bail!("{other} and {place}: both would be `{name}` in the bank");
        }
        if let Some(difference) = difference(&first.rig, own).with_context(|| place.clone())? {
            bail!("{place}: another rig than {}: {difference}; a bank holds clips of one rig", first.place);
        }
        let body = without_rig(clip, &rig).with_context(|| place.clone())?;
        varint::put_name(&mut contents, name);
        varint::put(&mut contents, body.len() as u32);
        bodies.extend(body);
    }
    contents.extend(crc::of(&contents).to_le_bytes());
    let has_keys = clips.iter().any(|named| named.clip.get(2) == Some(&KEY_VERSION));
    let mut out = vec![BANK_MAGIC[0], BANK_MAGIC[1], if has_keys { KEY_VERSION } else { VERSION }];
    for (kind, body) in [(section::RIG, &first.rig[..]), (section::CONTENTS, &contents), (section::CLIPS, &bodies)] {
        put_section(&mut out, kind, body)?;
    }
    let bank = Bank::new_checked(&out).context("the bank that was just made does not open")?;
    ensure!(bank.len() == clips.len(), "the bank that was just made has {} clips, not {}", bank.len(), clips.len());
    for (named, entry) in clips.iter().zip(bank.entries()) {
        let name = &named.name;
        ensure!(entry.name() == name, "the bank that was just made has `{}` in place of `{name}`", entry.name());
        bank.open(&entry).with_context(|| format!("the bank that was just made does not open `{name}`"))?;
    }
    Ok(out)
}

/// A bank with a section of a type that only some programs read, in place of another of that type.
pub fn with_section(bank: &[u8], kind: u8, body: &[u8]) -> Result<Vec<u8>> {
    with_sections(bank, Bank::new_checked(bank)?.sections().filter(|(own, _)| *own != kind).chain([(kind, body)]))
}

/// A bank without the sections of a type that only some programs read.
pub fn without_section(bank: &[u8], kind: u8) -> Result<Vec<u8>> {
    with_sections(bank, Bank::new_checked(bank)?.sections().filter(|(own, _)| *own != kind))
}

/// A bank of the version of another, with these sections.
fn with_sections<'a>(bank: &[u8], sections: impl Iterator<Item = (u8, &'a [u8])>) -> Result<Vec<u8>> {
    let version = bank.get(2).copied().unwrap_or(VERSION);
    let mut out = vec![BANK_MAGIC[0], BANK_MAGIC[1], version];
    for (kind, body) in sections {
        put_section(&mut out, kind, body)?;
    }
    Bank::new_checked(&out).context("the bank that was just made does not open")?;
    Ok(out)
}

fn put_section(out: &mut Vec<u8>, kind: u8, body: &[u8]) -> Result<()> {
    out.push(kind);
    varint::put(out, u32::try_from(body.len()).context("a section of 4 GiB or more")?);
    out.extend_from_slice(body);
    Ok(())
}

/// The first difference between two rigs; `None` if they are the same.
fn difference(one: &[u8], other: &[u8]) -> Result<Option<String>> {
    if one == other {
        return Ok(None);
    }
    let [one, other] = [rig::decode(&Rig::new_checked(one)?), rig::decode(&Rig::new_checked(other)?)];
    Ok(Some(same_rig::difference(&one, &other)?.unwrap_or_else(|| "its bytes differ".into())))
}

/// The rig that a clip's file holds; empty without one.
pub fn rig_of(clip: &[u8]) -> Result<Vec<u8>> {
    Ok(Parts::of(clip)?.rig.to_vec())
}

/// The clip without its rig, which a decoder then needs beside it. One without a rig stays as it is.
pub fn without_rig(clip: &[u8], rig: &CheckedRig) -> Result<Vec<u8>> {
    converted(clip, rig, false)
}

/// The clip with its rig.
pub fn with_rig(clip: &[u8], rig: &CheckedRig) -> Result<Vec<u8>> {
    converted(clip, rig, true)
}

/// A clip's file as its parts.
struct Parts<'a> {
    flags: u8,
    rig: &'a [u8],
    motion: &'a [u8],
    index: &'a [u8],
    /// Names of events, with their length.
    names: &'a [u8],
}

impl<'a> Parts<'a> {
    /// The parts of a file that opens.
    fn of(file: &'a [u8]) -> Result<Parts<'a>> {
        let mut flags = *file.get(3).context("the clip is truncated")?;
        if file.get(2) == Some(&KEY_VERSION) {
            flags |= KEYS;
        }
        let mut rest = &file[4..];
        let mut part = |present: bool| -> Result<&'a [u8]> {
            if !present {
                return Ok(&[]);
            }
            let (len, digits) = varint::get(rest).context("the clip is truncated")?;
            let (part, after) = rest[digits..].split_at_checked(len as usize).context("the clip is truncated")?;
            rest = after;
            Ok(part)
        };
        let (rig, motion) = (part(flags & HAS_RIG != 0)?, part(true)?);
        let index = part(flags & HAS_INDEX != 0)?;
        Ok(Parts { flags, rig, motion, index, names: rest })
    }
}

/// Bytes in blocks without their CRCs.
fn payload(blocks: &[u8]) -> Vec<u8> {
    blocks.chunks(BLOCK_BYTES + CRC_BYTES).flat_map(|block| &block[..block.len().saturating_sub(CRC_BYTES)]).copied().collect()
}

/// The same motion with the rig in the file, or with its id in the motion's head. Snapshots are made again, as they say where in the motion they go on.
fn converted(file: &[u8], rig: &CheckedRig, whole: bool) -> Result<Vec<u8>> {
    let parts = Parts::of(file)?;
    match parts.flags & HAS_RIG {
        0 => Clip::with_checked_rig(file, rig.rig)?,
        _ => Clip::new_checked(file)?,
    };
    if (parts.flags & HAS_RIG != 0) == whole {
        return Ok(file.to_vec());
    }
    ensure!(whole || parts.rig == rig.bytes, "the clip has another rig");
    let mut motion = payload(parts.motion);
    let times = if motion.first() == Some(&0) { 5 } else { 1 };
    let (_, frames) = motion.get(times..).and_then(varint::get).context("the clip is truncated")?;
    let id_at = times + frames + 1;
    // A head may end behind the payload: a decoder reads zeros there.
    motion.resize(motion.len().max(id_at + if whole { 4 } else { 0 }), 0);
    if whole {
        motion.drain(id_at..id_at + 4);
    } else {
        motion.splice(id_at..id_at, rig.rig.id().to_le_bytes());
    }
    let spacing = (!parts.index.is_empty()).then(|| varint::get(&payload(parts.index))).flatten().map(|(spacing, _)| spacing);
    let flags = parts.flags & !(HAS_RIG | HAS_INDEX) | if whole { HAS_RIG } else { 0 };
    let file = |flags: u8, index: Option<&[u8]>| {
        let mut out = assembled(flags, rig.bytes, &motion, index);
        out.extend_from_slice(parts.names);
        out
    };
    let plain = file(flags, None);
    let clip = match whole {
        true => Clip::new_checked(&plain),
        false => Clip::with_checked_rig(&plain, rig.rig),
    };
    let clip = clip.context("the clip with its rig moved does not open")?;
    match spacing {
        None => Ok(plain),
        Some(spacing) => {
            // What a file asks for is as much as it has itself: a snapshot takes a byte or more.
            let (frames, channels) = (u64::from(clip.frames()), clip.moving() as u64 + 1);
            ensure!(
                frames / u64::from(spacing.max(1)) <= parts.index.len() as u64 && frames * channels <= MOST_REPLAYED,
                "the clip has {frames} frames and an index that is not of them, or takes too long to make again"
            );
            let bytes = file(flags | HAS_INDEX, Some(&index::payload(clip, spacing, Memory::default())?));
            index::check(&bytes, rig.bytes, spacing)?;
            Ok(bytes)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{self, Scalar};

    #[test]
    fn a_head_that_ends_behind_the_payload_is_no_fault() {
        let scalars = vec![Scalar { name: "a".into(), full_scale: 1.0 }];
        let figure = motion::Rig { joints: Vec::new(), scalars, cm_per_unit: 1.0, up: pantin::Up::Y };
        let bytes = rig::encode(&figure).unwrap();
        let checked = CheckedRig::new(&bytes).unwrap();
        // A rate of the table and a frame: the exponent and all symbols are the zeros behind the end.
        for payload in [&[1, 1][..], &[1, 1, 0], &[1, 1, 0, 0]] {
            let whole = assembled(HAS_RIG, &bytes, payload, None);
            let opened = Clip::new_checked(&whole);
            let apart = without_rig(&whole, &checked);
            assert_eq!(apart.is_ok(), opened.is_ok());
            if let Ok(apart) = apart {
                assert!(Clip::with_checked_rig(&apart, checked.rig).is_ok());
                assert!(Clip::new_checked(&with_rig(&apart, &checked).unwrap()).is_ok());
            }
        }
    }
}
