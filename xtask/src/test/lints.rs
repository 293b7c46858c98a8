//! Formatting and lints of the workspaces.

use anyhow::Result;
use xtask::packages::Package;
use xtask::steps::Steps;

use super::cargo::{Workspace, on_board};

/// What the web page's modules are compiled for.
pub const WEB_TARGET: &str = "wasm32-unknown-unknown";

/// The clippy whose lints are errors: the one that CI installs. A later one knows more lints, which are shown and fail nothing.
const CLIPPY: &str = "0.1.95";

/// What makes a lint an error.
fn as_errors() -> &'static str {
    let version = std::process::Command::new("cargo").args(["clippy", "--version"]).output();
    let pinned = version.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains(CLIPPY));
    if pinned { "-D warnings" } else { "-W warnings" }
}

/// Formatting of all workspaces.
pub fn format(steps: &Steps) {
    let check = "fmt --all --check";
    steps.run("format", || Workspace::Host.shown(check));
    steps.run("format of the firmware", || Workspace::Firmware.shown(check));
    steps.run("format of the web modules", || Workspace::Web.shown(check));
    steps.run("format of the documentation's command", || Workspace::Book.shown(check));
}

/// Lints of the host's crates.
pub fn host(steps: &Steps) {
    steps.run("lints", || Workspace::Host.shown(&format!("clippy --workspace --all-targets -- {}", as_errors())));
}

/// Lints and tests of the firmware's packages that are for no board.
pub fn libraries(steps: &Steps, libraries: &[Package]) {
    let named: String = libraries.iter().map(|library| format!(" -p {}", library.name)).collect();
    if named.is_empty() {
        return;
    }
    steps.run("lints of the firmware's libraries", || {
        Workspace::Firmware.captured(&format!("clippy{named} --all-targets -- {}", as_errors()))
    });
    steps.run("host tests of the firmware's libraries", || Workspace::Firmware.captured(&format!("test{named} --no-fail-fast")));
}

/// Lints of boards and other images, without and with the features that make another image.
pub fn boards(steps: &Steps, boards: &[Package]) {
    for package in boards {
        let name = &package.name;
        for target in &package.targets {
            let build = format!("--release -p {name} --target {target}");
            steps.run(&format!("{name} for {target}"), || {
                on_board(&format!("clippy {build}"), &lints(), target)?;
                // The sizes of a board's images are compared: that builds them.
                if package.is_board() { Ok(()) } else { on_board(&format!("build {build}"), "", target) }
            });
            // Together: none of them excludes another.
            let features = package.features.join(",");
            if !features.is_empty() {
                steps.run(&format!("lints of {name} with {features} for {target}"), || {
                    on_board(&format!("clippy {build} --features {features}"), &lints(), target)
                });
            }
        }
    }
}

/// Lints of the page's modules, one by one: together, the player's libraries would get the converter's standard library.
pub fn web(steps: &Steps, modules: &[Package]) {
    for Package { name, .. } in modules {
        steps.run(&format!("lints of {name}"), || web_module(name));
    }
}

/// Lints and tests of what makes a site of the documentation, and the site, whose links lead somewhere.
pub fn book(steps: &Steps) {
    steps.run("lints of the documentation's command", || {
        Workspace::Book.captured(&format!("clippy --all-targets -- {}", as_errors()))
    });
    steps.run("tests of the documentation's command", || Workspace::Book.captured("test"));
    steps.run("documentation as a site", || Workspace::Book.captured("run -- -o ../../target/book/site"));
}

fn web_module(name: &str) -> Result<()> {
    Workspace::Web.captured(&format!("clippy -p {name} --all-features --target {WEB_TARGET} {}", lints()))
}

fn lints() -> String {
    format!("-- {}", as_errors())
}
