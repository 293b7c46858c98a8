//! What can be wrong with a model's bytes, and with a name.

use crate::format::VERSION;

/// The reason why bytes are not a usable model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModelError {
    /// The bytes end before the model does.
    Truncated,
    /// The model has a version that this crate cannot read.
    UnsupportedVersion(u8),
    /// The bytes contradict themselves: an index, a count or a flag is out of range.
    Malformed,
    /// The model has more vertices than the `N` of a [`Morph`](crate::Morph).
    TooManyVertices {
        /// Number of vertices of the model.
        needed: usize,
        /// The `N` that was given.
        given: usize,
    },
}

impl core::fmt::Display for ModelError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            ModelError::Truncated => write!(f, "the face model is truncated"),
            ModelError::UnsupportedVersion(version) => {
                write!(f, "the face model has version {version}; only version {VERSION} is supported")
            }
            ModelError::Malformed => write!(f, "the face model is malformed"),
            ModelError::TooManyVertices { needed, given } => {
                write!(f, "the face model has {needed} vertices; there is space for {given}")
            }
        }
    }
}

impl core::error::Error for ModelError {}

/// The model has no name like the one that was given. [`NAMES`](crate::NAMES) lists those of Pantin's own face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnknownName;

impl core::fmt::Display for UnknownName {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "the face model has no such name")
    }
}

impl core::error::Error for UnknownName {}
