//! Where importers read from: the machine's folders, or files handed over with their names.

use crate::input;
use anyhow::{Context, Result, anyhow, ensure};
use std::collections::{BTreeSet, HashMap};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Where a motion's files are.
#[derive(Clone, Debug)]
pub enum Files {
    /// In folders.
    OnDisk(Disk),
    /// All that there are: a web page has no folders.
    Given(Arc<[(PathBuf, Vec<u8>)]>),
}

impl Default for Files {
    fn default() -> Self {
        Files::OnDisk(Disk::default())
    }
}

/// The machine's folders, and what has been read from them.
#[derive(Clone, Debug, Default)]
pub struct Disk(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    read: BTreeSet<PathBuf>,
    /// Contents of what can be read only once: pipes, and standard input.
    streams: HashMap<PathBuf, Arc<[u8]>>,
}

impl Disk {
    /// Every file that has been read.
    pub fn read(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).read.iter().cloned().collect()
    }

    fn whole(&self, path: &Path) -> Result<Vec<u8>> {
        if let Some(bytes) = self.stream(path)? {
            return Ok(bytes.to_vec());
        }
        self.0.lock().unwrap_or_else(PoisonError::into_inner).read.insert(path.to_path_buf());
        input::content(path)
    }

    fn head(&self, path: &Path, most: u64) -> Result<Vec<u8>> {
        if let Some(bytes) = self.stream(path)? {
            return Ok(bytes[..bytes.len().min(most as usize)].to_vec());
        }
        let mut head = Vec::new();
        File::open(path)?.take(most).read_to_end(&mut head)?;
        Ok(head)
    }

    /// The content of a pipe, a device or standard input, which is read at its first use and kept; `None` for a regular file.
    fn stream(&self, path: &Path) -> Result<Option<Arc<[u8]>>> {
        if !input::is_stdin(path) && fs::metadata(path)?.is_file() {
            return Ok(None);
        }
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(bytes) = state.streams.get(path) {
            return Ok(Some(bytes.clone()));
        }
        let bytes: Arc<[u8]> = input::content(path)?.into();
        state.streams.insert(path.to_path_buf(), bytes.clone());
        Ok(Some(bytes))
    }
}

impl Files {
    /// The whole content of `path`.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>> {
        match self {
            Files::OnDisk(disk) => disk.whole(path).map_err(|error| anyhow!("{}: cannot be read: {error:#}", path.display())),
            Files::Given(_) => Ok(self.given(path)?.to_vec()),
        }
    }

    /// The whole content of `path`, which another file names. Only a regular file is read, links followed: nobody said that a pipe's
    /// or a device's bytes are wanted, and they may never come.
    pub(crate) fn read_named(&self, path: &Path) -> Result<Vec<u8>> {
        if let Files::OnDisk(_) = self {
            let found = fs::metadata(path).map_err(|error| anyhow!("{}: cannot be read: {error}", path.display()))?;
            let kind = if found.is_dir() { "a directory" } else { "a pipe or a device" };
            ensure!(found.is_file(), "{}: {kind}; expected a regular file", path.display());
        }
        self.read(path)
    }

    /// Its first bytes, `most` at most.
    pub(super) fn head(&self, path: &Path, most: u64) -> Result<Vec<u8>> {
        match self {
            Files::OnDisk(disk) => disk.head(path, most).with_context(|| path.display().to_string()),
            Files::Given(_) => {
                let mut head = Vec::new();
                self.given(path)?.take(most).read_to_end(&mut head)?;
                Ok(head)
            }
        }
    }

    /// The files in a folder.
    pub(super) fn beside(&self, folder: &Path) -> Result<Vec<PathBuf>> {
        match self {
            Files::OnDisk(_) => {
                let entries = fs::read_dir(folder).map_err(|error| anyhow!("{}: {error}", folder.display()))?;
                Ok(entries.flatten().map(|entry| entry.path()).collect())
            }
            Files::Given(files) => Ok(files.iter().map(|(path, _)| path.clone()).collect()),
        }
    }

    /// Every file that has been read from the machine's folders.
    pub fn read_so_far(&self) -> Vec<PathBuf> {
        match self {
            Files::OnDisk(disk) => disk.read(),
            Files::Given(_) => Vec::new(),
        }
    }

    fn given(&self, path: &Path) -> Result<&[u8]> {
        let Files::Given(files) = self else { return Ok(&[]) };
        let found = files.iter().find(|(name, _)| name == path);
        found.map(|(_, bytes)| bytes.as_slice()).ok_or_else(|| anyhow!("{}: not among the files given", path.display()))
    }
}
