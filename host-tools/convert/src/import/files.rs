//! Where a motion's files are: the machine's folders, or memory.

use crate::error::Error;
use crate::memory::Memory;
use crate::{input, memory};
use anyhow::{Result, anyhow};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Gives importers the files of a motion, and those that a motion refers to: skeletons, buffers, faces and maps of names.
///
/// Names are paths, as the caller gives them and as files name each other, relative to the folder of the file that names them.
pub trait Files: Sync {
    /// The whole content of `path`.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// The first bytes of `path`, `most` at most.
    fn head(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        let mut bytes = self.read(path)?;
        bytes.truncate(most as usize);
        Ok(bytes)
    }

    /// The whole content of `path`, which another file names, not the user.
    fn read_named(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.read(path)
    }

    /// The files in a folder, in any order; empty where there are no folders.
    fn beside(&self, folder: &Path) -> io::Result<Vec<PathBuf>>;
}

/// The machine's folders. What was read is remembered, and pipes are read once.
#[derive(Clone, Debug, Default)]
pub struct Disk {
    memory: Memory,
    state: Arc<Mutex<State>>,
}

#[derive(Debug, Default)]
struct State {
    read: BTreeSet<PathBuf>,
    /// Contents of what can be read only once: pipes, and standard input.
    streams: HashMap<PathBuf, Arc<[u8]>>,
}

impl Disk {
    /// Folders from which no file larger than the limit is read.
    pub fn new(memory: Memory) -> Disk {
        Disk { memory, state: Arc::default() }
    }

    /// Every regular file that has been read.
    pub fn read_so_far(&self) -> Vec<PathBuf> {
        self.state().read.iter().cloned().collect()
    }

    fn state(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The content of a pipe, a device or standard input, which is read at its first use and kept; `None` for a regular file.
    fn stream(&self, path: &Path) -> io::Result<Option<Arc<[u8]>>> {
        if !input::is_stdin(path) && fs::metadata(path)?.is_file() {
            return Ok(None);
        }
        let mut state = self.state();
        if let Some(bytes) = state.streams.get(path) {
            return Ok(Some(bytes.clone()));
        }
        let bytes: Arc<[u8]> = input::content(path, self.memory)?.into();
        state.streams.insert(path.to_path_buf(), bytes.clone());
        Ok(Some(bytes))
    }
}

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        if let Some(bytes) = self.stream(path)? {
            return Ok(bytes.to_vec());
        }
        self.state().read.insert(path.to_path_buf());
        input::content(path, self.memory)
    }

    fn head(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        if let Some(bytes) = self.stream(path)? {
            return Ok(bytes[..bytes.len().min(most as usize)].to_vec());
        }
        let mut head = Vec::new();
        File::open(path)?.take(most).read_to_end(&mut head)?;
        Ok(head)
    }

    /// Reads a regular file only, links followed: nobody said that a pipe's or a device's bytes are wanted, and they may never come.
    fn read_named(&self, path: &Path) -> io::Result<Vec<u8>> {
        let found = fs::metadata(path)?;
        let kind = if found.is_dir() { "a directory" } else { "a pipe or a device" };
        if !found.is_file() {
            return Err(io::Error::other(Error::read(format!("{kind}; expected a regular file"))));
        }
        self.read(path)
    }

    fn beside(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        Ok(fs::read_dir(folder)?.flatten().map(|entry| entry.path()).collect())
    }
}

/// Files in memory, by their names. All of them lie in one folder: a page and an archive have no others.
#[derive(Clone, Debug, Default)]
pub struct InMemory(BTreeMap<PathBuf, Arc<[u8]>>);

impl InMemory {
    /// No files.
    pub fn new() -> InMemory {
        InMemory::default()
    }

    /// The same with another file; one of the same name is replaced.
    pub fn with(mut self, name: impl Into<PathBuf>, bytes: impl Into<Arc<[u8]>>) -> InMemory {
        self.0.insert(name.into(), bytes.into());
        self
    }
}

impl<P: Into<PathBuf>, B: Into<Arc<[u8]>>> FromIterator<(P, B)> for InMemory {
    fn from_iter<T: IntoIterator<Item = (P, B)>>(files: T) -> InMemory {
        InMemory(files.into_iter().map(|(name, bytes)| (name.into(), bytes.into())).collect())
    }
}

impl Files for InMemory {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let missing = || io::Error::other(Error::read("not among the files given"));
        self.0.get(path).map(|bytes| bytes.to_vec()).ok_or_else(missing)
    }

    fn beside(&self, _: &Path) -> io::Result<Vec<PathBuf>> {
        Ok(self.0.keys().cloned().collect())
    }
}

/// The typed cause of a failed read, or the reason of the operating system.
pub(crate) fn unreadable(path: &Path, error: io::Error) -> anyhow::Error {
    let typed = error.get_ref().and_then(|cause| cause.downcast_ref::<Error>()).cloned();
    match typed {
        Some(Error::Read(problem)) => anyhow::Error::new(Error::Read(problem)).context(path.display().to_string()),
        Some(typed) => anyhow::Error::new(typed).context(format!("{}: cannot be read", path.display())),
        None => Error::read(format!("cannot be read: {error}")).context_of(path),
    }
}

impl Error {
    fn context_of(self, path: &Path) -> anyhow::Error {
        anyhow!(self).context(path.display().to_string())
    }
}

/// The content of `path` among `files`.
pub fn read_from(files: &dyn Files, path: &Path) -> Result<Vec<u8>> {
    files.read(path).map_err(|error| unreadable(path, error))
}

/// The content of `path` from the machine's folders within a limit; `-` is standard input.
pub fn read(path: &Path, limit: memory::Memory) -> Result<Vec<u8>> {
    input::content(path, limit).map_err(|error| unreadable(path, error))
}
