//! `cargo xtask demo --steer` and `--meet`: our character's state machine, steered by a recorded session, or on an emulated board by the user.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::{build, paths, qemu};
use xtask::setup;
use xtask::steps::say;

/// Columns and rows of a picture.
const SIZE: &str = "240x240";
/// Pictures a second of the animation, and pictures on the sheet.
const RATE: &str = "25";
const SHEET: &str = "36";

/// Machines whose program can be steered.
const BOARDS: [&str; 2] = ["lm3s6965evb", "sx1"];

/// Runs the character on an emulated board in a window of its own, until `q` is typed. Letters in the terminal steer it. With `meets` it meets another one.
pub fn live(board: &str, meets: bool) -> Result<()> {
    ensure!(BOARDS.contains(&board), "--board {board}: expected {}", BOARDS.join(" or "));
    let machine = qemu::board(board)?;
    let emulator = setup::install_emulator(machine.emulator)?;
    say(&format!("building the firmware of {board}"));
    let features = if meets { "meet,solid" } else { "steer" };
    let firmware = build::Firmware::featuring(features, machine.name, machine.name, machine.target, &[])?;
    say(
        "type w to walk and again to stop, f to run, space to jump, a and d to turn, s to sit down and stand up,\nh to wave, b to bow, n to dance; q ends",
    );
    let mut command = Command::new(&emulator);
    // The first word is the program's name.
    let words = if meets { ",arg=pantin,arg=solid" } else { "" };
    command.args(["-M", machine.model, "-serial", "stdio", "-monitor", "none"]);
    command.arg("-semihosting-config").arg(format!("enable=on,target=native{words}"));
    let status = command.arg("-kernel").arg(firmware.elf()).status();
    let status = status.with_context(|| format!("cannot start {}", emulator.display()))?;
    ensure!(status.success(), "{} ended with {status}", machine.emulator);
    Ok(())
}

/// Makes the bank and its machine, and leaves `steer.gif`, `steer-sheet.png` and the bank in `out`.
pub fn run(out: &Path) -> Result<()> {
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let tool = build::host_tool()?;
    let pantin = |words: &[&Path], options: &[&str]| -> Result<()> {
        let status =
            Command::new(&tool).args(words).args(options).arg("--quiet").status().context("cannot start the host tool")?;
        ensure!(status.success(), "pantin failed, see above");
        Ok(())
    };
    let motions = paths::root().join("motions");
    let (library, bank) = (out.join("library.ptb"), out.join("character.ptb"));
    say("converting motions/library");
    pantin(
        &["convert".as_ref(), &motions.join("library"), "-o".as_ref(), &library],
        &["--places-only", "--same-form", "--max-error", "0.5cm"],
    )?;
    let machine = motions.join("character.toml");
    pantin(&["machine".as_ref(), &machine, "--bank".as_ref(), &library, "-o".as_ref(), &bank], &[])?;
    say("playing motions/steer.txt");
    let session = motions.join("steer.txt");
    for (name, options) in [
        ("steer.gif", &["--size", SIZE, "--palette", "phone", "--fps", RATE][..]),
        ("steer-sheet.png", &["--size", SIZE, "--palette", "phone", "--sheet", SHEET][..]),
    ] {
        pantin(&["steer".as_ref(), &bank, &session, "-o".as_ref(), &out.join(name)], options)?;
    }
    let bytes = std::fs::metadata(&bank).map_or(0, |file| file.len());
    say(&format!(
        "wrote {} and steer-sheet.png; the bank with its state machine has {bytes} bytes",
        out.join("steer.gif").display()
    ));
    Ok(())
}
