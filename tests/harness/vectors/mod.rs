//! Golden vectors: clips, each with what a decoder must make of it, in `tests/vectors`.

pub mod bank;
pub mod c_face;
pub mod c_figure;
pub mod c_header;
pub mod constants;
pub mod coverage;
pub mod faces;
mod json;
pub mod keyed;
pub mod orders;
pub mod own;
pub mod record;
pub mod sums;
pub mod synthetic;
pub mod turns;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use crate::paths;

/// A clip, and its rig if it stands apart.
pub struct Vector {
    /// Name of its files.
    pub name: String,
    /// The clip's file.
    pub clip: Vec<u8>,
    /// The rig's file.
    pub rig: Option<Vec<u8>>,
}

impl Vector {
    /// Opens the clip.
    pub fn open(&self) -> Result<pantin::Clip<'_>> {
        let clip = match &self.rig {
            Some(rig) => pantin::Clip::with_rig(&self.clip, rig),
            None => pantin::Clip::new_checked(&self.clip),
        };
        clip.with_context(|| format!("vector {}", self.name))
    }
}

/// Where they lie.
pub fn folder() -> PathBuf {
    paths::root().join("tests/vectors")
}

/// The committed ones, by name.
pub fn load(folder: &Path) -> Result<Vec<Vector>> {
    let read = |path: &Path| std::fs::read(path).with_context(|| path.display().to_string());
    let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut clips: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    clips.retain(|path| path.extension().is_some_and(|extension| extension == "ptn"));
    clips.sort();
    ensure!(!clips.is_empty(), "{}: no vectors; `cargo xtask vectors` makes them", folder.display());
    let vector = |path: PathBuf| {
        let rig = path.with_extension("rig");
        Ok(Vector {
            name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            clip: read(&path)?,
            rig: if rig.is_file() { Some(read(&rig)?) } else { None },
        })
    };
    clips.into_iter().map(vector).collect()
}
