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
/// its number from 0. `None` if several have the name.
pub(super) fn choose<'n>(wanted: &str, names: impl Iterator<Item = Option<&'n str>> + Clone) -> Option<usize> {
    let called = |same: &dyn Fn(&str) -> bool| -> Vec<usize> {
        let numbered = names.clone().enumerate();
        numbered.filter(|(_, name)| name.is_some_and(same)).map(|(number, _)| number).collect()
    };
    let exact = called(&|name| name == wanted);
    let folded = || called(&|name| name.to_lowercase() == wanted.to_lowercase());
    match &*(if exact.is_empty() { folded() } else { exact }) {
        [one] => Some(*one),
        [] => wanted.parse().ok().filter(|&number: &usize| number < names.clone().count()),
        _ => None,
    }
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
