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

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::Args;
use harness::build::Core;
use harness::web::browser::Browser;
use harness::{clips, paths, setup, web};

use crate::packages::{self, Package};
use crate::sizes;
use crate::steps::Steps;

/// Runs every check and test: format, lints, host tests, firmware builds, QEMU tests.
#[derive(Args)]
pub struct Test {
    /// Leaves out the tests that need QEMU or Chromium
    #[arg(long)]
    host_only: bool,
}

impl Test {
    /// Runs all steps, failed ones too, then lists them.
    pub fn run(self) -> Result<()> {
        let packages = packages::firmware()?;
        let (boards, libraries): (Vec<_>, Vec<_>) = packages.into_iter().partition(|package| !package.targets.is_empty());
        let mut steps = Steps::default();
        steps.run("tools", || tools(&boards, self.host_only));
        steps.run("host tool, and a clip for the firmware", walk);
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
        for (package, ..) in web::MODULES {
            let lints = format!("clippy -p {package} --target {} -- -D warnings", web::TARGET);
            steps.run(&format!("lints of {package}"), || cargo(Workspace::Web, &lints, false));
        }
        steps.run("sizes of the images", sizes::check);
        let name = if self.host_only { "harness tests (QEMU and Chromium left out)" } else { "tests in QEMU and Chromium" };
        steps.run(name, || cargo(Workspace::Host, "test -p harness --no-fail-fast", self.host_only));
        steps.finish()
    }
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
    setup::rust_target(web::TARGET)?;
    if !host_only {
        for program in ["qemu-system-arm", "qemu-system-riscv32", "node", "npm"] {
            setup::install_emulator(program).context("(or leave QEMU's tests out with --host-only)")?;
        }
        Browser::ready().context("(or leave Chromium's tests out with --host-only)")?;
    }
    Ok(())
}

/// Where the clip lies that the boards are built with.
fn clip() -> PathBuf {
    paths::root().join("target/xtask/walk.ptn")
}

fn walk() -> Result<()> {
    std::fs::create_dir_all(paths::root().join("target/xtask")).context("cannot make target/xtask")?;
    clips::convert(&paths::root().join("motions/walk.keys"), &paths::root().join("target/xtask")).map(drop)
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
    command.current_dir(folder).env("PANTIN_CLIP", clip());
    command
}

fn finish(mut command: Command, arguments: &str) -> Result<()> {
    let status = command.status().context("cannot start cargo")?;
    ensure!(status.success(), "cargo {arguments}");
    Ok(())
}
