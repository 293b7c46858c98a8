//! The animations of files that may hold several.

use super::{FORMATS, Request};
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

/// The one motion of a file of a format that holds no more.
pub(super) fn only_one(path: &Path, request: &Request) -> Result<Vec<Entry>> {
    let motion = super::imported(path, request)?.motion;
    let tracks = motion.rig.channels();
    Ok(vec![Entry { name: None, frames: motion.frames, fps: 1.0 / motion.frame_time, tracks }])
}

/// Whether a file's extension is one of a format that holds several animations.
pub fn chooses(path: &Path) -> bool {
    FORMATS.iter().any(|format| format.has_animations && format.names(path))
}
