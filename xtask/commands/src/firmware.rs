//! `cargo xtask firmware [BOARD]... [--clip FILE]...`: every board's images, and how each gets onto its board.
//!
//! ```text
//! $ cargo xtask firmware pico
//! board  target              image                           flash     RAM
//! pico   thumbv6m-none-eabi  target/firmware/pico.elf        58716    1100
//! ...
//! ```

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use harness::qemu::BOARDS;
use harness::{chip, clips, paths, setup, uf2};

use crate::images::{self, Image};
use xtask::packages::Package;
use xtask::steps::say;

/// Builds every board's images into target/firmware, and prints how to flash them
#[derive(Args)]
pub struct Firmware {
    /// Boards to build [default: all]
    board: Vec<String>,
    /// A clip to build in instead of our own; may be given several times
    #[arg(long, value_name = "FILE")]
    clip: Vec<PathBuf>,
}

impl Firmware {
    /// Builds all that build, lists them, and fails if one did not.
    pub fn run(self) -> Result<()> {
        let clips: Vec<&Path> = self.clip.iter().map(PathBuf::as_path).collect();
        // Before minutes of builds, each clip is read.
        let faces = clips::feature(&clips)?;
        let boards = images::boards(&self.board)?;
        std::fs::create_dir_all(folder()).with_context(|| format!("cannot make {}", folder().display()))?;
        let (mut rows, mut failures) = (vec![], vec![]);
        for board in &boards {
            for image in images::of(board) {
                say(&format!("== {}", image.name));
                match made(&image, &clips) {
                    Ok(row) => rows.push(row),
                    Err(error) => failures.push(format!("{error:#}")),
                }
            }
        }
        say("");
        print(&rows);
        boards.iter().for_each(|board| say(&format!("\n{}", advice(board))));
        missing(&boards);
        if faces == "face" {
            say("\nA clip drives a face, which only the images with -face show.");
        }
        match failures.len() {
            0 => Ok(()),
            count => bail!("{count} of {} images could not be made:\n  {}", count + rows.len(), failures.join("\n  ")),
        }
    }
}

fn folder() -> PathBuf {
    paths::root().join("target/firmware")
}

/// Builds an image and puts it into the folder; its row in the table.
fn made(image: &Image, clips: &[&Path]) -> Result<[String; 5]> {
    let firmware = image.build(clips)?;
    let [flash, ram] = images::flash_and_ram(&firmware)?;
    let elf = std::fs::read(firmware.elf()).context("the image cannot be read")?;
    chip::check(&image.package, &elf)?;
    if image.package == "pico" {
        write(&format!("{}.uf2", image.name), &uf2::of_elf(&elf).with_context(|| image.name.clone())?)?;
    }
    if image.package == "pico2" {
        write(&format!("{}.uf2", image.name), &uf2::of_rp2350_elf(&elf).with_context(|| image.name.clone())?)?;
    }
    let file = write(&format!("{}.elf", image.name), &elf)?;
    Ok([image.package.clone(), image.target.clone(), file, flash.to_string(), ram.to_string()])
}

/// Writes a file of the folder, whole or not at all; its name from the root.
fn write(name: &str, bytes: &[u8]) -> Result<String> {
    let (path, part) = (folder().join(name), folder().join(format!("{name}.part")));
    let written = std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, &path));
    written.with_context(|| format!("cannot write {}", path.display()))?;
    Ok(format!("target/firmware/{name}"))
}

fn print(rows: &[[String; 5]]) {
    let heads = ["board", "target", "image", "flash", "RAM"].map(String::from);
    let all = || [&heads].into_iter().chain(rows);
    let widths: [usize; 5] = std::array::from_fn(|column| all().map(|row| row[column].len()).max().unwrap_or(0));
    let [board, target, file, flash, ram] = widths;
    for row in all() {
        let [a, b, c, d, e] = row;
        say(&format!("{a:<board$}  {b:<target$}  {c:<file$}  {d:>flash$}  {e:>ram$}"));
    }
}

/// How a board's images get onto it.
fn advice(board: &Package) -> String {
    let name = &board.name;
    let mut ways = vec![];
    if let Some(drive) =
        [("pico", "RPI-RP2"), ("pico2", "RP2350")].iter().find(|(board, _)| board == name).map(|(_, drive)| drive)
    {
        ways.push(format!(
            "hold BOOTSEL while you plug it in, and drag target/firmware/{name}.uf2, or another, onto the drive {drive}"
        ));
    }
    if name == "gba" {
        ways.push("cargo xtask gba makes pantin.gba, which emulators play, with all our motions".to_owned());
    } else if let Some(runner) = board.runner() {
        ways.push(format!("{runner} target/firmware/{name}.elf"));
    } else if BOARDS.iter().any(|machine| machine.name == name) {
        ways.push(format!("emulated: cargo xtask demo --board {name}"));
    } else if ways.is_empty() {
        ways.push(format!("see firmware/boards/{name}"));
    }
    let emulated = BOARDS.iter().any(|machine| machine.name == name) || name == "gba";
    let checked = match chip::of(name) {
        Some(_) => ": its images lie in the chip's flash and RAM, with the stack",
        None if emulated => "",
        None => ": NOT checked whether its images lie in the chip's flash and RAM: tests/harness/chip.rs does not know the chip",
    };
    format!("{name}{checked}\n       {}", ways.join("\n   or: "))
}

/// Says which programs that put images on these boards are not there: nothing here needs them.
fn missing(boards: &[Package]) {
    let runners = boards.iter().filter_map(Package::runner);
    let mut tools: Vec<String> = runners.filter_map(|runner| runner.split(' ').next().map(String::from)).collect();
    tools.sort();
    tools.dedup();
    for tool in tools.iter().filter(|tool| paths::program(tool).is_none()) {
        say(&format!("\n{tool} is missing, which flashes boards: {}", setup::flasher_advice(tool)));
    }
}
