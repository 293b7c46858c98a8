//! Starts `cargo xtask demo`, and builds the firmware while its program is compiled.

use std::process::{Child, Command, Stdio};

use anyhow::{Context, Result, bail};
use xtask::clip::firmware_copy;
use xtask::packages::{self, Package};
use xtask::{paths, setup};

/// The reference board, on which a demonstration plays by default. It is built with room for any clip.
const REFERENCE: &str = "lm3s6965evb";

/// Runs the demonstration.
pub fn run(arguments: &[String]) -> Result<()> {
    let no_board = arguments.iter().any(|argument| ["-h", "--help", "--meet", "--steer"].contains(&argument.as_str()));
    // What goes wrong there the demonstration's own build shows.
    let ahead = if no_board { None } else { build_ahead(board(arguments)).ok() };
    let status = crate::cargo_run(&["--profile", "demo", "--package", "xtask-demo"]).args(arguments).status();
    if let Some(mut child) = ahead {
        let _ = child.wait();
    }
    if !status.context("cannot start cargo")?.success() {
        bail!("the demonstration failed, see above");
    }
    Ok(())
}

/// The board that the arguments name.
fn board(arguments: &[String]) -> &str {
    let named = arguments.iter().position(|argument| argument == "--board").and_then(|at| arguments.get(at + 1));
    let joined = arguments.iter().find_map(|argument| argument.strip_prefix("--board="));
    named.map(String::as_str).or(joined).unwrap_or(REFERENCE)
}

/// Starts to build the board's firmware with our walk. Where that is the clip, nothing is left to build; else the board's own package is.
fn build_ahead(board: &str) -> Result<Child> {
    let package = packages::firmware()?.into_iter().find(|package| package.name == board && package.is_board());
    let Package { targets, .. } = package.context("no such board")?;
    let target = targets.first().context("a board without a target")?;
    setup::rust_target(target)?;
    let features = if board == REFERENCE { "large" } else { "" };
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.args(["build", "--quiet", "--release", "--package", board, "--bin", board, "--target", target, "--features", features]);
    cargo.env("PANTIN_CLIP", firmware_copy(&paths::root().join("motions/walk.ptn"))?);
    cargo.env("DEFMT_LOG", std::env::var_os("DEFMT_LOG").unwrap_or("info".into()));
    let cargo = cargo.current_dir(paths::firmware()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    cargo.spawn().context("cannot start cargo")
}
