//! Clips made by the host tool, for tests that play them.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::build;

/// Converts a motion with the tool's own defaults into a clip in `folder`.
pub fn convert(motion: &Path, folder: &Path) -> Result<PathBuf> {
    let name = motion.file_stem().unwrap_or(motion.as_os_str());
    let clip = folder.join(name).with_extension("ptn");
    let output = Command::new(build::host_tool()?).arg("convert").arg(motion).arg("-o").arg(&clip).output();
    let output = output.context("cannot start the host tool")?;
    let words = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{}: {}", motion.display(), words.trim());
    Ok(clip)
}
