//! `cargo xtask uf2 pico [--clip FILE]... [--display st7789] [--update] [-o OUT]`: a file to drag onto the board's drive.
//!
//! ```text
//! $ cargo xtask uf2 pico --clip walk.ptn
//! pico.uf2: 58,880 bytes of flash. Hold BOOTSEL while you plug the board in, and drag the file onto the drive RPI-RP2.
//! ```

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use harness::build::Firmware;
use harness::download::DISPLAYS;
use harness::{clips, image, rp2040, uf2};

/// The Rust target of the Pico 2.
const PICO2_TARGET: &str = "thumbv8m.main-none-eabihf";

/// Makes a file to drag onto a board's drive
#[derive(Args)]
pub struct Uf2 {
    /// The board
    board: Board,
    /// A clip to build in instead of our own; may be given several times
    #[arg(long, value_name = "FILE")]
    clip: Vec<PathBuf>,
    /// Its display
    #[arg(long, default_value = DISPLAYS[0].name, value_parser = PossibleValuesParser::new(DISPLAYS.map(|display| display.name)))]
    display: String,
    /// Keep clips in a reserved part of the flash, which `pantin update` and `pantin flash-image` replace
    #[arg(long)]
    update: bool,
    /// The file [default: BOARD.uf2]
    #[arg(short, value_name = "OUT")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Board {
    /// Raspberry Pi Pico
    Pico,
    /// Raspberry Pi Pico 2, which has no replaceable clips
    #[value(name = "pico2")]
    Pico2,
}

impl Uf2 {
    /// Builds the program and writes the file.
    pub fn run(self) -> Result<()> {
        let clips: Vec<&Path> = self.clip.iter().map(PathBuf::as_path).collect();
        // Our own come with faces.
        let face = if clips.is_empty() { "face" } else { clips::feature(&clips)? };
        let display = DISPLAYS.iter().find(|display| display.name == self.display).map_or("", |display| display.feature);
        let (board, target, drive) = match self.board {
            Board::Pico => ("pico", rp2040::TARGET, "RPI-RP2"),
            Board::Pico2 => ("pico2", PICO2_TARGET, "RP2350"),
        };
        ensure!(!self.update || board == "pico", "only the Pico has replaceable clips");
        let update = if self.update { "update" } else { "" };
        let firmware = Firmware::released(&[face, display, update, "usb"].join(","), board, board, target, &clips)?;
        let elf = std::fs::read(firmware.elf()).context("the program cannot be read")?;
        let file = if board == "pico" { uf2::of_elf(&elf)? } else { uf2::of_rp2350_elf(&elf)? };
        let out = self.out.unwrap_or(format!("{board}.uf2").into());
        let part = out.with_extension("part");
        let written = std::fs::write(&part, file).and_then(|()| std::fs::rename(&part, &out));
        written.with_context(|| format!("cannot write {}", out.display()))?;
        let flash = image::loaded(firmware.elf())?;
        let advice = format!("Hold BOOTSEL while you plug the board in, and drag the file onto the drive {drive}.");
        println!("{}: {flash} bytes of flash. {advice}", out.display());
        Ok(())
    }
}
