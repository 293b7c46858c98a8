//! One file a command; its arguments' doc comment is the manual.

mod batch;
mod channel_bound;
pub mod convert;
mod edits;
pub mod expand;
pub mod face;
pub mod flash_image;
pub mod info;
mod max_error;
pub mod play;
pub mod render;
pub mod serve;
pub mod stream;
mod stream_live;
pub mod train;
pub mod update;

use anyhow::{Context, Result};
use std::fs;
use std::path::Path;

/// Writes a whole file or none: beside it first, then in its place.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    let beside = Path::new(&beside);
    let written = fs::write(beside, bytes).and_then(|()| fs::rename(beside, path));
    if written.is_err() {
        // What is left of it is of no use to anyone; that it may not exist is no further error.
        let _ = fs::remove_file(beside);
    }
    written.with_context(|| format!("{}: cannot be written", path.display()))
}

/// A clip and, if it was made without one, its rig.
pub struct Files {
    clip: Vec<u8>,
    rig: Vec<u8>,
}

impl Files {
    /// Reads both.
    pub fn read(clip: &Path, rig: Option<&Path>) -> Result<Files> {
        let read = |path: &Path| fs::read(path).with_context(|| format!("{}: cannot be read", path.display()));
        Ok(Files { clip: read(clip)?, rig: rig.map(read).transpose()?.unwrap_or_default() })
    }

    /// Opens the clip.
    pub fn open(&self) -> Result<pantin::Clip<'_>> {
        let opened = pantin::Clip::with_rig(&self.clip, &self.rig);
        Ok(if self.rig.is_empty() { pantin::Clip::new_checked(&self.clip) } else { opened }?)
    }

    /// The clip's bytes.
    pub fn clip(&self) -> &[u8] {
        &self.clip
    }

    /// Length of the clip's file.
    pub fn clip_len(&self) -> usize {
        self.clip.len()
    }
}
