//! The reference clips: every `bvh_*.bvh` of the motion data.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use harness::paths;

use super::{Setting, peers};
use xtask::steps::say;

/// Clips of a quick run: different rigs, rates and moods, a few seconds each.
const QUICK: [&str; 4] = ["bvh_bandai1_kick", "bvh_diema_anger", "bvh_mixamo-beta_run-loop", "bvh_xia_strut-walk"];

/// A reference clip.
pub struct Reference {
    /// The file's name without its extension.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// What is known of it and of the peers on it.
    pub peers: Option<peers::Clip>,
}

impl Reference {
    /// Length of the clip's unit, where it is known.
    pub fn cm_per_unit(&self) -> Option<f64> {
        self.peers.as_ref().map(|clip| clip.cm_per_unit)
    }
}

/// All of them, in order of their names; `None` without motion data, which is said.
pub fn all(setting: &Setting) -> Result<Option<Vec<Reference>>> {
    let Some(data) = paths::data() else { return Ok(None) };
    let table = data.join("../peers/rd_reference.csv");
    let mut peers = peers::read(&table)?.unwrap_or_else(|| {
        say(&format!("no peers' sizes at {}: ours stand alone", table.display()));
        BTreeMap::new()
    });
    let mut clips = vec![];
    for entry in std::fs::read_dir(&data).with_context(|| data.display().to_string())? {
        let path = entry?.path();
        let Some(name) = name(&path) else { continue };
        let wanted = match &setting.only {
            Some(part) => name.contains(part.as_str()),
            None => !setting.quick || QUICK.contains(&name.as_str()),
        };
        if wanted {
            clips.push(Reference { peers: peers.remove(&name), name, path });
        }
    }
    clips.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(Some(clips))
}

fn name(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?.strip_suffix(".bvh")?;
    name.starts_with("bvh_").then(|| name.to_owned())
}

/// The clip of this name; `None` without motion data, which is said.
pub fn named(name: &str) -> Result<Option<Reference>> {
    let Some(data) = paths::data() else { return Ok(None) };
    let path = data.join(name).with_extension("bvh");
    let peers = peers::read(&data.join("../peers/rd_reference.csv"))?.and_then(|mut peers| peers.remove(name));
    Ok(path.is_file().then(|| Reference { name: name.into(), path, peers }))
}
