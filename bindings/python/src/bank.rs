//! Banks: clips of one rig in one file.

use crate::error::exception;
use crate::words::fields_of_bank;
use anyhow::{Context, Result};
use pantin::Bank;
use pantin_convert::Memory;
use pantin_convert::bank::{self, CheckedRig, Named};
use pyo3::prelude::*;
use std::sync::Arc;

/// Names of the clips, in their order.
#[pyfunction]
pub fn bank_names(py: Python<'_>, bank: &[u8]) -> PyResult<Vec<String>> {
    let bank = Bank::new_checked(bank).map_err(|error| exception(py, &error.into(), None))?;
    Ok(bank.entries().map(|entry| entry.name().to_owned()).collect())
}

/// A clip of a bank, with the bank's rig.
#[pyfunction]
pub fn bank_clip(py: Python<'_>, bank: &[u8], name: &str) -> PyResult<Vec<u8>> {
    let clip = || -> Result<Vec<u8>> {
        let bank = Bank::new_checked(bank)?;
        let entry = bank.find(name).context("the bank has no clip of this name")?;
        bank::with_rig(entry.bytes(), &CheckedRig::of(&bank))
    };
    py.detach(clip).map_err(|error| exception(py, &error, None))
}

/// The bank of named clips, which have one rig.
#[pyfunction]
pub fn pack(py: Python<'_>, clips: Vec<(String, Vec<u8>)>) -> PyResult<Vec<u8>> {
    let packed = || -> Result<Vec<u8>> {
        let named = |(name, clip): (String, Vec<u8>)| -> Result<Named> {
            let rig: Arc<[u8]> = bank::rig_of(&clip)?.into();
            Ok(Named { place: format!("clip `{name}`"), name, clip, rig })
        };
        bank::encode(&clips.into_iter().map(named).collect::<Result<Vec<_>>>()?)
    };
    py.detach(packed).map_err(|error| exception(py, &error, None))
}

/// What is odd about a bank: its notes as JSON.
#[pyfunction]
pub fn bank_notes(py: Python<'_>, bank: &[u8]) -> PyResult<String> {
    let notes = || -> Result<String> {
        let note = bank::travel(&Bank::new_checked(bank)?, Memory::default())?;
        Ok(serde_json::to_string(&note.iter().map(fields_of_bank).collect::<Vec<_>>())?)
    };
    py.detach(notes).map_err(|error| exception(py, &error, None))
}

/// A clip's file with its rig in it; `rig` is that of a clip which has none.
#[pyfunction]
pub fn with_rig(py: Python<'_>, clip: &[u8], rig: &[u8]) -> PyResult<Vec<u8>> {
    let whole = || bank::with_rig(clip, &CheckedRig::new(rig)?);
    py.detach(whole).map_err(|error| exception(py, &error, None))
}
