//! A clip as a file for other programs.

use crate::error::exception;
use crate::facts::open;
use anyhow::Result;
use pantin_convert::expand::Expanded;
use pantin_convert::expand_keys;
use pantin_convert::export::bvh::{Columns, write};
use pyo3::prelude::*;

/// The clip as a BVH file, with three rotations a joint, as most readers demand.
#[pyfunction]
pub fn bvh(py: Python<'_>, clip: &[u8]) -> PyResult<Vec<u8>> {
    let written = || -> Result<Vec<u8>> {
        let mut out = Vec::new();
        write(&Expanded::new(&open(clip)?), Columns::ThreeRotations, &mut out)?;
        Ok(out)
    };
    py.detach(written).map_err(|error| exception(py, &error, None))
}

/// The keys of a key clip as text (docs/KEYFRAMES.md).
#[pyfunction]
pub fn keys(py: Python<'_>, clip: &[u8]) -> PyResult<Vec<u8>> {
    let written = || open(clip).and_then(|clip| expand_keys::write(&clip));
    py.detach(written).map(String::into_bytes).map_err(|error| exception(py, &error, None))
}
