//! All of a conversion from a file: how it is read, changed and coded.

use super::prepared::{Prepared, prepare};
use super::{Converted, Progress, convert};
use crate::edit::{Edited, Edits};
use crate::error::Error;
use crate::import::{self, Files, ImportOptions, Imported};
use crate::note::{Note, Remedy};
use crate::options::Options;
use std::path::Path;

/// How a file becomes a clip.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Recipe {
    /// How it is read.
    pub import: ImportOptions,
    /// How the motion is changed.
    pub edits: Edits,
    /// What the clip must keep.
    pub options: Options,
}

impl Recipe {
    /// A file as it is, with the default bounds.
    pub fn new() -> Recipe {
        Recipe::default()
    }

    /// Sets how the file is read.
    pub fn import(self, import: ImportOptions) -> Recipe {
        Recipe { import, ..self }
    }

    /// Sets how the motion is changed.
    pub fn edits(self, edits: Edits) -> Recipe {
        Recipe { edits, ..self }
    }

    /// Sets what the clip must keep.
    pub fn options(self, options: Options) -> Recipe {
        Recipe { options, ..self }
    }

    /// The motion `name` among `files` after all edits, and what is odd about it.
    pub fn edited(&self, files: &dyn Files, name: &Path) -> Result<Edited, Error> {
        let mut import = self.import.clone();
        import.quaternions |= self.options.keeps_quaternions();
        let imported = import::import(files, name, &import)?;
        self.edit(imported, files).map_err(|error| error.in_file(name))
    }

    /// The motion that was read, after all edits, and what is odd about it.
    fn edit(&self, imported: Imported, files: &dyn Files) -> Result<Edited, Error> {
        let mut notes = imported.notes;
        let edited = self.edits.apply(imported.motion, files)?;
        // Scales that an edit has left out need no advice, nor does a cut that opens a loop if the loop is closed again.
        let scales = edited.motion.rig.scalars.iter().any(|scalar| scalar.name.contains(".scale."));
        notes.retain(|note| scales || note.remedy != Some(Remedy::DropScales));
        let needed = |note: &Note| !(self.options.looped && note.remedy == Some(Remedy::MakeLoop));
        notes.extend(edited.notes.into_iter().filter(needed));
        Ok(Edited { motion: edited.motion, notes })
    }

    /// The motion ready for its clip, as [`prepare`] gives it, with all notes so far.
    pub fn prepare(&self, files: &dyn Files, name: &Path) -> Result<Prepared, Error> {
        let Edited { motion, mut notes } = self.edited(files, name)?;
        let mut prepared = prepare(motion, &self.options).map_err(|error| error.in_file(name))?;
        notes.append(&mut prepared.notes);
        prepared.notes = notes;
        Ok(prepared)
    }

    /// Converts the motion `name` among `files`.
    pub fn convert(&self, files: &dyn Files, name: &Path, progress: Progress<'_>) -> Result<Converted, Error> {
        let edited = self.edited(files, name)?;
        self.coded(edited, progress).map_err(|error| error.in_file(name))
    }

    /// Converts a motion that a program holds, such as one of [`crate::import::arrays`]. `files` has the files that edits read; how a motion is
    /// imported does not matter.
    pub fn convert_imported(&self, imported: Imported, files: &dyn Files, progress: Progress<'_>) -> Result<Converted, Error> {
        let edited = self.edit(imported, files)?;
        self.coded(edited, progress)
    }

    fn coded(&self, edited: Edited, progress: Progress<'_>) -> Result<Converted, Error> {
        let Edited { motion, mut notes } = edited;
        let mut converted = convert(&motion, &self.options, progress)?;
        notes.append(&mut converted.notes);
        converted.notes = notes;
        Ok(converted)
    }
}
