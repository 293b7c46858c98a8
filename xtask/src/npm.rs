//! Packages from npm, as a lock file in the repository names them.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;

use anyhow::{Context, Result, ensure};

use crate::setup::install_emulator;

/// Installs the packages that `wanted/package-lock.json` names into `folder`, once.
pub fn install(wanted: &Path, folder: &Path) -> Result<()> {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let lock = wanted.join("package-lock.json");
    let lock = fs::read(&lock).with_context(|| lock.display().to_string())?;
    let done = folder.join("installed-lock.json");
    if fs::read(&done).is_ok_and(|installed| installed == lock) {
        return Ok(());
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for name in ["package.json", "package-lock.json"] {
        fs::copy(wanted.join(name), folder.join(name)).with_context(|| name.to_owned())?;
    }
    run(folder, &["ci", "--no-audit", "--no-fund"])?;
    fs::write(&done, lock).with_context(|| done.display().to_string())
}

/// Runs npm in a folder, and returns what it printed.
pub fn run(folder: &Path, arguments: &[&str]) -> Result<String> {
    eprintln!("npm {}", arguments.join(" "));
    let npm = install_emulator("npm")?;
    let output =
        Command::new(npm).args(arguments).current_dir(folder).stdin(Stdio::null()).output().context("cannot start npm")?;
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    ensure!(output.status.success(), "`npm {}` failed in {}:\n{out}{err}", arguments.join(" "), folder.display());
    Ok(out)
}
