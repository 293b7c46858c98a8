//! The native half of the Python package `pantin`: functions of bytes. `python/pantin` makes classes and arrays of them.
//!
//! Arrays go in and out as bytes in the machine's order, which numpy reads without a library of its own on this side.

mod array;
mod background;
mod bank;
mod convert;
mod error;
mod export;
mod facts;
mod given;
mod image;
mod poses;
mod settings;
mod sources;
mod words;

use pyo3::pymodule;

/// The module `pantin._pantin`; its stubs are in `python/pantin/_pantin.pyi`.
#[pymodule]
mod _pantin {
    #[pymodule_export]
    use super::bank::{bank_clip, bank_names, bank_notes, pack, with_rig};
    #[pymodule_export]
    use super::convert::{check_options, convert};
    #[pymodule_export]
    use super::error::{BoundError, MemoryLimitError, PantinError, ReadError, SettingError, SourceError};
    #[pymodule_export]
    use super::export::{bvh, keys};
    #[pymodule_export]
    use super::facts::{channel_bytes, facts};
    #[pymodule_export]
    use super::given::convert_arrays;
    #[pymodule_export]
    use super::image::image;
    #[pymodule_export]
    use super::poses::{euler, places, positions, raw, rotations, scalars};
    #[pymodule_export]
    use super::sources::{companions, is_motion};
}
