//! Stands in for the glTF importer where it is not built in.

use super::animations::Entry;
use super::{Request, Source};
use anyhow::{Result, bail};
use std::path::{Path, PathBuf};

/// Whether `head` begins a glTF file in its binary form.
pub fn begins(head: &[u8]) -> bool {
    head.starts_with(b"glTF")
}

/// Returns an error that says how to build with glTF.
pub fn read(path: &Path, _: &Request) -> Result<Source> {
    bail!("{}: this pantin is built without glTF; build it with `--features gltf`", path.display())
}

/// Returns an error that says how to build with glTF.
pub fn list(path: &Path, options: &Request) -> Result<Vec<Entry>> {
    read(path, options).map(|_| Vec::new())
}

/// None.
pub(super) fn buffers(_: &Path, _: &Request) -> Result<Vec<PathBuf>> {
    Ok(Vec::new())
}
