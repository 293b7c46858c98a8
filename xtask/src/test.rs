//! `cargo xtask test [--host-only]`: every test, on the host and in QEMU; what CI runs.
//!
//! ```text
//! $ cargo xtask test
//! == tools
//!    0.1 s
//! == format
//! ...
//! step                                          seconds
//! tools                                             0.1
//! ...
//! ```

use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use xtask::browser::Browser;
use xtask::core_library::Core;
use xtask::packages::{self, Package};
use xtask::steps::Steps;
use xtask::{paths, setup};

const USAGE: &str = "Usage: cargo xtask test [--host-only]

Runs every check and test: format, lints, host tests, firmware builds, tests in QEMU and Chromium

Options:
  --host-only  Leaves out the tests that need QEMU or Chromium";

/// What the web page's modules are compiled for.
const WEB_TARGET: &str = "wasm32-unknown-unknown";

/// Runs all steps, failed ones too, then lists them.
pub fn run(arguments: &[String]) -> Result<()> {
    match arguments {
        [] => all(false),
        [only] if only == "--host-only" => all(true),
        [help] if ["--help", "-h"].contains(&help.as_str()) => {
            println!("{USAGE}");
            Ok(())
        }
        _ => bail!("{USAGE}"),
    }
}

fn all(host_only: bool) -> Result<()> {
    let packages = packages::firmware()?;
    let (boards, libraries): (Vec<_>, Vec<_>) = packages.into_iter().partition(|package| !package.targets.is_empty());
    let mut steps = Steps::default();
    steps.run("tools", || tools(&boards, host_only));
    steps.run("format", || cargo(Workspace::Host, "fmt --all --check", false));
    steps.run("format of the firmware", || cargo(Workspace::Firmware, "fmt --all --check", false));
    steps.run("format of the web modules", || cargo(Workspace::Web, "fmt --all --check", false));
    steps.run("lints", || cargo(Workspace::Host, "clippy --workspace --all-targets -- -D warnings", false));
    steps.run("host tests", || cargo(Workspace::Host, "test --workspace --exclude harness --no-fail-fast", false));
    let named: String = libraries.iter().map(|library| format!(" -p {}", library.name)).collect();
    if !named.is_empty() {
        let lints = format!("clippy{named} --all-targets -- -D warnings");
        steps.run("lints of the firmware's libraries", || cargo(Workspace::Firmware, &lints, false));
        steps.run("host tests of the firmware's libraries", || {
            cargo(Workspace::Firmware, &format!("test{named} --no-fail-fast"), false)
        });
    }
    for Package { name, targets, features, .. } in &boards {
        for target in targets {
            let build = format!("--release -p {name} --target {target}");
            steps.run(&format!("{name} for {target}"), || {
                board(&format!("clippy {build}"), "-- -D warnings", target)?;
                board(&format!("build {build}"), "", target)
            });
            for feature in features {
                steps.run(&format!("lints of {name} with {feature} for {target}"), || {
                    board(&format!("clippy {build} --features {feature}"), "-- -D warnings", target)
                });
            }
        }
    }
    // One by one: together, the player's libraries would get the converter's standard library.
    for Package { name, .. } in packages::web()? {
        let lints = format!("clippy -p {name} --target {WEB_TARGET} -- -D warnings");
        steps.run(&format!("lints of {name}"), || cargo(Workspace::Web, &lints, false));
    }
    steps.run("sizes of the images", || cargo(Workspace::Host, "run --package xtask-commands -- sizes", false));
    let name = if host_only { "harness tests (QEMU and Chromium left out)" } else { "tests in QEMU and Chromium" };
    steps.run(name, || cargo(Workspace::Host, "test -p harness --no-fail-fast", host_only));
    steps.finish()
}

#[derive(Clone, Copy)]
enum Workspace {
    Host,
    Firmware,
    Web,
}

fn tools(boards: &[Package], host_only: bool) -> Result<()> {
    for component in ["rustfmt", "clippy"] {
        setup::component(component)?;
    }
    for target in boards.iter().flat_map(|board| &board.targets) {
        setup::rust_target(target)?;
    }
    setup::rust_target(WEB_TARGET)?;
    if !host_only {
        for program in ["qemu-system-arm", "qemu-system-riscv32", "node", "npm"] {
            setup::install_emulator(program).context("(or leave QEMU's tests out with --host-only)")?;
        }
        Browser::ready().context("(or leave Chromium's tests out with --host-only)")?;
    }
    Ok(())
}

fn cargo(workspace: Workspace, arguments: &str, host_only: bool) -> Result<()> {
    let mut command = command(workspace);
    command.args(arguments.split(' '));
    if host_only {
        command.env(setup::HOST_ONLY, "1");
    }
    finish(command, arguments)
}

/// Cargo on a board's package; `last` follows what the target's core library asks for.
fn board(arguments: &str, last: &str, target: &str) -> Result<()> {
    let core = Core::of(target);
    let mut command = command(Workspace::Firmware);
    command.args(arguments.split(' ')).args(core.arguments).args(last.split_whitespace()).envs(core.environment);
    finish(command, arguments)
}

fn command(workspace: Workspace) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    let folder = match workspace {
        Workspace::Host => paths::root(),
        Workspace::Firmware => paths::firmware(),
        Workspace::Web => paths::root().join("web"),
    };
    command.current_dir(folder);
    command
}

fn finish(mut command: Command, arguments: &str) -> Result<()> {
    let status = command.status().context("cannot start cargo")?;
    ensure!(status.success(), "cargo {arguments}");
    Ok(())
}
