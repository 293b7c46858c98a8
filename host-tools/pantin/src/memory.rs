//! The limit of this process's memory, `--max-memory`, and reads within it.

use anyhow::Result;
use pantin_convert::Memory;
use pantin_convert::import::{Disk, read_file};
use std::path::Path;
use std::sync::OnceLock;

static LIMIT: OnceLock<Memory> = OnceLock::new();

/// Sets the limit, once for the process.
pub fn set_limit(memory: Memory) {
    // Only `main` sets it, and only once.
    let _ = LIMIT.set(memory);
}

/// The limit.
pub fn limit() -> Memory {
    LIMIT.get().copied().unwrap_or_default()
}

/// The machine's folders, read within the limit.
pub fn disk() -> Disk {
    Disk::new(limit())
}

/// The whole content of `path` within the limit; `-` is standard input.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    read_file(path, limit())
}
