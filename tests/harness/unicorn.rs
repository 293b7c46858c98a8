//! Unicorn, QEMU's processors without a machine: scripts in `tests` that give one the peripherals which a program uses.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Mutex;

use anyhow::{Context, Result, ensure};
use serde::de::DeserializeOwned;

use crate::paths;

/// The Python package of the emulator, and its version.
const PACKAGE: &str = "unicorn==2.1.4";

/// Runs a script of `tests`, and returns what it prints as JSON.
pub fn run<T: DeserializeOwned>(script: &str, arguments: &[&OsStr]) -> Result<T> {
    let mut command = Command::new(python()?);
    command.arg(paths::root().join("tests").join(script)).args(arguments).env("PYTHONPATH", emulator()?);
    let output = command.stdin(Stdio::null()).output().context("cannot start Python")?;
    let words = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{script} ended with {}: {}", output.status, words.trim());
    serde_json::from_slice(&output.stdout).with_context(|| format!("{script} printed no JSON"))
}

fn python() -> Result<PathBuf> {
    paths::program("python3").context("python3 is missing; install it with your system's package manager")
}

/// The emulator's folder, which pip fetches the first time.
fn emulator() -> Result<PathBuf> {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let folder = paths::root().join("target/unicorn").join(PACKAGE);
    let fetched = folder.join("fetched");
    if !fetched.exists() {
        eprintln!("fetching Unicorn, the processor of these tests: pip install {PACKAGE}");
        let mut command = Command::new(python()?);
        command.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--target"]);
        let output = command.arg(&folder).arg(PACKAGE).stdin(Stdio::null()).output().context("cannot start Python")?;
        let words = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "`pip install {PACKAGE}` failed (is there a network?): {}", words.trim());
        std::fs::write(&fetched, "").context("cannot note what was fetched")?;
    }
    Ok(folder)
}
