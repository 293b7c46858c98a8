//! From a motion file to a clip: by the host tool's library, or by its program where that must read what is not built in here.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use harness::build;
use pantin_convert::import::{Disk, ImportOptions};
use pantin_convert::{Options, Recipe};
use serde_json::Value;

use crate::report::Clip;

/// Formats that this program reads itself.
const OWN: [&str; 2] = ["keys", "bvh"];

/// What the user says about errors and units.
#[derive(Default)]
pub struct Bounds {
    /// Largest error at any joint, as the host tool takes it.
    pub error: Option<String>,
    /// Largest error of channels that move no joint.
    pub scalar_percent: Option<f64>,
    /// Length of the file's unit.
    pub cm_per_unit: Option<f64>,
}

/// Converts a motion into a clip in `out`.
pub fn convert(motion: &Path, out: &Path, bounds: &Bounds) -> Result<Clip> {
    let name = motion.file_stem().unwrap_or(motion.as_os_str());
    let path = out.join(name).with_extension("ptn");
    let own = motion.extension().is_some_and(|extension| OWN.iter().any(|own| extension == *own));
    // The program reads bounds in every unit.
    let errors =
        if own && bounds.error.is_none() { by_library(motion, &path, bounds)? } else { by_program(motion, &path, bounds)? };
    Clip::new(path, &errors)
}

fn by_library(motion: &Path, path: &Path, bounds: &Bounds) -> Result<Value> {
    let import = ImportOptions::new().cm_per_unit(bounds.cm_per_unit);
    // The figure is drawn as lines between joints, so that their places are enough.
    let options = Options::new().places_only(true).max_scalar_error(bounds.scalar_percent);
    let recipe = Recipe::new().import(import).options(options);
    let converted = recipe.convert(&Disk::default(), motion, &mut |_| ())?;
    for note in &converted.notes {
        eprintln!("{}{note}", if note.is_warning() { "warning: " } else { "" });
    }
    std::fs::write(path, &converted.clip).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(converted.report.to_json(&converted.motion).into())
}

fn by_program(motion: &Path, path: &Path, bounds: &Bounds) -> Result<Value> {
    let tool: PathBuf = build::host_tool()?;
    let mut convert = Command::new(tool);
    convert.arg("convert").arg(motion).arg("-o").arg(path).args(["--places-only", "--segments", "--json"]);
    convert.args(bounds.error.iter().flat_map(|error| ["--max-error", error]));
    convert.args(bounds.scalar_percent.iter().flat_map(|error| ["--max-scalar-error".to_owned(), error.to_string()]));
    convert.args(bounds.cm_per_unit.iter().flat_map(|unit| ["--cm-per-unit".to_owned(), unit.to_string()]));
    let output = convert.stderr(Stdio::inherit()).output().context("cannot start the host tool")?;
    ensure!(output.status.success(), "pantin failed, see above");
    serde_json::from_slice(&output.stdout).context("`pantin convert --json` prints no JSON")
}
