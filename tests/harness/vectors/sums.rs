//! The SHA-256 of each golden vector, as `sha256sum --check` reads them.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::constants;
use crate::sha256;

/// The file's name.
pub const NAME: &str = "SHA256SUMS";

/// The file's text: all files of the folder but itself and the tables, which may get more entries.
pub fn text(folder: &Path) -> Result<String> {
    let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let name = |entry: std::io::Result<fs::DirEntry>| Ok(entry?.file_name().to_string_lossy().into_owned());
    let mut names = entries.map(name).collect::<Result<Vec<String>>>()?;
    names.retain(|name| name != NAME && name != constants::NAME);
    names.sort();
    names.iter().map(|name| Ok(sha256::line(&fs::read(folder.join(name)).with_context(|| name.clone())?, name))).collect()
}
