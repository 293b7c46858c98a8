//! Which files are motions, and which other files they are read with.

use pantin_convert::import::{self, Disk};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Whether a file's name says that `convert` knows its format.
#[pyfunction]
pub fn is_motion(path: PathBuf) -> bool {
    import::is_motion(&path)
}

/// The files that a motion is read with: the skeletons beside an .amc, the buffers of a glTF file.
#[pyfunction]
pub fn companions(py: Python<'_>, path: PathBuf) -> Vec<PathBuf> {
    py.detach(|| import::companions(&Disk::default(), &path))
}
