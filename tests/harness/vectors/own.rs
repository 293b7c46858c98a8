//! Vectors from our own motions.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::{Vector, orders};
use crate::{build, paths};

/// A clip that the host tool makes of a motion.
struct Own {
    name: &'static str,
    motion: &'static str,
    arguments: &'static [&'static str],
    /// Whether every joint that turns first gets three Euler angles, in each of the six orders in turn.
    in_orders: bool,
}

const fn turning(name: &'static str, motion: &'static str, arguments: &'static [&'static str]) -> Own {
    Own { name, motion, arguments, in_orders: false }
}

const fn in_orders(name: &'static str, motion: &'static str, arguments: &'static [&'static str]) -> Own {
    Own { name, motion, arguments, in_orders: true }
}

/// The first six are drawn as lines between joints. The others have joints in every form, for the rotations of `turn-sums.txt`.
const CLIPS: [Own; 10] = [
    turning("walk", "walk", &["--places-only", "--max-error", "0.5cm"]),
    turning("walk-fine", "walk", &["--places-only", "--max-error", "0.1cm"]),
    turning("walk-coarse", "walk", &["--places-only", "--max-error", "3cm"]),
    turning("run", "run", &["--places-only", "--max-error", "0.5cm"]),
    turning("run-fine", "run", &["--places-only", "--max-error", "0.1cm"]),
    turning("run-coarse", "run", &["--places-only", "--max-error", "3cm"]),
    turning("own-map", "library/dance", &["--rotations", "exponential", "--max-error", "0.2cm", "--to", "31"]),
    turning("own-quaternion", "library/dance", &["--rotations", "quaternion", "--max-error", "0.2cm", "--to", "31"]),
    in_orders("own-orders", "library/dance", &["--rotations", "euler", "--max-error", "0.2cm", "--to", "31"]),
    in_orders("own-mixed", "kneebend", &["--rotations", "by-cost", "--max-error", "0.2cm", "--fps", "30", "--to", "31"]),
];

/// Codes those that are `wanted` with the host tool.
pub fn vectors(wanted: impl Fn(&str) -> bool) -> Result<Vec<Vector>> {
    let tool = build::host_tool()?;
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let vector = |own: &Own| {
        let mut motion = paths::root().join("motions").join(own.motion).with_extension("keys");
        if own.in_orders {
            motion = reordered(&tool, &motion, folder.path())?;
        }
        let clip = folder.path().join(own.name);
        convert(&tool, &motion, &clip, own.arguments).with_context(|| own.name)?;
        Ok(Vector { name: own.name.into(), clip: std::fs::read(&clip)?, rig: None })
    };
    CLIPS.iter().filter(|own| wanted(own.name)).map(vector).collect()
}

/// Converts a motion with the host tool.
pub fn convert(tool: &Path, motion: &Path, clip: &Path, arguments: &[&str]) -> Result<()> {
    let mut convert = Command::new(tool);
    convert.arg("convert").arg(motion).arg("-o").arg(clip).args(["--segments", "--quiet"]).args(arguments);
    let output = convert.output().context("cannot start the host tool")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
    Ok(())
}

/// The motion as a BVH file, whose joints have Euler angles in all orders.
fn reordered(tool: &Path, motion: &Path, folder: &Path) -> Result<PathBuf> {
    let [clip, bvh] = ["fine.ptn", "fine.bvh"].map(|name| folder.join(name));
    convert(tool, motion, &clip, &["--rotations", "euler", "--max-error", "0.1cm"])?;
    let mut expand = Command::new(tool);
    expand.arg("expand").arg(&clip).arg("-o").arg(&bvh).arg("--quiet");
    let output = expand.output().context("cannot start the host tool")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
    let text = orders::in_turn(&std::fs::read_to_string(&bvh)?, &std::fs::read(&clip)?)?;
    std::fs::write(&bvh, text)?;
    Ok(bvh)
}
