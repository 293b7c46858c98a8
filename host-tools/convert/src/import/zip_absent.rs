//! Stands in for the importer of ZIP archives where it is not built in.

use super::animations::Entry;
use super::{Request, Source};
use anyhow::{Result, bail};
use std::path::Path;

/// Whether `head` begins a ZIP archive.
pub fn begins(head: &[u8]) -> bool {
    head.starts_with(b"PK\x03\x04")
}

/// Returns an error that says what to do instead.
pub fn read(path: &Path, _: &Request) -> Result<Source> {
    bail!("{}: this build does not read ZIP archives; unpack the archive", path.display())
}

/// Returns an error that says what to do instead.
pub fn list(path: &Path, options: &Request) -> Result<Vec<Entry>> {
    read(path, options).map(|_| Vec::new())
}
