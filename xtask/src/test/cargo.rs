//! Calls of cargo in the workspaces.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use xtask::core_library::Core;
use xtask::paths;

/// A workspace of the repository.
#[derive(Clone, Copy)]
pub enum Workspace {
    /// The root's.
    Host,
    /// Boards and other images.
    Firmware,
    /// The page's modules.
    Web,
    /// What makes a site of the documentation.
    Book,
}

impl Workspace {
    /// A call of cargo there.
    fn command(self) -> Command {
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
        command.current_dir(match self {
            Workspace::Host => paths::root(),
            Workspace::Firmware => paths::firmware(),
            Workspace::Web => paths::root().join("web"),
            Workspace::Book => paths::root().join("xtask/book"),
        });
        if let Workspace::Book = self {
            command.env("CARGO_TARGET_DIR", paths::root().join("target/book"));
        }
        command
    }

    /// Runs cargo; its messages appear at once.
    pub fn shown(self, arguments: &str) -> Result<()> {
        let mut command = self.command();
        command.args(arguments.split(' '));
        finish(command, arguments)
    }

    /// Runs cargo; its messages appear if it fails.
    pub fn captured(self, arguments: &str) -> Result<()> {
        let mut command = self.command();
        command.args(arguments.split(' '));
        finish_captured(command, arguments)
    }
}

/// Runs cargo on a board's package; `last` follows what the target's core library asks for.
pub fn on_board(arguments: &str, last: &str, target: &str) -> Result<()> {
    let core = Core::of(target);
    let mut command = Workspace::Firmware.command();
    command.args(arguments.split(' ')).args(core.arguments).args(last.split_whitespace()).envs(core.environment);
    finish_captured(command, arguments)
}

/// Runs a program; what it prints appears at once.
pub fn finish(mut command: Command, what: &str) -> Result<()> {
    let status = command.status().with_context(|| format!("cannot start {what}"))?;
    ensure!(status.success(), "{what}");
    Ok(())
}

/// Runs a program; what it prints appears if it fails.
pub fn finish_captured(mut command: Command, what: &str) -> Result<()> {
    let output = command.output().with_context(|| format!("cannot start {what}"))?;
    if !output.status.success() {
        print!("{}{}", String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    }
    ensure!(output.status.success(), "{what}");
    Ok(())
}

/// Runs a program; all that it prints appears when it is done.
pub fn finish_quietly(mut command: Command, what: &str) -> Result<()> {
    let output = command.output().with_context(|| format!("cannot start {what}"))?;
    print!("{}{}", String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    ensure!(output.status.success(), "{what}");
    Ok(())
}
