//! The animations of files that may hold several.

use super::{Files, Options, fbx, gltf, vrml};
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

/// The animation that the user names among those called `names`: by its name, in any case of letters if none is the same exactly, or by
/// its number from 0.
pub(super) fn choose<'n>(wanted: &str, names: impl Iterator<Item = Option<&'n str>> + Clone) -> Option<usize> {
    let exact = || names.clone().position(|name| name == Some(wanted));
    let folded = || names.clone().position(|name| name.is_some_and(|name| name.to_lowercase() == wanted.to_lowercase()));
    let number = || wanted.parse().ok().filter(|&number: &usize| number < names.clone().count());
    exact().or_else(folded).or_else(number)
}

/// Whether files of this extension hold animations to choose from.
pub fn chooses(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    matches!(extension.as_deref(), Some("glb" | "gltf" | "fbx" | "wrl" | "vrml" | "x3dv"))
}

/// All animations of the file `path`: of a glTF or FBX file, or the time sensors of a VRML world.
pub fn list(path: &Path, fps: Option<f64>) -> Result<Vec<Entry>> {
    match super::format_of(path, &Files::default())?.name {
        "FBX" => fbx::list(path, fps),
        "VRML" => vrml::list(path, fps),
        "glTF" => gltf::list(path, fps),
        // All others hold one motion without a name.
        _ => {
            let motion = super::load(path, &Options { fps, ..Options::default() })?.motion;
            let tracks = motion.rig.channels();
            Ok(vec![Entry { name: None, frames: motion.frames, fps: 1.0 / motion.frame_time, tracks }])
        }
    }
}
