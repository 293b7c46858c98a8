//! Programs that cargo builds, and where it puts them.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, IsTerminal};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::paths;
use crate::test_programs::HOST_TOOL;

/// One call of cargo.
#[derive(Default)]
pub struct Build {
    /// The folder to run in: each workspace finds its own configuration there.
    pub workspace: PathBuf,
    /// What to build.
    pub arguments: Vec<OsString>,
    /// Environment variables of the build.
    pub environment: Vec<(OsString, OsString)>,
    /// Name of the cargo target whose file is returned.
    pub product: String,
    /// Flags of the compiler for the product alone: other crates are those of builds without them.
    pub flags: Vec<OsString>,
}

/// Builds, with cargo's own messages on stderr, and returns the product's file.
pub fn cargo(build: &Build) -> Result<PathBuf> {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let mut command = Command::new(cargo);
    let subcommand = if build.flags.is_empty() { "build" } else { "rustc" };
    command.args([subcommand, "--message-format=json-render-diagnostics"]).args(&build.arguments);
    if !std::io::stderr().is_terminal() {
        command.arg("--quiet");
    }
    if !build.flags.is_empty() {
        command.arg("--").args(&build.flags);
    }
    command.envs(build.environment.iter().cloned()).current_dir(&build.workspace).stdout(Stdio::piped());
    let mut child = command.spawn().context("cannot start cargo")?;
    let mut product = None;
    for line in child.stdout.take().into_iter().flat_map(|stdout| BufReader::new(stdout).lines()) {
        let message: Value = serde_json::from_str(&line?).context("cargo's messages are not JSON")?;
        if message["reason"] == "compiler-artifact" && message["target"]["name"] == build.product.as_str() {
            let file = message["executable"].as_str().or_else(|| message["filenames"][0].as_str());
            product = file.map(PathBuf::from).or(product);
        }
    }
    ensure!(child.wait()?.success(), "cargo could not build {}", build.product);
    product.with_context(|| format!("cargo built no {}", build.product))
}

/// Builds the host tool and returns its path. It uses the tests' profile, which is optimized, so that a fresh clone
/// compiles the tool once.
pub fn host_tool() -> Result<PathBuf> {
    if let Some(tool) = std::env::var_os(HOST_TOOL) {
        return Ok(tool.into());
    }
    cargo(&Build {
        workspace: paths::root(),
        arguments: ["--package", "pantin-tools", "--bin", "pantin"].map(OsString::from).into(),
        environment: vec![],
        product: "pantin".into(),
        ..Build::default()
    })
}
