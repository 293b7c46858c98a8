//! Clips made by the host tool, for tests that play them.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use pantin::Clip;
use pantin_face::MODEL;
use pantin_face::{Binding, Model};

use crate::build;
use crate::qemu::{LM3S6965EVB, Machine};

/// Returns the boards' feature that draws faces if any of the clips drives one, otherwise none.
pub fn feature(clips: &[&Path]) -> Result<&'static str> {
    let model = Model::new_checked(MODEL).map_err(|error| anyhow::anyhow!("{error}"))?;
    for path in clips {
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let clip = Clip::new_checked(&bytes).map_err(|error| anyhow::anyhow!("{}: {error}", path.display()))?;
        if Binding::new(&clip.rig(), &model).is_face() {
            return Ok("face");
        }
    }
    Ok("")
}

/// Returns the features with which a board plays these clips: `face` if one drives a face, and on the reference board the feature
/// for large rigs.
pub fn features(machine: Machine, clips: &[&Path]) -> Result<String> {
    let large = if machine.name == LM3S6965EVB.name { "large" } else { "" };
    Ok([large, feature(clips)?].into_iter().filter(|feature| !feature.is_empty()).collect::<Vec<_>>().join(","))
}

/// Converts a motion, whose joints are then drawn as lines, to a clip in `folder`: places alone are bounded, by the default.
pub fn convert(motion: &Path, folder: &Path) -> Result<PathBuf> {
    let name = motion.file_stem().unwrap_or(motion.as_os_str());
    let clip = folder.join(name).with_extension("ptn");
    let output = Command::new(build::host_tool()?).args(["convert", "--places-only"]).arg(motion).arg("-o").arg(&clip).output();
    let output = output.context("cannot start the host tool")?;
    let words = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{}: {}", motion.display(), words.trim());
    Ok(clip)
}
