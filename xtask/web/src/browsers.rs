//! The site's page in every browser that is installed.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use xtask::browser::Browser;
use xtask::{paths, setup};

/// Programs that are Firefox.
const FIREFOX: [&str; 2] = ["firefox-esr", "firefox"];

/// In which browsers the page was tried.
pub struct Tried {
    /// Names of the browsers.
    pub browsers: Vec<String>,
    /// A note for each browser that is not installed.
    pub notes: Vec<String>,
}

/// Uses the page of a built site in Chromium, which is installed if it is missing, and in Firefox and WebKit if they are installed; an error if the page does not do the same in all of them.
pub fn check(site: &Path) -> Result<Tried> {
    let others = [
        ("Firefox", "FIREFOX", "firefox", FIREFOX.into_iter().find_map(paths::program)),
        ("WebKit", "WEBKIT", setup::WEBKIT, webkit()),
    ];
    let chromium = Browser::ready()?;
    let mut node = Command::new(setup::emulator("node")?);
    node.arg(paths::root().join("tests/web/browsers.mjs")).arg(paths::root().join(site)).envs(chromium.environment());
    let mut notes = vec![];
    for (name, variable, package, program) in others {
        match program {
            Some(program) => drop(node.env(variable, program)),
            None => notes.push(format!("not tried in {name}, which is not installed ({})", setup::advice(package))),
        }
    }
    let output = node.output().context("cannot start node")?;
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    ensure!(output.status.success(), "the page in browsers: {out}{err}");
    Ok(Tried { browsers: serde_json::from_str(&out).context("browsers.mjs")?, notes })
}

/// WebKit's own browser. It lies beside the library, and needs a screen: Xvfb, so that no window opens.
fn webkit() -> Option<PathBuf> {
    paths::program("Xvfb")?;
    let arch = format!("/usr/lib/{}-linux-gnu", std::env::consts::ARCH);
    let folders = [&*arch, "/usr/lib64", "/usr/lib", "/usr/libexec"];
    let programs = folders.into_iter().map(|folder| Path::new(folder).join("webkit2gtk-4.1").join(setup::WEBKIT));
    programs.into_iter().find(|program| program.is_file())
}
