//! Errors as Python's exceptions, with the file and the line that the message begins with.

use anyhow::Error;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

pyo3::create_exception!(
    pantin,
    PantinError,
    PyValueError,
    "What is wrong with a motion, a clip or a bank.\n\nAttributes: `path` (the file, or None) and `line` (its line from 1, or None)."
);

/// The exception for an error that concerns the file `path`.
pub fn exception(py: Python<'_>, error: &Error, path: Option<&str>) -> PyErr {
    let message = format!("{error:#}");
    let (place, line) = place(&message);
    let path = if line.is_some() { Some(place) } else { path };
    let exception = PantinError::new_err(message.clone());
    let value = exception.value(py);
    match value.setattr("path", path).and_then(|()| value.setattr("line", line)) {
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
