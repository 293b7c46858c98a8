//! `cargo xtask test [OPTIONS]`: checks and tests in groups, on the host, in emulators and in browsers; what CI runs.
//!
//! ```text
//! $ cargo xtask test
//! == tools
//!    0.1 s: tools
//! == format
//! ...
//! step                                          seconds
//! tools                                             0.1
//! ...
//! ```

mod cargo;
mod group;
mod lints;

use std::process::Command;
use std::sync::mpsc::channel;
use std::thread;

use anyhow::{Context, Result, bail};
use xtask::browser::Browser;
use xtask::packages::{self, Package};
use xtask::setup;
use xtask::steps::Steps;
use xtask::test_programs::{self, Built, HOST_TOOL, TestProgram};

use crate::{public_items, publish};
use cargo::{Workspace, finish, finish_quietly};
use group::{CAPTURED, Group};

/// With less no test can be linked. A first run of the daily tests takes about 2,200.
const LEAST_FREE_MEGABYTES: u64 = 500;

/// The host tool's package.
const HOST_PACKAGE: &str = "pantin-tools";

const USAGE: &str = "Usage: cargo xtask test [OPTIONS]

Runs checks and tests. Without options: formatting, lints, the tests on the host, the golden vectors, and one emulated
board of each architecture

Options, of which several can be given:
  --all        Everything, in one run
  --boards     Every board's images in emulators, their sizes, the decoder on every core
  --bindings   The decoders in C, Arduino, MicroPython and JavaScript, and the Python package: needs compilers for other targets
  --web        The page and the player in Chromium, the page also in Firefox and WebKit if they are installed
  --packages   Documentation and its tests, packed crates, public items, the oldest Rust
  --captures   The encoder's bounds on captured clips, which are in the folder that $PANTIN_DATA names
  --host-only  Leaves out what needs an emulator or a browser";

/// Runs all steps of the groups, failed ones too, then lists them.
pub fn run(arguments: &[String]) -> Result<()> {
    if arguments.iter().any(|argument| ["--help", "-h"].contains(&argument.as_str())) {
        println!("{USAGE}");
        return Ok(());
    }
    let (host_only, options): (Vec<String>, Vec<String>) =
        arguments.iter().cloned().partition(|argument| argument == "--host-only");
    let Ok(groups) = Group::named(&options) else { bail!("{USAGE}") };
    Plan::new(groups, !host_only.is_empty())?.run()
}

/// What is to be run.
struct Plan {
    groups: Vec<Group>,
    host_only: bool,
    /// Boards and other images of the groups. Their lints, which build for the target once more, are in the group of boards.
    boards: Vec<Package>,
    /// The firmware's libraries.
    libraries: Vec<Package>,
}

impl Plan {
    fn new(groups: Vec<Group>, host_only: bool) -> Result<Plan> {
        let (boards, libraries): (Vec<_>, Vec<_>) =
            packages::firmware()?.into_iter().partition(|package| !package.targets.is_empty());
        let wanted = |board: &Package| groups.contains(&Group::Boards) || board.daily && groups.contains(&Group::Daily);
        let boards = boards.into_iter().filter(wanted).collect();
        Ok(Plan { groups, host_only, boards, libraries })
    }

    fn has(&self, group: Group) -> bool {
        self.groups.contains(&group)
    }

    fn run(&self) -> Result<()> {
        setup::free_disk(LEAST_FREE_MEGABYTES)?;
        let steps = Steps::default();
        steps.run("tools", || self.tools());
        if self.has(Group::Daily) {
            lints::format(&steps);
        }
        // Two lanes: an image is linked by one thread, and emulators wait often. One prints as it goes, the other after each step.
        let (built, there) = channel();
        thread::scope(|scope| {
            let steps = &steps;
            scope.spawn(move || {
                self.firmware(steps);
                // None where they could not be built.
                if let Ok(built) = there.recv() {
                    self.in_emulators(steps, &built);
                }
            });
            let mut here = None;
            if self.groups.iter().any(|group| *group != Group::Packages) {
                steps.run("build of the test programs", || {
                    let all = test_programs::build()?;
                    here = Some(all.clone());
                    built.send(all).context("the second lane is gone")
                });
            }
            drop(built);
            self.on_the_host(steps, here.as_ref());
        });
        steps.finish()
    }

    /// What runs beside the tests on the host: it mostly waits for one thread.
    fn firmware(&self, steps: &Steps) {
        if self.has(Group::Boards) {
            lints::libraries(steps, &self.libraries);
            lints::boards(steps, &self.boards);
        }
        if self.has(Group::Web) {
            match packages::web() {
                Ok(modules) => lints::web(steps, &modules),
                Err(error) => steps.run("lints of the web modules", || Err(error)),
            }
            lints::book(steps);
        }
    }

    /// Tests that build images and wait for emulators and browsers.
    fn in_emulators(&self, steps: &Steps, built: &Built) {
        for group in &self.groups {
            if let (Some(filters), Some(suites)) = (group.suites(), built.program("harness", "suites")) {
                steps.run(&format!("emulators and pictures: {}", name(*group)), || {
                    let mut command = self.command(suites, built);
                    command.args(filters);
                    finish_quietly(command, "suites")
                });
            }
        }
        if self.has(Group::Boards)
            && !self.host_only
            && let Some(boards) = built.program("harness", "boards")
        {
            steps.run("emulators and pictures: further boards", || finish_quietly(self.command(boards, built), "boards"));
        }
    }

    fn on_the_host(&self, steps: &Steps, built: Option<&Built>) {
        if let Some(built) = built {
            if self.has(Group::Daily) {
                for program in built.programs.iter().filter(|program| program.package != "harness" || program.name == "harness") {
                    steps.run(&format!("tests of {}: {}", program.package, program.name), || {
                        let mut command = self.command(program, built);
                        if program.package == HOST_PACKAGE {
                            command.args(["--skip", CAPTURED]);
                        }
                        finish(command, &program.name)
                    });
                }
            }
            if let (true, Some(suites)) = (self.has(Group::Captures), built.program(HOST_PACKAGE, "suites")) {
                steps.run("captured clips", || {
                    let mut command = self.command(suites, built);
                    command.arg(CAPTURED);
                    finish(command, &suites.name)
                });
            }
            if self.has(Group::Boards) && !self.host_only {
                steps.run("sizes of all images", || built.xtask("sizes"));
            }
            if self.has(Group::Bindings) {
                steps.run("other languages", || built.xtask("bindings"));
            }
        }
        if self.has(Group::Daily) {
            lints::host(steps);
        }
        if self.has(Group::Packages) {
            steps.run("documentation tests", || Workspace::Host.shown("test --workspace --doc"));
            steps.run("documentation and public items", || public_items::run(&[]));
            steps.run("packages", || publish::package(&[]));
            steps.run("oldest Rust", || publish::msrv(&[]));
        }
    }

    /// A test program as cargo would run it.
    fn command(&self, program: &TestProgram, built: &Built) -> Command {
        let mut command = Command::new(&program.file);
        // Tests of the host tool wait for terminals and lines about as long as they work.
        if program.package == HOST_PACKAGE {
            command.arg("--test-threads=4");
        }
        command.current_dir(&program.folder).envs(built.host_tool.iter().map(|tool| (HOST_TOOL, tool)));
        if self.host_only {
            command.env(setup::HOST_ONLY, "1");
        }
        command
    }

    /// Installs what the groups need, or says what is missing.
    fn tools(&self) -> Result<()> {
        for component in ["rustfmt", "clippy"] {
            setup::component(component)?;
        }
        for target in self.boards.iter().flat_map(|board| &board.targets) {
            setup::rust_target(target)?;
        }
        if self.has(Group::Web) {
            setup::rust_target(lints::WEB_TARGET)?;
            setup::install_emulator("clang")?;
        }
        if self.host_only {
            return Ok(());
        }
        if self.has(Group::Daily) || self.has(Group::Boards) {
            for program in ["qemu-system-arm", "qemu-system-riscv32", "node"] {
                setup::install_emulator(program).context("(or leave QEMU's tests out with --host-only)")?;
            }
        }
        if self.has(Group::Boards) {
            setup::install_emulator("npm").context("(or leave the emulators' tests out with --host-only)")?;
            setup::mgba().context("(or leave the emulators' tests out with --host-only)")?;
        }
        if self.has(Group::Web) {
            Browser::ready().context("(or leave Chromium's tests out with --host-only)")?;
        }
        Ok(())
    }
}

fn name(group: Group) -> &'static str {
    match group {
        Group::Daily => "daily",
        group => group.option().trim_start_matches('-'),
    }
}
