//! The test programs of the repository's workspace, built in one call of cargo and run one by one.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::paths;

/// The variable that names the host tool for the tests: by itself it would be compiled again, with its own packages' features only.
pub const HOST_TOOL: &str = "PANTIN_TOOL";

/// A test program.
pub struct TestProgram {
    /// Its package.
    pub package: String,
    /// Its name in the package.
    pub name: String,
    /// The program.
    pub file: PathBuf,
    /// Its package's folder, in which it runs.
    pub folder: PathBuf,
    /// The host tool, which is built with the tests.
    pub host_tool: Option<PathBuf>,
}

/// Builds all of them, with the features of all packages together: what they share is compiled once.
pub fn build() -> Result<Vec<TestProgram>> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.args(["test", "--workspace", "--no-run", "--message-format=json-render-diagnostics"]);
    let output = cargo.current_dir(paths::root()).stderr(Stdio::inherit()).output().context("cannot start cargo")?;
    ensure!(output.status.success(), "cargo test --workspace --no-run");
    let messages = String::from_utf8_lossy(&output.stdout);
    let messages = messages.lines().map(serde_json::from_str).collect::<Result<Vec<Value>, _>>();
    let messages = messages.context("cargo's messages are not JSON")?;
    let tool = messages.iter().find(|message| {
        message["target"]["name"] == "pantin" && message["target"]["kind"][0] == "bin" && message["profile"]["test"] == false
    });
    let tool = tool.and_then(|message| message["executable"].as_str()).map(PathBuf::from);
    let programs = messages.iter().map(|message| program(message, &tool)).collect::<Result<Vec<_>>>()?;
    Ok(programs.into_iter().flatten().collect())
}

fn program(message: &Value, host_tool: &Option<PathBuf>) -> Result<Option<TestProgram>> {
    let (Some(file), Some(true)) = (message["executable"].as_str(), message["profile"]["test"].as_bool()) else {
        return Ok(None);
    };
    let manifest = PathBuf::from(message["manifest_path"].as_str().context("cargo names no manifest")?);
    let folder = manifest.parent().context("a manifest in no folder")?.to_path_buf();
    let package = message["package_id"].as_str().context("cargo names no package")?;
    // `path+file:///folder#name@1.0.0`, or without the name where the folder has it.
    let (place, rest) = package.rsplit_once('#').unwrap_or(("", package));
    let package = rest.split_once('@').map_or_else(|| place.rsplit('/').next().unwrap_or(rest), |(name, _)| name);
    let name = message["target"]["name"].as_str().context("cargo names no target")?;
    Ok(Some(TestProgram { package: package.into(), name: name.into(), file: file.into(), folder, host_tool: host_tool.clone() }))
}
