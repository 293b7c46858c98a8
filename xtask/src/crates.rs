//! The crates of the repository and the arrows between them, read from `cargo metadata`: what ARCHITECTURE.md draws and what must hold.
//!
//! An arrow points from a crate to one that it needs to run; what tests and build scripts need makes none.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result};
use serde_json::Value;

use crate::packages::listed;
use crate::paths;

/// Workspaces whose crates are drawn; boards, examples and fuzz targets are programs on top.
const WORKSPACES: [&str; 3] = ["", "bindings/python", "web"];

/// What a group may need. Crates of a group have a folder in common, or are named.
const MAY_NEED: [(&str, &[&str]); 10] = [
    ("decoder", &[]),
    ("firmware", &["decoder", "firmware"]),
    ("host-tools/convert", &["decoder", "firmware/figure"]),
    ("host-tools/build", &["host-tools/convert"]),
    ("host-tools/images", &["decoder", "firmware"]),
    ("host-tools/pictures", &["decoder", "firmware", "host-tools/convert", "host-tools/images"]),
    ("host-tools/line", &["decoder", "firmware", "host-tools/convert"]),
    ("bindings/python", &["decoder", "firmware/figure", "host-tools/convert"]),
    ("web/machine", &["decoder", "host-tools/convert", "host-tools/pictures", "web/worker"]),
    ("web", &["decoder", "firmware", "host-tools/convert", "web"]),
];

/// Crates on which only programs may depend: tests, commands of the repository, and themselves.
const TOP: [&str; 2] = ["host-tools/pantin", "tests"];

/// A crate and what it needs, by their folders from the repository's root.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Crate {
    /// Its name.
    pub name: String,
    /// Its folder.
    pub folder: String,
    /// Folders of the crates that it needs, in order.
    pub needs: BTreeSet<String>,
}

/// All crates of the drawn workspaces, by folder.
pub fn all() -> Result<Vec<Crate>> {
    let mut found = BTreeMap::new();
    for workspace in WORKSPACES {
        for package in listed(&paths::root().join(workspace))? {
            let made = read(&package)?;
            found.insert(made.folder.clone(), made);
        }
    }
    Ok(found.into_values().collect())
}

/// The graph as ARCHITECTURE.md has it, one line a crate.
pub fn drawn(crates: &[Crate]) -> String {
    let width = crates.iter().map(|one| one.folder.len()).max().unwrap_or_default();
    let line = |one: &Crate| {
        let needs: Vec<&str> = one.needs.iter().map(String::as_str).collect();
        let needs = if needs.is_empty() { "nothing".into() } else { needs.join(", ") };
        format!("{:width$}  ->  {needs}\n", one.folder)
    };
    crates.iter().map(line).collect()
}

/// Arrows that must not be, as sentences.
pub fn forbidden(crates: &[Crate]) -> Vec<String> {
    let mut wrong = Vec::new();
    for one in crates {
        let below = |folder: &str, of: &str| folder == of || folder.strip_prefix(of).is_some_and(|rest| rest.starts_with('/'));
        let rule = MAY_NEED.iter().find(|(group, _)| below(&one.folder, group));
        for needed in &one.needs {
            let allowed = match rule {
                Some((_, may)) => may.iter().any(|may| below(needed, may)),
                None => one.folder.starts_with("tests") || one.folder.starts_with("xtask") || !TOP.contains(&needed.as_str()),
            };
            if !allowed {
                wrong.push(format!("{} needs {needed}", one.folder));
            }
        }
    }
    wrong
}

/// Sets of crates that need each other.
pub fn circles(crates: &[Crate]) -> Vec<String> {
    let needs: BTreeMap<&str, &BTreeSet<String>> = crates.iter().map(|one| (one.folder.as_str(), &one.needs)).collect();
    let reaches_itself = |start: &str| {
        let (mut seen, mut next) = (BTreeSet::new(), vec![start]);
        while let Some(folder) = next.pop() {
            for needed in needs.get(folder).into_iter().flat_map(|needs| needs.iter()) {
                if needed == start {
                    return true;
                }
                if seen.insert(needed.as_str()) {
                    next.push(needed);
                }
            }
        }
        false
    };
    crates.iter().filter(|one| reaches_itself(&one.folder)).map(|one| one.folder.clone()).collect()
}

fn read(package: &Value) -> Result<Crate> {
    let manifest = package["manifest_path"].as_str().context("a package without a manifest")?;
    let folder = std::path::Path::new(manifest).parent().context("a manifest in no folder")?;
    let dependencies = package["dependencies"].as_array().into_iter().flatten();
    let needed =
        dependencies.filter(|dependency| dependency["kind"].is_null()).filter_map(|dependency| dependency["path"].as_str());
    Ok(Crate {
        name: package["name"].as_str().unwrap_or_default().into(),
        folder: from_root(folder),
        needs: needed.map(|path| from_root(path.as_ref())).collect(),
    })
}

fn from_root(folder: &std::path::Path) -> String {
    folder.strip_prefix(paths::root()).unwrap_or(folder).to_string_lossy().replace('\\', "/")
}
