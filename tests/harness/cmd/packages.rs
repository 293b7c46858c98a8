//! The packages of the firmware workspace: those for a board name their targets, the others run on the host too.
//!
//! A board's `Cargo.toml` says `[package.metadata.firmware]` and `targets = ["thumbv7m-none-eabi"]`.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::paths;
use serde_json::Value;

/// A package of the firmware workspace.
pub struct Package {
    /// Its name.
    pub name: String,
    /// The targets it is built for; none for a library that its tests run on the host.
    pub targets: Vec<String>,
}

/// All of them.
pub fn firmware() -> Result<Vec<Package>> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    let output = cargo.args(["metadata", "--no-deps", "--format-version=1"]).current_dir(paths::firmware()).output();
    let output = output.context("cannot start cargo")?;
    ensure!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr).trim());
    let metadata: Value = serde_json::from_slice(&output.stdout).context("cargo metadata")?;
    let packages = metadata["packages"].as_array().context("cargo metadata names no packages")?;
    Ok(packages.iter().map(package).collect())
}

fn package(package: &Value) -> Package {
    let targets = package["metadata"]["firmware"]["targets"].as_array();
    let targets = targets.into_iter().flatten().filter_map(|target| target.as_str()).map(String::from);
    Package { name: package["name"].as_str().unwrap_or_default().to_owned(), targets: targets.collect() }
}
