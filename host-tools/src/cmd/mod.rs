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
mod same_form;
pub mod serve;
pub mod stream;
mod stream_live;
pub mod train;
pub mod update;

use crate::import;
use anyhow::Result;
use std::path::Path;

/// A clip and, if it was made without one, its rig.
pub struct Files {
    clip: Vec<u8>,
    rig: Vec<u8>,
}

impl Files {
    /// Reads both; `-` is standard input.
    pub fn read(clip: &Path, rig: Option<&Path>) -> Result<Files> {
        let files = import::Files::default();
        let read = |path: &Path| files.read(path);
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
