//! The animations of files that may hold several.

use super::{fbx, gltf, vrml};
use anyhow::Result;
use std::path::Path;

/// One animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Frames, as a conversion would make them.
    pub frames: usize,
    /// Frames a second.
    pub fps: f64,
    /// Tracks of nodes and weights.
    pub tracks: usize,
}

impl Entry {
    /// From the first frame to the last.
    pub fn seconds(&self) -> f64 {
        if self.frames == 0 { 0.0 } else { (self.frames - 1) as f64 / self.fps }
    }
}

/// Whether files of this extension hold animations to choose from.
pub fn chooses(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    matches!(extension.as_deref(), Some("glb" | "gltf" | "fbx" | "wrl" | "vrml" | "x3dv"))
}

/// All animations of the file `path`: of a glTF or FBX file, or the time sensors of a VRML world.
pub fn list(path: &Path, fps: Option<f64>) -> Result<Vec<Entry>> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("fbx") => fbx::list(path, fps),
        Some("wrl" | "vrml" | "x3dv") => vrml::list(path, fps),
        _ => gltf::list(path, fps),
    }
}
