//! A board's clip, replaced: as the image that is flashed beside the firmware, or sent over a line as `pantin_store::message` says.

pub mod image;
pub mod place;
mod send;
pub mod uf2;

pub use send::{Outcome, RetryPolicy, TransferError, send};

use anyhow::{Context, Result};
use pantin::Clip;
use pantin_store::ClipInfo;
use std::fs;
use std::path::Path;

/// Reads a clip for a board: one that holds its rig. It is called `name`, or else as its file.
pub fn read(path: &Path, name: Option<&str>) -> Result<(Vec<u8>, ClipInfo)> {
    let place = || path.display().to_string();
    let clip = fs::read(path).with_context(|| format!("{}: cannot be read", place()))?;
    let opened = Clip::new_checked(&clip);
    opened.with_context(|| format!("{}: a board cannot open it (a clip made with --rig-out has no rig in it)", place()))?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let info = ClipInfo::of(&clip, name.unwrap_or(&stem)).with_context(|| format!("{}: too long", place()))?;
    Ok((clip, info))
}
