//! The packages of the firmware workspace: those for a board name their targets, the others run on the host too.
//!
//! A board's `Cargo.toml` says `[package.metadata.firmware]` and `targets = ["thumbv7m-none-eabi"]`; with `daily = true` it is the board of
//! its architecture that `cargo xtask test` builds and emulates; all others are for `cargo xtask test --boards`.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::paths;

/// Features that make another image of a board; its other ones are for tests and measurements.
const MEANT: [&str; 3] = ["face", "st7789", "update"];

/// A package of the firmware workspace.
pub struct Package {
    /// Its name.
    pub name: String,
    /// The targets it is built for; none for a library that its tests run on the host.
    pub targets: Vec<String>,
    /// Whether `cargo xtask test` without options builds it.
    pub daily: bool,
    /// Its programs.
    pub programs: Vec<String>,
    /// Those of its features that make another image.
    pub features: Vec<String>,
    /// Its folder.
    pub folder: PathBuf,
    /// Its version.
    pub version: String,
    /// The oldest Rust that it states to compile with.
    pub rust_version: String,
}

impl Package {
    /// Whether it is a board's.
    pub fn is_board(&self) -> bool {
        self.folder.parent().is_some_and(|folder| folder.ends_with("boards"))
            && !self.targets.is_empty()
            && self.programs.contains(&self.name)
    }

    /// What `cargo run` there starts a program with, if that is something: a word and its arguments.
    pub fn runner(&self) -> Option<String> {
        let config = std::fs::read_to_string(self.folder.join(".cargo/config.toml")).ok()?;
        let runner = config.lines().find_map(|line| line.trim().strip_prefix("runner")?.trim_start().strip_prefix('='))?;
        let words: Vec<&str> = runner.split(['"', '\'', ',', '[', ']', ' ']).filter(|word| !word.is_empty()).collect();
        (!words.is_empty()).then(|| words.join(" "))
    }
}

/// All packages of the firmware workspace.
pub fn firmware() -> Result<Vec<Package>> {
    of(&paths::firmware())
}

/// The packages of the web page's workspace.
pub fn web() -> Result<Vec<Package>> {
    of(&paths::root().join("web"))
}

/// The packages of the root's workspace that are published.
pub fn published() -> Result<Vec<Package>> {
    let packages = listed(&paths::root())?;
    // An empty list of registries is `publish = false`.
    Ok(packages.iter().filter(|package| package["publish"].is_null()).map(package).collect())
}

fn of(workspace: &Path) -> Result<Vec<Package>> {
    Ok(listed(workspace)?.iter().map(package).collect())
}

/// What cargo says of the packages of a workspace.
pub(crate) fn listed(workspace: &Path) -> Result<Vec<Value>> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    let output = cargo.args(["metadata", "--no-deps", "--format-version=1"]).current_dir(workspace).output();
    let output = output.context("cannot start cargo")?;
    ensure!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr).trim());
    let metadata: Value = serde_json::from_slice(&output.stdout).context("cargo metadata")?;
    metadata["packages"].as_array().cloned().context("cargo metadata names no packages")
}

fn package(package: &Value) -> Package {
    let programs = package["targets"].as_array().into_iter().flatten();
    let programs = programs.filter(|target| strings(&target["kind"]).any(|kind| kind == "bin"));
    let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
    let has = |feature: &&str| package["features"].get(feature).is_some();
    let manifest = PathBuf::from(package["manifest_path"].as_str().unwrap_or_default());
    Package {
        name: text("name"),
        targets: strings(&package["metadata"]["firmware"]["targets"]).map(String::from).collect(),
        daily: package["metadata"]["firmware"]["daily"].as_bool().unwrap_or_default(),
        programs: programs.filter_map(|target| target["name"].as_str()).map(String::from).collect(),
        features: MEANT.iter().filter(|feature| has(feature)).map(|feature| (*feature).to_owned()).collect(),
        folder: manifest.parent().map(PathBuf::from).unwrap_or_default(),
        version: text("version"),
        rust_version: text("rust_version"),
    }
}

fn strings(value: &Value) -> impl Iterator<Item = &str> {
    value.as_array().into_iter().flatten().filter_map(Value::as_str)
}
