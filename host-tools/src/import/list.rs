//! The animations of files that may hold several.

use super::{fbx, gltf, vrml};
use anyhow::Result;
pub use gltf::Entry;
use std::path::Path;

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
