//! The face: the head, its units after the paper's algorithms, and the model that devices play (docs/FACE.md).

pub mod action_units;
pub mod blueprint;
pub mod build;
pub mod cartoon;
pub mod cast;
pub mod compact;
pub mod compare;
pub mod draw;
pub mod error;
pub mod exact;
pub mod export;
mod extra;
mod faps;
pub mod fit;
pub mod head;
pub mod names;
pub mod onmesh;
pub mod outside;
pub mod points;
pub mod pose;
pub mod sheet;
mod skin;
pub mod small;
pub mod speak;
pub mod subject;

use anyhow::Result;
use blueprint::Blueprint;
use head::Head;
use pantin_face::Model;

/// Pantin's own face, and its model.
pub struct Face {
    /// The neutral head, with the names of its points.
    pub head: Head,
    /// The face in full precision.
    pub blueprint: Blueprint,
    /// The bytes of the model.
    pub bytes: Vec<u8>,
}

impl Face {
    /// Builds the face and encodes its model.
    pub fn new() -> Result<Face> {
        let head = Head::new();
        let blueprint = build::face(&head)?;
        let bytes = compact::encode(&blueprint)?;
        Ok(Face { head, blueprint, bytes })
    }

    /// Returns the model as the device reads it.
    pub fn model(&self) -> Result<Model<'_>> {
        Ok(Model::new_checked(&self.bytes)?)
    }
}
