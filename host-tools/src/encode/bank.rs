//! Banks: clips of one rig in one file (decoder/FORMAT.md section 16), and clips with and without their rig.

use super::clip::assembled;
use super::{index, same_rig, varint};
use crate::encode::rig;
use anyhow::{Context, Result, bail, ensure};
use pantin::codec::crc;
use pantin::codec::layout::*;
use pantin::{Bank, Clip, Rig};

/// Most bytes of a clip's name.
pub const MOST_NAME_BYTES: usize = 255;

/// A clip for a bank.
#[derive(Clone, Debug)]
pub struct Named {
    /// Its name in the bank.
    pub name: String,
    /// Where it is from, for errors.
    pub place: String,
    /// Its file, with or without its rig.
    pub clip: Vec<u8>,
    /// Its rig.
    pub rig: Vec<u8>,
}

/// The bank of these clips, which must have one rig and different names.
pub fn encode(clips: &[Named]) -> Result<Vec<u8>> {
    let Some(first) = clips.first() else { bail!("a bank holds at least one clip") };
    let (mut contents, mut bodies) = (Vec::new(), Vec::new());
    for (index, named) in clips.iter().enumerate() {
        let Named { name, place, clip, rig } = named;
        ensure!(!name.is_empty(), "{place}: a clip of a bank needs a name");
        ensure!(name.len() <= MOST_NAME_BYTES, "{place}: a name of {} bytes; at most {MOST_NAME_BYTES}", name.len());
        if let Some(other) = clips[..index].iter().find(|other| other.name == *name) {
            bail!("{} and {place}: both would be `{name}` in the bank", other.place);
        }
        if let Some(difference) = difference(&first.rig, rig).with_context(|| place.clone())? {
            bail!("{place}: another rig than {}: {difference}; a bank holds clips of one rig", first.place);
        }
        let body = without_rig(clip, rig).with_context(|| place.clone())?;
        varint::put_name(&mut contents, name);
        varint::put(&mut contents, body.len() as u32);
        bodies.extend(body);
    }
    contents.extend(crc::of(&contents).to_le_bytes());
    let mut out = vec![BANK_MAGIC[0], BANK_MAGIC[1], VERSION];
    for (kind, body) in [(section::RIG, &first.rig), (section::CONTENTS, &contents), (section::CLIPS, &bodies)] {
        out.push(kind);
        varint::put(&mut out, u32::try_from(body.len()).context("a section of 4 GiB or more")?);
        out.extend_from_slice(body);
    }
    let bank = Bank::new_checked(&out).context("the bank that was just made does not open")?;
    for named in clips {
        bank.clip(&named.name).with_context(|| format!("the bank that was just made does not open `{}`", named.name))?;
    }
    Ok(out)
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
pub fn without_rig(clip: &[u8], rig: &[u8]) -> Result<Vec<u8>> {
    converted(clip, rig, false)
}

/// The clip with its rig.
pub fn with_rig(clip: &[u8], rig: &[u8]) -> Result<Vec<u8>> {
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
        let flags = *file.get(3).context("the clip is truncated")?;
        let mut rest = &file[4..];
        let mut part = |present: bool| -> Result<&'a [u8]> {
            if !present {
                return Ok(&[]);
            }
            let (len, digits) = number(rest).context("the clip is truncated")?;
            let (part, after) = rest[digits..].split_at_checked(len as usize).context("the clip is truncated")?;
            rest = after;
            Ok(part)
        };
        let (rig, motion) = (part(flags & HAS_RIG != 0)?, part(true)?);
        let index = part(flags & HAS_INDEX != 0)?;
        Ok(Parts { flags, rig, motion, index, names: rest })
    }
}

/// A varint and how many bytes it takes.
fn number(bytes: &[u8]) -> Option<(u32, usize)> {
    let mut value = 0;
    for (digit, &byte) in bytes.iter().enumerate().take(5) {
        value |= u32::from(byte & 0x7f) << (7 * digit);
        if byte & 0x80 == 0 || digit == 4 {
            return Some((value, digit + 1));
        }
    }
    None
}

/// Bytes in blocks without their CRCs.
fn payload(blocks: &[u8]) -> Vec<u8> {
    blocks.chunks(BLOCK_BYTES + CRC_BYTES).flat_map(|block| &block[..block.len().saturating_sub(CRC_BYTES)]).copied().collect()
}

/// The same motion with the rig in the file, or with its id in the motion's head. Snapshots are made again, as they say where in the motion they go on.
fn converted(file: &[u8], rig: &[u8], whole: bool) -> Result<Vec<u8>> {
    Clip::with_rig(file, rig)?;
    let parts = Parts::of(file)?;
    if (parts.flags & HAS_RIG != 0) == whole {
        return Ok(file.to_vec());
    }
    let mut motion = payload(parts.motion);
    let times = if motion.first() == Some(&0) { 5 } else { 1 };
    let (_, frames) = motion.get(times..).and_then(number).context("the clip is truncated")?;
    let id_at = times + frames + 1;
    if whole {
        motion.drain(id_at..id_at + 4);
    } else {
        let id = Rig::new_checked(parts.rig)?.id().to_le_bytes();
        motion.splice(id_at..id_at, id);
    }
    let spacing = (!parts.index.is_empty()).then(|| number(&payload(parts.index))).flatten().map(|(spacing, _)| spacing);
    let flags = parts.flags & !(HAS_RIG | HAS_INDEX) | if whole { HAS_RIG } else { 0 };
    let file = |flags: u8, index: Option<&[u8]>| {
        let mut out = assembled(flags, rig, &motion, index);
        out.extend_from_slice(parts.names);
        out
    };
    let plain = file(flags, None);
    let clip = Clip::with_rig(&plain, rig).context("the clip with its rig moved does not open")?;
    match spacing {
        None => Ok(plain),
        Some(spacing) => {
            let bytes = file(flags | HAS_INDEX, Some(&index::payload(clip, spacing)?));
            index::check(&bytes, rig)?;
            Ok(bytes)
        }
    }
}
