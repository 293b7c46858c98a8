//! What the repository holds as files: what a reader sees first, nothing large, nothing twice.

use std::collections::BTreeMap;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::paths;

/// Everything in the root.
pub const ROOT: [&str; 27] = [
    ".cargo",
    ".ci",
    ".editorconfig",
    ".gitattributes",
    ".github",
    ".gitignore",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "SECURITY.md",
    "bindings",
    "decoder",
    "docs",
    "examples",
    "firmware",
    "fuzz",
    "host-tools",
    "memory.x",
    "motions",
    "rustfmt.toml",
    "tests",
    "web",
    "xtask",
];

/// Most bytes of a file.
pub const MOST_BYTES: u64 = 200_000;

/// Folders whose files may be larger: seeds of fuzzing, and pictures of the documents.
const LARGE: [&str; 2] = ["fuzz/", "docs/pictures/"];

/// Files that may stand twice: what is copied with a folder, what a linker looks for beside a program, seeds and golden vectors, and
/// clips that the tests of a published package need.
const TWICE: [&str; 6] = ["LICENSE-", "memory.x", "fuzz/", "tests/vectors/", "tests/key-vectors/", "decoder/tests/"];

/// The files that git keeps, from the root; `None` where this is no checkout of git.
pub fn files() -> Result<Option<Vec<String>>> {
    if !paths::root().join(".git").exists() {
        return Ok(None);
    }
    let mut git = Command::new("git");
    git.args(["ls-files", "-z"]).current_dir(paths::root());
    let output = git.output().context("cannot start git")?;
    ensure!(output.status.success(), "git ls-files: {}", String::from_utf8_lossy(&output.stderr).trim());
    let listed = String::from_utf8(output.stdout).context("a name that is not UTF-8")?;
    let there = |file: &&str| !file.is_empty() && paths::root().join(file).is_file();
    Ok(Some(listed.split('\0').filter(there).map(String::from).collect()))
}

/// Entries of the root that are not listed.
pub fn strangers(files: &[String]) -> Vec<&str> {
    let mut found: Vec<&str> = files.iter().filter_map(|file| file.split('/').next()).collect();
    found.sort_unstable();
    found.dedup();
    found.retain(|entry| !ROOT.contains(entry));
    found
}

/// Files that are too large, with their bytes.
pub fn large(files: &[String]) -> Result<Vec<(&str, u64)>> {
    let mut found = Vec::new();
    for file in files.iter().filter(|file| !LARGE.iter().any(|folder| file.starts_with(folder))) {
        let bytes = std::fs::metadata(paths::root().join(file)).with_context(|| file.clone())?.len();
        if bytes > MOST_BYTES {
            found.push((file.as_str(), bytes));
        }
    }
    Ok(found)
}

/// Files of equal bytes that should stand once.
pub fn twice(files: &[String]) -> Result<Vec<Vec<&str>>> {
    let mut by_bytes: BTreeMap<Vec<u8>, Vec<&str>> = BTreeMap::new();
    for file in files.iter().filter(|file| !TWICE.iter().any(|may| file.starts_with(may) || name(file).starts_with(may))) {
        let bytes = std::fs::read(paths::root().join(file)).with_context(|| file.clone())?;
        if !bytes.is_empty() {
            by_bytes.entry(bytes).or_default().push(file);
        }
    }
    Ok(by_bytes.into_values().filter(|files| files.len() > 1).collect())
}

fn name(file: &str) -> &str {
    file.rsplit('/').next().unwrap_or(file)
}
