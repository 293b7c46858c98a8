//! Folders that a command makes for its outputs: those that are empty at its end go again.

use super::staged::remove_on_signals;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Folders that this process made, each behind the one that it is in.
static MADE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Makes the folder `path`, with those above it that are missing. [`remove_empty_folders`] removes them if nothing was written into them.
pub fn make_folder(path: &Path) -> Result<()> {
    remove_on_signals();
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let missing = path.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && folder.symlink_metadata().is_err());
    let mut missing: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
    missing.reverse();
    // Known first, so that those are removed which were made before an error.
    made.extend(missing);
    fs::create_dir_all(path).with_context(|| format!("{}: the folder cannot be made", path.display()))
}

/// Removes the folders that this process made and that are empty: what was to be written there failed.
pub fn remove_empty_folders() {
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    for folder in made.drain(..).rev() {
        // One that is not empty stays.
        let _ = fs::remove_dir(folder);
    }
}
