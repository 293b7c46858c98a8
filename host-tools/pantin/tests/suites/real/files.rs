//! Where the files of others are, if they are at hand.

use std::path::{Path, PathBuf};

/// The files of `$PANTIN_DATA`, or of `shared/data` beside the repository, with one of these extensions; says so where there is no folder.
pub fn files(extensions: &[&str]) -> Vec<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("PANTIN_DATA").map_or(beside, PathBuf::from);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: no files at {}; PANTIN_DATA names their folder", folder.display());
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|found| extensions.iter().any(|wanted| found == *wanted)));
    files.sort();
    files
}
