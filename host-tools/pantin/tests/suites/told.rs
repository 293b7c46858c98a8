//! Imports as the command line reports them: notes and errors as its sentences.

use pantin_convert::import::{Disk, ImportOptions, Imported, InMemory, import};
use pantin_convert::motion::{Motion, Origin};
use pantin_convert::{Error, NoteKind};
use pantin_tools::words;
use std::path::Path;

/// An imported motion, and what the command line says about it.
#[derive(Debug)]
pub struct Told {
    pub motion: Motion,
    /// The sentence about the unit of length.
    pub units: String,
    /// All other sentences.
    pub warnings: Vec<String>,
    pub error_cm: f64,
}

/// An error of the library in the command line's words.
pub fn said(error: &anyhow::Error) -> String {
    words::explanation(error)
}

/// Imports the file `path`.
pub fn load(path: &Path, options: &ImportOptions) -> anyhow::Result<Told> {
    told(import(&Disk::new(options.memory), path, options))
}

/// Imports the file `name` among `files`.
pub fn load_given(files: &InMemory, name: &str) -> anyhow::Result<Told> {
    told(import(files, name.as_ref(), &ImportOptions::new()))
}

fn told(imported: Result<Imported, Error>) -> anyhow::Result<Told> {
    let imported = imported.map_err(|error| anyhow::Error::msg(words::explanation(&anyhow::Error::new(error))))?;
    let (units, others): (Vec<_>, Vec<_>) =
        imported.notes.iter().partition(|note| note.kind == NoteKind::Unit && !note.is_warning());
    let error_cm = imported.motion.origin.error_cm;
    // Motions are compared whatever they were read from.
    let motion = Motion { origin: Origin::default(), ..imported.motion };
    let sentences = |notes: Vec<_>| notes.into_iter().map(words::sentence).collect::<Vec<String>>();
    Ok(Told { units: sentences(units).join("; "), warnings: sentences(others), error_cm, motion })
}
