//! `cargo xtask uf2 pico [--pins SET] [--clip FILE]... [--display st7789] [--update] [-o OUT]`: a file to drag onto the board's drive.
//!
//! ```text
//! $ cargo xtask uf2 pico --clip walk.ptn
//! pico.uf2: 58,880 bytes of flash. Hold BOOTSEL while you plug the board in, and drag the file onto the drive RPI-RP2.
//! ```

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::Args;
use clap::builder::PossibleValuesParser;
use harness::download::{BOARDS, Board, DISPLAYS, Format, Image, SETS};
use harness::{clips, image, uf2};

/// Makes a file to drag onto a board's drive
#[derive(Args)]
pub struct Uf2 {
    /// The board, or one with pins of its own: xiao-rp2040, xiao-nrf52840
    #[arg(value_parser = PossibleValuesParser::new(takers().map(|board| board.name)))]
    board: String,
    /// Its set of pins, where another board carries it or has its chip: docs/BOARDS.md lists them [default: plain]
    #[arg(long, value_name = "SET", value_parser = PossibleValuesParser::new(sets()))]
    pins: Option<String>,
    /// A clip to build in instead of our own; may be given several times
    #[arg(long, value_name = "FILE")]
    clip: Vec<PathBuf>,
    /// Its display [default: the board's own, or ssd1306]
    #[arg(long, value_parser = PossibleValuesParser::new(DISPLAYS.map(|display| display.name)))]
    display: Option<String>,
    /// Keep clips in a reserved part of the flash, which `pantin update` and `pantin flash-image` replace
    #[arg(long)]
    update: bool,
    /// The file [default: BOARD.uf2]
    #[arg(short, value_name = "OUT")]
    out: Option<PathBuf>,
}

/// The boards that take UF2 files.
fn takers() -> impl Iterator<Item = &'static Board> {
    let takes = |board: &&Board| matches!(board.format, Format::Uf2 | Format::Uf2Rp2350 | Format::Uf2Nrf52840);
    BOARDS.iter().chain(&SETS).filter(takes)
}

/// The names of their sets of pins.
fn sets() -> Vec<&'static str> {
    let mut sets: Vec<_> = takers().map(|board| board.pins.unwrap_or("plain")).collect();
    sets.sort_unstable();
    sets.dedup();
    sets
}

impl Uf2 {
    /// Builds the program and writes the file.
    pub fn run(self) -> Result<()> {
        let board = self.board()?;
        let display = match &self.display {
            Some(name) => DISPLAYS.into_iter().find(|display| display.name == *name),
            None => board.first_display(),
        };
        let display = display.filter(|display| board.takes(display)).context("this board does not take this display")?;
        let clips: Vec<&Path> = self.clip.iter().map(PathBuf::as_path).collect();
        // Our own come with faces.
        let face = if clips.is_empty() { "face" } else { clips::feature(&clips)? };
        let is_rp2350 = board.format == Format::Uf2Rp2350;
        ensure!(!(self.update && is_rp2350), "the Pico 2 has no replaceable clips");
        let update = if self.update { "update" } else { "" };
        let usb = if board.format == Format::Uf2Nrf52840 { "" } else { "usb" };
        let image = Image { board, program: board.package, display: Some(display) };
        let firmware = image.firmware(&[face, update, usb].join(","), &self.clip)?;
        let elf = std::fs::read(firmware.elf()).context("the program cannot be read")?;
        let (file, advice) = match board.format {
            Format::Uf2Nrf52840 => {
                (uf2::of_nrf52840_elf(&elf)?, "Press the reset button twice, and drag the file onto the board's drive.")
            }
            Format::Uf2Rp2350 => {
                (uf2::of_rp2350_elf(&elf)?, "Hold BOOTSEL while you plug the board in, and drag the file onto the drive RP2350.")
            }
            _ => (uf2::of_elf(&elf)?, "Hold BOOTSEL while you plug the board in, and drag the file onto the drive RPI-RP2."),
        };
        let out = self.out.unwrap_or(format!("{}.uf2", board.name).into());
        let part = out.with_extension("part");
        let written = std::fs::write(&part, file).and_then(|()| std::fs::rename(&part, &out));
        written.with_context(|| format!("cannot write {}", out.display()))?;
        println!("{}: {} bytes of flash. {advice}", out.display(), image::loaded(firmware.elf())?);
        Ok(())
    }

    /// The board with its set of pins.
    fn board(&self) -> Result<&'static Board> {
        let named = takers().find(|board| board.name == self.board).context("no board has this name")?;
        let Some(pins) = &self.pins else { return Ok(named) };
        let pins = (pins != "plain").then_some(pins.as_str());
        match takers().find(|board| board.package == named.package && board.pins == pins) {
            Some(board) => Ok(board),
            None => bail!("{} has no set of pins of this name", named.name),
        }
    }
}
