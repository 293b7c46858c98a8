//! Vectors from our own motions.

use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::Vector;
use crate::{build, paths};

/// Name, motion, bound.
const CLIPS: [(&str, &str, &str); 6] = [
    ("walk", "walk", "0.5cm"),
    ("walk-fine", "walk", "0.1cm"),
    ("walk-coarse", "walk", "3cm"),
    ("run", "run", "0.5cm"),
    ("run-fine", "run", "0.1cm"),
    ("run-coarse", "run", "3cm"),
];

/// Codes those that are `wanted` with the host tool.
pub fn vectors(wanted: impl Fn(&str) -> bool) -> Result<Vec<Vector>> {
    let tool = build::host_tool()?;
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let vector = |&(name, motion, bound): &(&str, &str, &str)| {
        let motion = paths::root().join("motions").join(motion).with_extension("keys");
        let clip = folder.path().join(name);
        let mut convert = Command::new(&tool);
        // The clips are drawn as lines between joints.
        convert.args(["convert", "--places-only"]).arg(&motion).arg("-o").arg(&clip).args(["--quiet", "--max-error", bound]);
        let output = convert.output().context("cannot start the host tool")?;
        ensure!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr).trim());
        Ok(Vector { name: name.into(), clip: std::fs::read(&clip)?, rig: None })
    };
    CLIPS.iter().filter(|(name, ..)| wanted(name)).map(vector).collect()
}
