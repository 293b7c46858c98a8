//! What stands for the FBX importer where it is not built in.

use super::animations::Entry;
use super::{Request, Source};
use anyhow::{Result, bail};
use std::path::Path;

/// Whether `head` begins an FBX file, binary or text.
pub fn begins(head: &[u8]) -> bool {
    head.starts_with(b"Kaydara FBX Binary") || head.starts_with(b"; FBX")
}

/// Says what to do instead.
pub fn read(path: &Path, _: &Request) -> Result<Source> {
    bail!("{}: this build does not read FBX; export the motion as glTF or BVH", path.display())
}

/// Says what to do instead.
pub fn list(path: &Path, options: &Request) -> Result<Vec<Entry>> {
    read(path, options).map(|_| Vec::new())
}
