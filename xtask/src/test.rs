//! `cargo xtask test [--host-only | --bindings | --boards]`: every test, on the host and in QEMU; what CI runs.
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
use std::sync::mpsc::channel;
use std::thread;

use anyhow::{Context, Result, bail, ensure};
use xtask::browser::Browser;
use xtask::core_library::Core;
use xtask::packages::{self, Package};
use xtask::steps::Steps;
use xtask::test_programs::{self, HOST_TOOL, TestProgram};
use xtask::{paths, setup};

use crate::publish;

const USAGE: &str = "Usage: cargo xtask test [--host-only | --bindings | --boards]

Runs every check and test: format, lints, host tests, firmware builds, tests in QEMU and Chromium

Options:
  --host-only  Leaves out the tests that need QEMU or Chromium
  --bindings   Runs the tests of the decoder in C instead: they need compilers for other targets
  --boards     Checks what a CI job of its own does instead: further boards, images to give away, and the oldest Rust";

/// What the web page's modules are compiled for.
const WEB_TARGET: &str = "wasm32-unknown-unknown";

/// Runs all steps, failed ones too, then lists them.
pub fn run(arguments: &[String]) -> Result<()> {
    match arguments {
        [] => all(false),
        [only] if only == "--host-only" => all(true),
        [only] if only == "--bindings" => shown(Workspace::Host, "run --package xtask-commands -- bindings"),
        [only] if only == "--boards" => boards_apart(),
        [help] if ["--help", "-h"].contains(&help.as_str()) => {
            println!("{USAGE}");
            Ok(())
        }
        _ => bail!("{USAGE}"),
    }
}

fn all(host_only: bool) -> Result<()> {
    let (boards, libraries): (Vec<_>, Vec<_>) =
        packages::firmware()?.into_iter().partition(|package| !package.targets.is_empty());
    let boards: Vec<_> = boards.into_iter().filter(|board| !board.apart).collect();
    let modules = packages::web()?;
    let steps = Steps::default();
    steps.run("tools", || tools(&boards, host_only));
    steps.run("format", || shown(Workspace::Host, "fmt --all --check"));
    steps.run("format of the firmware", || shown(Workspace::Firmware, "fmt --all --check"));
    steps.run("format of the web modules", || shown(Workspace::Web, "fmt --all --check"));
    // Two lanes: an image is linked by one thread, and emulators wait often. One prints as it goes, the other after each step.
    let (built, programs) = channel();
    thread::scope(|scope| {
        let (steps, boards, libraries, modules) = (&steps, &boards, &libraries, &modules);
        scope.spawn(move || {
            firmware_lints(steps, boards, libraries);
            web_lints(steps, modules);
            // None where they could not be built.
            let programs: Vec<TestProgram> = programs.recv().unwrap_or_default();
            for program in &programs {
                steps.run(&format!("tests of {}: {}", program.package, program.name), || emulated(program, host_only));
            }
        });
        let mut here = vec![];
        steps.run("build of the test programs", || {
            let programs = test_programs::build()?.into_iter().filter(|program| !is_for_boards(program));
            let (there, rest) = programs.partition(in_second_lane);
            here = rest;
            built.send(there).context("the second lane is gone")
        });
        drop(built);
        for program in &here {
            steps.run(&format!("tests of {}: {}", program.package, program.name), || {
                finish(tests(program, host_only), &program.name)
            });
        }
        steps.run("documentation tests", || shown(Workspace::Host, "test --workspace --doc"));
        steps.run("lints", || shown(Workspace::Host, "clippy --workspace --all-targets -- -D warnings"));
        steps.run("documentation", || publish::docs(&[]));
        steps.run("packages", || publish::package(&[]));
        steps.run("public items against the last tag", || publish::semver(&[]));
    });
    steps.finish()
}

/// What `cargo xtask test` leaves out.
fn boards_apart() -> Result<()> {
    let boards: Vec<_> = packages::firmware()?.into_iter().filter(|board| board.apart).collect();
    let steps = Steps::default();
    steps.run("tools", || tools(&boards, false));
    firmware_lints(&steps, &boards, &[]);
    steps.run("tests in emulators", || shown(Workspace::Host, "test --package harness --test boards"));
    steps.run("oldest Rust", || publish::msrv(&[]));
    steps.run("sizes", || shown(Workspace::Host, "run --package xtask-commands -- sizes --boards"));
    steps.finish()
}

/// Whether a program tests the boards that are left to `--boards`.
fn is_for_boards(program: &TestProgram) -> bool {
    program.package == "harness" && program.name == "boards"
}

/// Whether a program takes about as long as all others together.
fn in_second_lane(program: &TestProgram) -> bool {
    program.package == "harness" && program.name == "suites"
}

fn firmware_lints(steps: &Steps, boards: &[Package], libraries: &[Package]) {
    let named: String = libraries.iter().map(|library| format!(" -p {}", library.name)).collect();
    if !named.is_empty() {
        steps.run("lints of the firmware's libraries", || {
            captured(Workspace::Firmware, &format!("clippy{named} --all-targets -- -D warnings"))
        });
        steps.run("host tests of the firmware's libraries", || {
            captured(Workspace::Firmware, &format!("test{named} --no-fail-fast"))
        });
    }
    for package in boards {
        let name = &package.name;
        for target in &package.targets {
            let build = format!("--release -p {name} --target {target}");
            steps.run(&format!("{name} for {target}"), || {
                board(&format!("clippy {build}"), "-- -D warnings", target)?;
                // The sizes of a board's images are compared: that builds them.
                if package.is_board() { Ok(()) } else { board(&format!("build {build}"), "", target) }
            });
            for feature in &package.features {
                steps.run(&format!("lints of {name} with {feature} for {target}"), || {
                    board(&format!("clippy {build} --features {feature}"), "-- -D warnings", target)
                });
            }
        }
    }
}

/// One by one: together, the player's libraries would get the converter's standard library.
fn web_lints(steps: &Steps, modules: &[Package]) {
    for Package { name, .. } in modules {
        let lints = format!("clippy -p {name} --all-features --target {WEB_TARGET} -- -D warnings");
        steps.run(&format!("lints of {name}"), || captured(Workspace::Web, &lints));
    }
}

/// A test program as cargo would run it.
fn tests(program: &TestProgram, host_only: bool) -> Command {
    let mut command = Command::new(&program.file);
    command.current_dir(&program.folder).envs(program.host_tool.iter().map(|tool| (HOST_TOOL, tool)));
    if host_only {
        command.env(setup::HOST_ONLY, "1");
    }
    command
}

/// Runs tests that build firmware, and prints all that they print when they are done.
fn emulated(program: &TestProgram, host_only: bool) -> Result<()> {
    let output = tests(program, host_only).output().with_context(|| format!("cannot start {}", program.file.display()))?;
    print!("{}{}", String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    ensure!(output.status.success(), "{}", program.name);
    Ok(())
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
        setup::mgba().context("(or leave the emulators' tests out with --host-only)")?;
        Browser::ready().context("(or leave Chromium's tests out with --host-only)")?;
    }
    Ok(())
}

/// Cargo, whose messages appear at once.
fn shown(workspace: Workspace, arguments: &str) -> Result<()> {
    let mut command = command(workspace);
    command.args(arguments.split(' '));
    finish(command, arguments)
}

/// Cargo, whose messages appear if it fails.
fn captured(workspace: Workspace, arguments: &str) -> Result<()> {
    let mut command = command(workspace);
    command.args(arguments.split(' '));
    finish_captured(command, arguments)
}

/// Cargo on a board's package; `last` follows what the target's core library asks for.
fn board(arguments: &str, last: &str, target: &str) -> Result<()> {
    let core = Core::of(target);
    let mut command = command(Workspace::Firmware);
    command.args(arguments.split(' ')).args(core.arguments).args(last.split_whitespace()).envs(core.environment);
    finish_captured(command, arguments)
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

fn finish(mut command: Command, what: &str) -> Result<()> {
    let status = command.status().with_context(|| format!("cannot start {what}"))?;
    ensure!(status.success(), "{what}");
    Ok(())
}

fn finish_captured(mut command: Command, what: &str) -> Result<()> {
    let output = command.output().with_context(|| format!("cannot start {what}"))?;
    if !output.status.success() {
        print!("{}{}", String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    }
    ensure!(output.status.success(), "{what}");
    Ok(())
}
