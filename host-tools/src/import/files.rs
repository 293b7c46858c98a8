//! Where importers read from: the machine's folders, or files handed over with their names.

use anyhow::{Context, Result, anyhow};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where a motion's files are.
#[derive(Clone, Debug, Default)]
pub enum Files {
    /// In folders.
    #[default]
    OnDisk,
    /// All that there are: a web page has no folders.
    Given(Arc<[(PathBuf, Vec<u8>)]>),
}

impl Files {
    /// The whole content of `path`.
    pub(super) fn read(&self, path: &Path) -> Result<Vec<u8>> {
        match self {
            Files::OnDisk => fs::read(path).map_err(|error| anyhow!("{}: {error}", path.display())),
            Files::Given(_) => Ok(self.given(path)?.to_vec()),
        }
    }

    /// Its first bytes, `most` at most.
    pub(super) fn head(&self, path: &Path, most: u64) -> Result<Vec<u8>> {
        let mut head = Vec::new();
        match self {
            Files::OnDisk => File::open(path).and_then(|file| file.take(most).read_to_end(&mut head)).map(drop),
            Files::Given(_) => self.given(path)?.take(most).read_to_end(&mut head).map(drop),
        }
        .with_context(|| path.display().to_string())?;
        Ok(head)
    }

    /// The files in a folder.
    pub(super) fn beside(&self, folder: &Path) -> Result<Vec<PathBuf>> {
        match self {
            Files::OnDisk => {
                let entries = fs::read_dir(folder).map_err(|error| anyhow!("{}: {error}", folder.display()))?;
                Ok(entries.flatten().map(|entry| entry.path()).collect())
            }
            Files::Given(files) => Ok(files.iter().map(|(path, _)| path.clone()).collect()),
        }
    }

    fn given(&self, path: &Path) -> Result<&[u8]> {
        let Files::Given(files) = self else { return Ok(&[]) };
        let found = files.iter().find(|(name, _)| name == path);
        found.map(|(_, bytes)| bytes.as_slice()).ok_or_else(|| anyhow!("{}: not among the files given", path.display()))
    }
}
