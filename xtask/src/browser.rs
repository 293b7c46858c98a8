//! Chromium, driven by `tests/web/drive.mjs`.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::setup::{self, HOST_ONLY, install_emulator};
use crate::{npm, paths};

/// Chromium and what drives it, installed.
pub struct Browser {
    chromium: PathBuf,
    playwright: PathBuf,
}

/// Whether Chromium's tests are to be skipped, as those in QEMU are; says it where no test runner swallows it.
pub fn skipped(test: &str) -> bool {
    let skip = std::env::var_os(HOST_ONLY).is_some_and(|value| !value.is_empty());
    if skip {
        use std::io::Write;
        let _ = writeln!(std::io::stderr(), "SKIPPED: {test} needs Chromium ({HOST_ONLY} is set)");
    }
    skip
}

impl Browser {
    /// Installs what is missing.
    pub fn ready() -> Result<Browser> {
        let known = ["chromium", "chromium-browser", "google-chrome"].into_iter().find_map(paths::program);
        let chromium = known.map_or_else(|| install_emulator("chromium"), Ok)?;
        setup::install_emulator("node")?;
        Ok(Browser { chromium, playwright: playwright()? })
    }

    /// The variables that name Chromium and the folder of the packages that drive it to scripts in Node.
    pub fn environment(&self) -> [(&'static str, &Path); 2] {
        [("CHROMIUM", &self.chromium), ("PLAYWRIGHT", &self.playwright)]
    }

    /// Runs a case of the driver; an error if anything that it asserts is not so.
    pub fn drive(&self, case: &str, arguments: &Value) -> Result<Value> {
        let driver = paths::root().join("tests/web/drive.mjs");
        let mut node = Command::new(setup::emulator("node")?);
        node.arg(driver).arg(case).arg(arguments.to_string()).envs(self.environment());
        let output = node.stdin(Stdio::null()).output().context("cannot start node")?;
        ensure!(output.status.success(), "{case}: {}", String::from_utf8_lossy(&output.stderr).trim());
        serde_json::from_slice(&output.stdout).with_context(|| format!("{case}: the driver said no JSON"))
    }
}

/// The folder in which the locked packages are.
fn playwright() -> Result<PathBuf> {
    let folder = paths::root().join("target/playwright");
    npm::install(&paths::root().join("tests/web"), &folder)?;
    Ok(folder)
}
