//! `cargo xtask`: the commands of the repository. Those that need the harness are programs of their own, which are built when they
//! are asked for.

mod demo;
mod public_items;
mod publish;
mod test;

use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail, ensure};
use xtask::{paths, shape};

/// Where a command is.
enum Place {
    /// In this program: what runs it with its arguments.
    Here(fn(&[String]) -> Result<()>),
    /// In the program of this package.
    Package(&'static str),
    /// In the program of this package, which is optimized little: people wait for its compilation.
    Quick(&'static str),
    /// In the program of this folder, which is a workspace of its own.
    Alone(&'static str),
}

const COMMANDS: Place = Place::Package("xtask-commands");

/// Every command, where it is and what it does.
const LIST: [(&str, Place, &str); 34] = [
    ("demo", Place::Here(demo::run), "Plays a motion on the display of an emulated board, and prints what it costs"),
    (
        "test",
        Place::Here(test::run),
        "Runs what belongs before a commit; --boards, --bindings, --web, --packages, --captures run other groups, --all everything",
    ),
    ("arduino", COMMANDS, "Writes the Arduino library (also for PlatformIO) to a folder"),
    ("bench", COMMANDS, "Measures size, speed and memory, and compares them with the goals"),
    ("bindings", COMMANDS, "Tests the decoder in C with compilers and emulators; `test --bindings` is the same"),
    ("book", Place::Alone("xtask/book"), "Builds the documentation as a site with search; `web` does it, too"),
    ("blender", COMMANDS, "Imports exports of our clips into Blender (bpy), and validates the glTF files"),
    ("conformance", COMMANDS, "Plays the golden vectors on every core, and compares the CRC of every pose"),
    (
        "coverage",
        COMMANDS,
        "Prints the line coverage of decoder, link and store by their own tests and the sender's; needs cargo-llvm-cov",
    ),
    ("esp-idf", COMMANDS, "Writes the component for ESP-IDF to a folder"),
    ("esphome", COMMANDS, "Writes the ESPHome component of a talking face to a folder"),
    ("firmware", COMMANDS, "Builds every board's images into target/firmware, and prints how to flash them"),
    ("docs", Place::Here(publish::docs), "Builds the documentation of the published crates, with warnings as errors"),
    ("fuzz", COMMANDS, "Fuzzes the entry points for untrusted input; needs a nightly Rust and cargo-fuzz"),
    ("gallery", COMMANDS, "Converts every captured clip and draws one contact sheet of all"),
    ("gba", COMMANDS, "Makes a cartridge image for the Game Boy Advance, with all our motions"),
    ("images", COMMANDS, "Makes a folder of images to flash, with a page that shows each one's wires"),
    ("independent", COMMANDS, "Evaluates clips of captured and random motions with no code of the tool; needs Node.js"),
    ("micropython", COMMANDS, "Writes the MicroPython module in C, and the decoder in Python, to a folder"),
    ("miri", COMMANDS, "Runs the decoder's tests in Miri; needs a nightly Rust"),
    ("mutants-differential", COMMANDS, "Plays damaged clips in two decoders and compares them; needs Node.js"),
    ("mutation", COMMANDS, "Mutates the decoder and lists what its tests do not notice; needs cargo-mutants"),
    ("msrv", Place::Here(publish::msrv), "Checks the published crates with the oldest Rust that they state"),
    ("package", Place::Here(publish::package), "Packs the published crates; --verify compiles each from its package"),
    ("semver", Place::Here(public_items::run), "Compares the public items of the published libraries with the list that is kept"),
    ("shape", Place::Here(shape), "Counts equal lines among the boards, circles of imports, and functions of more than 80 lines"),
    ("sizes", COMMANDS, "Measures flash, RAM and stack of every image, and compares them with tests/sizes.txt"),
    ("soak", COMMANDS, "Plays 24 hours of a clip over a simulated line with damage, restarts and drift"),
    ("strips", COMMANDS, "Plays motions on every emulated board and draws a contact sheet of each"),
    ("train", COMMANDS, "Computes the format's tables from motions, for a new version of the format"),
    ("uf2", COMMANDS, "Makes a file to drag onto a board's drive"),
    ("vectors", COMMANDS, "Makes the golden vectors again"),
    ("web", Place::Quick("xtask-web"), "Builds the web page with its player and our clips"),
    ("wheels", COMMANDS, "Builds the Python package and the program pantin for Linux, Windows and macOS"),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<ExitCode> {
    let Some((name, rest)) = arguments.split_first() else {
        eprint!("{}", help());
        return Ok(ExitCode::from(2));
    };
    if ["help", "--help", "-h"].contains(&name.as_str()) {
        print!("{}", help());
        return Ok(ExitCode::SUCCESS);
    }
    let Some((_, place, _)) = LIST.iter().find(|(known, ..)| known == name) else {
        bail!("no command is called {name}\n\n{}", help());
    };
    match place {
        Place::Here(run) => run(rest).map(|()| ExitCode::SUCCESS),
        Place::Package(package) => program(&["--package", package], arguments),
        Place::Quick(package) => program(&["--profile", "demo", "--package", package], rest),
        Place::Alone(folder) => alone(folder, rest),
    }
}

fn help() -> String {
    let list: String = LIST.iter().map(|(name, _, purpose)| format!("  {name:<20} {purpose}\n")).collect();
    format!("Usage: cargo xtask <COMMAND>\n\nCommands:\n{list}\n`cargo xtask <COMMAND> --help` prints its options.\n")
}

/// Builds the program of a package and runs it; returns its exit code.
fn program(which: &[&str], arguments: &[String]) -> Result<ExitCode> {
    run_to_end(cargo_run(which).args(arguments))
}

/// Builds the program of a folder's own workspace and runs it.
fn alone(folder: &str, arguments: &[String]) -> Result<ExitCode> {
    let manifest = paths::root().join(folder).join("Cargo.toml");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.args(["run", "--quiet", "--manifest-path"]).arg(manifest).arg("--target-dir").arg(paths::root().join("target/book"));
    run_to_end(cargo.arg("--").args(arguments))
}

fn run_to_end(command: &mut Command) -> Result<ExitCode> {
    let status = command.status().context("cannot start cargo")?;
    Ok(status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}

/// `cargo run` for a program of the repository, to which its arguments are added.
fn cargo_run(program: &[&str]) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    cargo.arg("run").arg("--manifest-path").arg(paths::root().join("Cargo.toml")).args(program).arg("--");
    cargo
}

fn shape(arguments: &[String]) -> Result<()> {
    ensure!(arguments.is_empty(), "Usage: cargo xtask shape");
    shape::print()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_reference_names_every_command() {
        let reference = std::fs::read_to_string(paths::root().join("docs/CLI.md")).unwrap();
        for (name, ..) in LIST {
            assert!(reference.contains(&format!("| `cargo xtask {name}")), "docs/CLI.md has no row for cargo xtask {name}");
        }
    }

    #[test]
    fn pages_name_commands_that_exist() {
        let pages = xtask::pages::all().unwrap().unwrap_or_default();
        let unknown = |word: &&str| !LIST.iter().any(|(name, ..)| name == word);
        let pages = pages.iter().filter(|page| page.path != "CHANGELOG.md");
        let found: Vec<(&str, &str)> =
            pages.flat_map(|page| page.commands().filter(unknown).map(|word| (page.path.as_str(), word))).collect();
        assert_eq!(found, [], "no command of cargo xtask has this name");
    }
}
