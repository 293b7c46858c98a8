//! The clip that a board is to store, and its name there.

use crate::memory;
use crate::open::no_clip;
use crate::output::{clean, is_hostile, note};
use anyhow::{Context, Result, anyhow, ensure};
use pantin::codec::layout::BANK_MAGIC;
use pantin::{Bank, BankEntry, Clip, OpenError};
use pantin_convert::bank::{self, Named};
use pantin_convert::expand_keys::to_segments;
use pantin_pictures::machine::playback::has_machine;
use pantin_store::ClipInfo;
use pantin_store::header::NAME_BYTES;
use std::path::Path;
use std::sync::Arc;

/// Why a board gets no bank with key clips.
const NO_KEYS: &str =
    "the boards' images play it with feature `keys` alone; send it with --keys, or convert its motion with --segments";

/// Reads a name for a clip on a board: what fits its header, and what a screen can show.
pub fn board_name(text: &str) -> Result<String, String> {
    match text {
        "" => Err(format!("expected 1 to {NAME_BYTES} bytes")),
        _ if text.len() > NAME_BYTES => Err(format!("{} bytes, and a board keeps at most {NAME_BYTES}", text.len())),
        _ if text.chars().any(is_hostile) => Err("expected no control characters".into()),
        _ => Ok(text.into()),
    }
}

/// What a board gets, and under which name.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct Sent {
    /// The name that the board shows, 1 to 28 bytes without control characters [default: the file's name, as far as it fits]
    #[arg(long, value_parser = board_name)]
    pub name: Option<String>,
    /// Send a key clip as it is, for firmware that is built with feature `keys`. Without this option it becomes a clip of segments, which all
    /// firmware plays and which takes more bytes
    #[arg(long)]
    pub keys: bool,
}

/// Reads a clip for a board, one that holds its rig, or a bank. Without a name it is called as its file, as far as a board keeps that.
pub fn read(path: &Path, Sent { name, keys }: &Sent) -> Result<(Vec<u8>, ClipInfo)> {
    let name = name.as_deref();
    let place = || path.display().to_string();
    let mut clip = memory::read(path)?;
    if clip.starts_with(&BANK_MAGIC) {
        let bank = Bank::new_checked(&clip).with_context(place)?;
        for entry in bank.entries() {
            bank.open(&entry).with_context(|| format!("{}: `{}`", place(), clean(entry.name())))?;
        }
        if let Some(segments) = (!keys).then(|| bank_as_segments(path, &bank, &clip)).transpose()?.flatten() {
            clip = segments;
        }
        let bank = Bank::new_checked(&clip)?;
        note!("{}: a bank of {} clips, for firmware that is built with feature `bank`", place(), bank.len());
        if has_machine(&clip) {
            note!("warning: {}: the boards' firmware plays the clips one after the other, not the state machine", place());
        }
    } else {
        let opened = Clip::new_checked(&clip).map_err(|error| match error {
            OpenError::WrongRig => anyhow!("{}: a clip without its rig (--rig-out), which a board cannot open", place()),
            error => no_clip(path, &clip, error).context(format!("{}: a board cannot open it", place())),
        })?;
        if opened.has_keys() && !keys {
            clip = as_segments(path, &opened)?;
        }
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let shown: String = stem.chars().map(|c| if is_hostile(c) { '_' } else { c }).collect();
    let info = ClipInfo::of(&clip, name.unwrap_or(&shown)).with_context(|| format!("{}: too long", place()))?;
    if name.is_none() && info.name.as_str() != stem {
        note!("{}: the board shows it as `{}`; --name chooses another name", place(), info.name.as_str());
    }
    Ok((clip, info))
}

/// A bank whose key clips became clips of segments, with a note; `None` if it has none.
fn bank_as_segments(path: &Path, bank: &Bank<'_>, bytes: &[u8]) -> Result<Option<Vec<u8>>> {
    let place = || path.display().to_string();
    let mut any = false;
    let segments = |entry: BankEntry<'_>| {
        let opened = bank.open(&entry)?;
        any |= opened.has_keys();
        let clip = if opened.has_keys() { to_segments(&opened)? } else { entry.bytes().to_vec() };
        anyhow::Ok(Named { name: entry.name().into(), place: place(), clip, rig: Arc::from(bank.rig_bytes()) })
    };
    let clips: Vec<Named> = bank.entries().map(segments).collect::<Result<_>>().with_context(place)?;
    if !any {
        return Ok(None);
    }
    ensure!(!has_machine(bytes), "{}: a state machine with key clips; {NO_KEYS}", place());
    let segments = bank::encode(&clips).with_context(place)?;
    note!("{}: its key clips are sent as segments, the bank then has {} bytes", place(), segments.len());
    Ok(Some(segments))
}

/// A key clip as a clip of segments, with a note.
pub fn as_segments(path: &Path, clip: &Clip<'_>) -> Result<Vec<u8>> {
    let segments = to_segments(clip).with_context(|| path.display().to_string())?;
    note!("{}: a key clip, sent as segments, which take {} bytes", path.display(), segments.len());
    Ok(segments)
}
