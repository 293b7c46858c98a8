//! From a motion to a clip whose bound the device's own decoder has verified.

use crate::background;
use crate::error::exception;
use anyhow::{Context, Result, bail, ensure};
use pantin_tools::edit::resample::resample;
use pantin_tools::encode::{clip, rig};
use pantin_tools::fit::descent::Level;
use pantin_tools::fit::fit;
use pantin_tools::pose_bound::PoseBound;
use pantin_tools::import::{self, Imported, Options, up};
use pantin_tools::motion::Up;
use pantin_tools::{budget, errors, verify};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::Path;

/// The bounds of a clip, and how hard the encoder looks.
#[derive(Clone, Copy)]
pub struct Aim {
    max_cm: f64,
    scalar_part: f64,
    level: Level,
    /// Frames a second of the clip.
    fps: Option<f64>,
}

impl Aim {
    /// Checks what the user asks for.
    pub fn new(max_error_cm: f64, max_scalar_error: f64, effort: &str, fps: Option<f64>) -> Result<Aim> {
        let sound = |bound: f64| bound.is_finite() && bound > 0.0;
        ensure!(sound(max_error_cm), "max_error_cm={max_error_cm}: expected a number above 0");
        ensure!(sound(max_scalar_error), "max_scalar_error={max_scalar_error}: expected percent above 0");
        ensure!(fps.is_none_or(sound), "fps={}: expected a number above 0", fps.unwrap_or_default());
        let level = match effort {
            "fast" => Level::Fast,
            "default" => Level::Default,
            "best" => Level::Best,
            other => bail!("effort={other:?}: expected 'fast', 'default' or 'best'"),
        };
        Ok(Aim { max_cm: max_error_cm, scalar_part: max_scalar_error / 100.0, level, fps })
    }
}

/// The direction that is vertical, as text.
pub fn direction(text: &str) -> Result<Up> {
    up::parse(text).with_context(|| format!("up={text:?}: expected x, y, z, -x, -y or -z"))
}

/// A clip of `imported`, and its report as JSON. `read` is the number of bytes that the motion was read from.
pub fn code(imported: Imported, aim: Aim, read: u64, progress: &mut dyn FnMut(f64)) -> Result<(Vec<u8>, String)> {
    let Imported { mut motion, error_cm, units, warnings } = imported;
    ensure!(error_cm < 0.5 * aim.max_cm, "the motion is only known within {error_cm:e} cm, which is too much of the bound");
    // The bound is one against the file.
    let max_cm = aim.max_cm - error_cm;
    if let Some(fps) = aim.fps {
        motion = resample(&motion, fps)?;
    }
    let bound = PoseBound::shell(max_cm, verify::shell_radius_cm(&motion));
    let plan = aim.level.plan(bound);
    budget::check_fit(motion.frames, [motion.rig.joints.len(), motion.rig.channels()], plan.effort.beam, read)?;
    let figure = rig::encode(&motion.rig)?;
    let coded = fit(&motion, plan, aim.scalar_part, progress)?;
    let bytes = clip::encode(&coded, &figure, false)?;
    let report = verify::verify(&bytes, &figure, &motion, &bound, aim.scalar_part)?;
    let mut fields = errors::to_json(&report, &motion);
    for (name, value) in [("frames", json!(motion.frames)), ("bytes", json!(bytes.len())), ("units", json!(units))] {
        fields.insert(name.into(), value);
    }
    fields.insert("warnings".into(), json!(warnings));
    progress(1.0);
    Ok((bytes, Value::from(fields).to_string()))
}

/// Fails if the options of a conversion are wrong.
#[pyfunction]
pub fn check_options(
    py: Python<'_>,
    max_error_cm: f64,
    max_scalar_error: f64,
    effort: &str,
    fps: Option<f64>,
    up: Option<&str>,
) -> PyResult<()> {
    let aim = Aim::new(max_error_cm, max_scalar_error, effort, fps);
    aim.and_then(|_| up.map_or(Ok(()), |up| direction(up).map(drop))).map_err(|error| exception(py, &error, None))
}

/// Converts a motion file: the clip, and its report as JSON.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn convert(
    py: Python<'_>,
    path: &str,
    max_error_cm: f64,
    max_scalar_error: f64,
    effort: &str,
    fps: Option<f64>,
    cm_per_unit: Option<f64>,
    up: Option<&str>,
    animation: Option<String>,
    skeleton: Option<&str>,
    jobs: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<u8>, String)> {
    let fail = |error: anyhow::Error| exception(py, &error, Some(path));
    let aim = Aim::new(max_error_cm, max_scalar_error, effort, fps).map_err(fail)?;
    let up = up.map(direction).transpose().map_err(fail)?;
    let options = Options { cm_per_unit, up, fps, skeleton: skeleton.map(Into::into), animation, ..Options::default() };
    let made = background::run(py, jobs, progress.as_ref(), |progress| {
        let imported = import::load(Path::new(path), &options)?;
        let read = options.files.read_so_far();
        let read = read.iter().filter_map(|path| std::fs::metadata(path).ok()).map(|file| file.len()).sum();
        code(imported, aim, read, progress).with_context(|| path.to_owned())
    })?;
    made.map_err(fail)
}
