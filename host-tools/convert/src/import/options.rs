//! What a user says about a source.

use crate::memory::Memory;
use crate::motion::Up;
use std::path::PathBuf;

/// What a user says about a source. Without a setting, the source or a guess decides.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ImportOptions {
    /// Length of the source's unit in cm, instead of what the source states or of a guess. More than 0.
    pub cm_per_unit: Option<f64>,
    /// The direction that is vertical, instead of what the source says or of a guess.
    pub up: Option<Up>,
    /// Frames a second, for a source that does not say or says nonsense, and at which one with keys or times is sampled. A source of frames
    /// that states its rate keeps it: [`crate::edit::Edits::fps`] changes that.
    pub fps: Option<f64>,
    /// The skeleton of a motion that has its own in another file (AMC), instead of one found beside it.
    pub skeleton: Option<PathBuf>,
    /// Whether rotations on a glTF's CUBICSPLINE keys become the four curves of a quaternion, which convert without a fit, instead of Euler angles.
    pub quaternions: bool,
    /// Which animation of a file that holds several: its name, or its number from 0, instead of the first.
    pub animation: Option<String>,
    /// The memory that the motion may take; 1 GiB by default.
    pub memory: Memory,
}

impl ImportOptions {
    /// Nothing is said: the source decides, or a guess.
    pub fn new() -> ImportOptions {
        ImportOptions::default()
    }

    /// States the length of the source's unit in cm.
    pub fn cm_per_unit(self, cm: impl Into<Option<f64>>) -> ImportOptions {
        ImportOptions { cm_per_unit: cm.into(), ..self }
    }

    /// States the direction that is vertical.
    pub fn up(self, up: impl Into<Option<Up>>) -> ImportOptions {
        ImportOptions { up: up.into(), ..self }
    }

    /// States the frames a second.
    pub fn fps(self, fps: impl Into<Option<f64>>) -> ImportOptions {
        ImportOptions { fps: fps.into(), ..self }
    }

    /// Gives the skeleton's file.
    pub fn skeleton(self, skeleton: impl Into<PathBuf>) -> ImportOptions {
        ImportOptions { skeleton: Some(skeleton.into()), ..self }
    }

    /// Keeps rotations on CUBICSPLINE keys as quaternions.
    pub fn quaternions(self, quaternions: bool) -> ImportOptions {
        ImportOptions { quaternions, ..self }
    }

    /// Chooses an animation.
    pub fn animation(self, animation: impl Into<String>) -> ImportOptions {
        ImportOptions { animation: Some(animation.into()), ..self }
    }

    /// Limits the memory.
    pub fn memory(self, memory: Memory) -> ImportOptions {
        ImportOptions { memory, ..self }
    }
}
