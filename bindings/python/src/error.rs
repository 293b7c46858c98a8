//! Errors as Python's exceptions, with the file and the line that the message begins with.

use crate::settings::Settings;
use crate::words;
use pantin_convert::Error;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::path::Path;

pyo3::create_exception!(
    pantin,
    PantinError,
    PyValueError,
    "What is wrong with a motion, a clip or a bank.\n\nAttributes: `path` (the file, or None), `line` (its line from 1, or None), `place` (the file, line, joint or frame as text, or \
     None), `setting` (the keyword argument that is refused, or None) and `remedy` (what would help, as `state-frame-rate`, or None)."
);
pyo3::create_exception!(pantin, ReadError, PantinError, "A file that a motion needs cannot be read.");
pyo3::create_exception!(
    pantin,
    SourceError,
    PantinError,
    "A motion is damaged, of an unknown format, or has what a clip cannot hold."
);
pyo3::create_exception!(
    pantin,
    SettingError,
    PantinError,
    "A keyword argument is out of range, or does not fit the motion; `setting` names it."
);
pyo3::create_exception!(pantin, MemoryLimitError, PantinError, "A motion takes more memory than the limit, which `memory` sets.");
pyo3::create_exception!(pantin, BoundError, PantinError, "No clip within the bound was found.");

/// The attributes of an exception.
#[derive(Default)]
struct Attributes<'a> {
    path: Option<&'a str>,
    line: Option<u64>,
    place: Option<&'a str>,
    setting: Option<&'a str>,
    remedy: Option<&'a str>,
}

/// The exception for an error of a clip or a bank, or of anything that is no conversion.
pub fn exception(py: Python<'_>, error: &anyhow::Error, path: Option<&str>) -> PyErr {
    let message = format!("{error:#}");
    let (file, line) = place(&message);
    let path = if line.is_some() { Some(file) } else { path };
    with(py, PantinError::new_err(message.clone()), &Attributes { path, line, ..Attributes::default() })
}

/// The exception for a conversion of the file `path` that failed.
pub fn refused(py: Python<'_>, error: &Error, path: Option<&Path>, settings: &Settings) -> PyErr {
    let message = words::message(error, Some(settings));
    let exception = match error {
        Error::Read(_) => ReadError::new_err(message.clone()),
        Error::Source(_) => SourceError::new_err(message.clone()),
        Error::Setting(..) => SettingError::new_err(message.clone()),
        Error::Memory(_) => MemoryLimitError::new_err(message.clone()),
        Error::Bound(_) => BoundError::new_err(message.clone()),
        _ => PantinError::new_err(message.clone()),
    };
    let (file, line) = place(&message);
    let given = path.map(|path| path.to_string_lossy());
    let whole = &error.problem().place;
    let with_line = message.split_once(": ").map(|(before, _)| before).filter(|_| line.is_some());
    let attributes = Attributes {
        path: if line.is_some() { Some(file) } else { given.as_deref() },
        line,
        place: if whole.is_empty() { with_line } else { Some(whole) },
        setting: error.refused().map(|setting| settings.keyword(setting)),
        remedy: error.problem().remedy.map(|remedy| remedy.name()),
    };
    with(py, exception, &attributes)
}

/// The exception with its attributes.
fn with(py: Python<'_>, exception: PyErr, attributes: &Attributes<'_>) -> PyErr {
    let value = exception.value(py);
    let set = || -> PyResult<()> {
        value.setattr("path", attributes.path)?;
        value.setattr("line", attributes.line)?;
        value.setattr("place", attributes.place)?;
        value.setattr("setting", attributes.setting)?;
        value.setattr("remedy", attributes.remedy)
    };
    match set() {
        Ok(()) => exception,
        Err(other) => other,
    }
}

/// `file:line: message` begins with a file and a line.
fn place(message: &str) -> (&str, Option<u64>) {
    let before = message.split_once(": ").map_or("", |(before, _)| before);
    match before.rsplit_once(':') {
        Some((file, line)) if !file.is_empty() => (file, line.parse().ok()),
        _ => (before, None),
    }
}
