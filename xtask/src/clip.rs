//! The clip that a demonstration's firmware is built with.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::paths;

/// Copies a clip to where the firmware is built with it, and returns that place. A copy that is there already stays as it is: a
/// firmware that was built with it is up to date.
pub fn firmware_copy(clip: &Path) -> Result<PathBuf> {
    let folder = paths::root().join("target/xtask");
    let copy = folder.join(clip.file_name().unwrap_or_default());
    let bytes = std::fs::read(clip).with_context(|| format!("cannot read {}", clip.display()))?;
    if std::fs::read(&copy).is_ok_and(|there| there == bytes) {
        return Ok(copy);
    }
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    std::fs::write(&copy, bytes).with_context(|| format!("cannot write {}", copy.display()))?;
    Ok(copy)
}
