//! From a motion file to a clip, by the library's one conversion.

use crate::background;
use crate::error::refused;
use crate::settings::Settings;
use crate::words;
use pantin_convert::import::Disk;
use pantin_convert::{Converted, Note, NoteKind};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::PathBuf;

/// The clip, its rig, and the report as JSON.
pub type Made = (Vec<u8>, Vec<u8>, String);

/// What Python gets of a conversion.
pub fn made(converted: Converted, settings: &Settings) -> Made {
    let Converted { clip, rig, motion, report, notes, .. } = converted;
    let mut fields = report.to_json(&motion);
    let unit = notes.iter().find(|note| note.kind == NoteKind::Unit && !note.is_warning()).map(|note| &note.text);
    let warnings: Vec<&String> = notes.iter().filter(|note| note.is_warning()).map(|note| &note.text).collect();
    let all: Vec<_> = notes.iter().map(|note: &Note| words::fields(note, settings)).collect();
    let more = [("bytes", json!(clip.len())), ("units", json!(unit)), ("warnings", json!(warnings)), ("notes", json!(all))];
    fields.extend(more.map(|(name, value)| (name.to_owned(), value)));
    (clip, rig, Value::from(fields).to_string())
}

/// Fails if the options of a conversion are wrong, whatever the motion.
#[pyfunction]
pub fn check_options(py: Python<'_>, settings: Settings) -> PyResult<()> {
    settings.recipe().map(drop).map_err(|error| refused(py, &error, None, &settings))
}

/// Converts a motion file.
#[pyfunction]
pub fn convert(py: Python<'_>, path: PathBuf, settings: Settings, jobs: usize, progress: Option<Py<PyAny>>) -> PyResult<Made> {
    let fail = |error| refused(py, &error, Some(&path), &settings);
    let recipe = settings.recipe().map_err(fail)?;
    let files = Disk::new(recipe.options.memory);
    let done = background::run(py, jobs, progress.as_ref(), |progress| recipe.convert(&files, &path, progress))?;
    Ok(made(done.map_err(fail)?, &settings))
}
