//! One import: the options, and the files, whose bytes are counted.

use super::ImportOptions;
use super::files::{Files, unreadable};
use anyhow::Result;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// What an importer gets.
pub struct Request<'a> {
    options: &'a ImportOptions,
    files: &'a dyn Files,
    bytes: AtomicU64,
}

impl Deref for Request<'_> {
    type Target = ImportOptions;

    fn deref(&self) -> &ImportOptions {
        self.options
    }
}

impl<'a> Request<'a> {
    pub(super) fn new(files: &'a dyn Files, options: &'a ImportOptions) -> Request<'a> {
        Request { options, files, bytes: AtomicU64::new(0) }
    }

    /// The whole content of `path`.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>> {
        self.counted(self.files.read(path), path)
    }

    /// The whole content of `path`, which another file names.
    pub fn read_named(&self, path: &Path) -> Result<Vec<u8>> {
        self.counted(self.files.read_named(path), path)
    }

    /// The first bytes of `path`, `most` at most.
    pub(super) fn head(&self, path: &Path, most: u64) -> Result<Vec<u8>> {
        self.files.head(path, most).map_err(|error| unreadable(path, error))
    }

    /// The files in a folder.
    pub(super) fn beside(&self, folder: &Path) -> Result<Vec<PathBuf>> {
        self.files.beside(folder).map_err(|error| unreadable(folder, error))
    }

    /// Where the motion's files are.
    #[cfg(feature = "zip")]
    pub(super) fn files(&self) -> &'a dyn Files {
        self.files
    }

    /// Bytes of all files that were read so far.
    pub(super) fn bytes_read(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    fn counted(&self, read: std::io::Result<Vec<u8>>, path: &Path) -> Result<Vec<u8>> {
        let bytes = read.map_err(|error| unreadable(path, error))?;
        self.bytes.fetch_add(bytes.len() as u64, Ordering::Relaxed);
        Ok(bytes)
    }
}
