//! The test programs of the repository's workspace, built in one call of cargo and run one by one.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::paths;

/// The variable that names the host tool for the tests: by itself it would be compiled again, with its own packages' features only.
pub const HOST_TOOL: &str = "PANTIN_TOOL";

/// What one build of the workspace's tests makes.
#[derive(Clone, Debug)]
pub struct Built {
    /// The test programs.
    pub programs: Vec<TestProgram>,
    /// The host tool.
    pub host_tool: Option<PathBuf>,
    /// The program of most commands of `cargo xtask`.
    commands: Option<PathBuf>,
}

/// A test program.
#[derive(Clone, Debug)]
pub struct TestProgram {
    /// Its package.
    pub package: String,
    /// Its name in the package.
    pub name: String,
    /// The program.
    pub file: PathBuf,
    /// Its package's folder, in which it runs.
    pub folder: PathBuf,
}

impl Built {
    /// A test program by its package and name.
    pub fn program(&self, package: &str, name: &str) -> Option<&TestProgram> {
        self.programs.iter().find(|program| program.package == package && program.name == name)
    }

    /// Runs a command of `cargo xtask` with the program that was built with the tests: `cargo xtask` would compile it again, with its own packages'
    /// features only.
    pub fn xtask(&self, command: &str) -> Result<()> {
        let program = self.commands.as_ref().context("xtask-commands was not built with the tests")?;
        let mut process = Command::new(program);
        process.arg(command).current_dir(paths::root()).envs(self.host_tool.iter().map(|tool| (HOST_TOOL, tool)));
        ensure!(process.status().with_context(|| format!("cannot start {command}"))?.success(), "{command}");
        Ok(())
    }
}

/// Builds all of them, with the features of all packages together: what they share is compiled once.
pub fn build() -> Result<Built> {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.args(["test", "--workspace", "--no-run", "--message-format=json-render-diagnostics"]);
    let output = cargo.current_dir(paths::root()).stderr(Stdio::inherit()).output().context("cannot start cargo")?;
    ensure!(output.status.success(), "cargo test --workspace --no-run");
    let messages = String::from_utf8_lossy(&output.stdout);
    let messages = messages.lines().map(serde_json::from_str).collect::<Result<Vec<Value>, _>>();
    let messages = messages.context("cargo's messages are not JSON")?;
    let programs = messages.iter().map(test_program).collect::<Result<Vec<_>>>()?;
    Ok(Built {
        programs: programs.into_iter().flatten().collect(),
        host_tool: program(&messages, "pantin"),
        commands: program(&messages, "xtask-commands"),
    })
}

/// A program that integration tests run.
fn program(messages: &[Value], name: &str) -> Option<PathBuf> {
    let is_it = |message: &&Value| {
        message["target"]["name"] == name && message["target"]["kind"][0] == "bin" && message["profile"]["test"] == false
    };
    messages.iter().find(is_it)?["executable"].as_str().map(PathBuf::from)
}

fn test_program(message: &Value) -> Result<Option<TestProgram>> {
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
    Ok(Some(TestProgram { package: package.into(), name: name.into(), file: file.into(), folder }))
}
