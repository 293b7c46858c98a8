//! Images to flash a board with that one need not build: for each board and display a file as the board takes it.

mod page;
mod wires;

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};

use crate::build::Firmware;
use crate::{chip, gba, segments, sha256, uf2};

pub use page::page;
pub use wires::{BOARDS, Board, Bus, SETS, Wiring};

/// A display that an image is for.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// The feature of the boards' crates; none for the SSD1306.
    pub feature: &'static str,
    /// As it is in a file's name.
    pub name: &'static str,
    /// As makers know it.
    pub title: &'static str,
    /// How it is connected.
    pub bus: Bus,
}

/// The displays by name: docs/BOARDS.md.
pub const DISPLAYS: [Shown; 10] = [
    Shown { feature: "", name: "ssd1306", title: "SSD1306, 128x64 (0.96\")", bus: Bus::I2c },
    Shown { feature: "sh1106", name: "sh1106", title: "SH1106, 128x64 (1.3\")", bus: Bus::I2c },
    Shown { feature: "ssd1306-128x32", name: "ssd1306-128x32", title: "SSD1306, 128x32 (0.91\")", bus: Bus::I2c },
    Shown { feature: "ssd1306-72x40", name: "ssd1306-72x40", title: "SSD1306, 72x40 (0.42\")", bus: Bus::I2c },
    Shown { feature: "st7789", name: "st7789", title: "ST7789, 240x240 (1.3\", 1.54\")", bus: Bus::Spi },
    Shown { feature: "st7789-135x240", name: "st7789-135x240", title: "ST7789, 135x240 (1.14\")", bus: Bus::Spi },
    Shown { feature: "st7789-170x320", name: "st7789-170x320", title: "ST7789, 170x320 (1.9\")", bus: Bus::Spi },
    Shown { feature: "st7789-240x320", name: "st7789-240x320", title: "ST7789, 240x320 (2\", 2.4\")", bus: Bus::Spi },
    Shown { feature: "ili9341", name: "ili9341", title: "ILI9341, 240x320 (2.4\", 2.8\")", bus: Bus::Spi },
    Shown { feature: "gc9a01", name: "gc9a01", title: "GC9A01, round, 240x240 (1.28\")", bus: Bus::Spi },
];

/// How a board takes an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A file to drag onto the drive of the RP2040.
    Uf2,
    /// A file to drag onto the drive of the RP2350.
    Uf2Rp2350,
    /// A file to drag onto the drive of a boot loader for the nRF52840.
    Uf2Nrf52840,
    /// Intel HEX, to drag onto the drive of a debug chip.
    Hex,
    /// The flash's bytes from this address on.
    Bin(u32),
    /// The linked program, which `espflash` takes.
    Elf,
    /// A cartridge.
    Gba,
}

impl Format {
    /// The file name's extension.
    pub const fn extension(self) -> &'static str {
        match self {
            Format::Uf2 | Format::Uf2Rp2350 | Format::Uf2Nrf52840 => "uf2",
            Format::Hex => "hex",
            Format::Bin(_) => "bin",
            Format::Elf => "elf",
            Format::Gba => "gba",
        }
    }
}

/// An image of a board.
#[derive(Clone, Copy, Debug)]
pub struct Image {
    /// The board.
    pub board: &'static Board,
    /// The program of the board's package.
    pub program: &'static str,
    /// Its display, unless the board has its own.
    pub display: Option<Shown>,
}

/// A file of the folder.
#[derive(Clone, Debug)]
pub struct File {
    /// What it is.
    pub image: Image,
    /// Its name.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// How many bytes of flash it takes.
    pub flash: u64,
}

impl Board {
    /// The images of a board: its program for each display, and its further programs for the first.
    pub fn images(&'static self) -> Vec<Image> {
        let image = |program, display| Image { board: self, program, display };
        if self.wirings.is_empty() {
            return vec![image(self.package, None)];
        }
        let displays = DISPLAYS.into_iter().filter(|display| self.takes(display));
        let programs = displays.map(|display| image(self.package, Some(display)));
        programs.chain(self.programs.iter().map(|program| image(program, Some(DISPLAYS[0])))).collect()
    }

    /// The display that it has, or takes if nobody chooses one.
    pub fn first_display(&'static self) -> Option<Shown> {
        DISPLAYS.into_iter().find(|display| self.takes(display))
    }

    /// Whether it takes a display: the board has its bus, and no display of its own, or this is its own.
    pub fn takes(&self, display: &Shown) -> bool {
        let is_offered = self.displays.is_empty() || self.displays.contains(&display.name);
        // The micro:bit's LEDs show a part of a picture of 128x64 pixels.
        let is_too_small = self.package == "microbit-v2" && display.feature.starts_with("ssd1306-");
        is_offered && !is_too_small && self.wiring(display.bus).is_some()
    }

    /// The feature of its pins, or nothing.
    fn pins_feature(&self) -> String {
        self.pins.map_or(String::new(), |pins| format!("pins-{pins}"))
    }

    /// The wires of a display's bus, if the board has it.
    pub fn wiring(&self, bus: Bus) -> Option<&'static Wiring> {
        self.wirings.iter().find(|wiring| wiring.bus == Some(bus))
    }
}

impl Image {
    /// The file's name without extension.
    fn stem(&self) -> String {
        let name = if self.program == self.board.package { String::new() } else { format!("-{}", self.program) };
        let display = self.display.map_or(String::new(), |display| format!("-{}", display.name));
        format!("pantin-{}{name}{display}", self.board.name)
    }

    /// Builds it with these clips.
    pub fn build(&self, clips: &[PathBuf]) -> Result<File> {
        let name = format!("{}.{}", self.stem(), self.board.format.extension());
        let features = if self.program == self.board.package { self.board.features } else { "" };
        let firmware = self.firmware(features, clips).with_context(|| name.clone())?;
        let package = self.board.package;
        let flash = crate::image::loaded(firmware.elf())?;
        let elf = std::fs::read(firmware.elf()).context("the program cannot be read")?;
        chip::check(package, &elf)?;
        let bytes = written(&elf, self.board.format).with_context(|| name.clone())?;
        Ok(File { image: *self, name, bytes, flash })
    }

    /// Builds its program with these features beside those of display and pins.
    pub fn firmware(&self, features: &str, clips: &[PathBuf]) -> Result<Firmware> {
        let pins = self.board.pins_feature();
        let features = [features, self.display.map_or("", |display| display.feature), &pins].join(",");
        let Board { package, target, rotation, .. } = *self.board;
        let clips: Vec<_> = clips.iter().map(PathBuf::as_path).collect();
        Firmware::released(&features, package, self.program, target, &clips, rotation)
    }
}

impl File {
    /// Its SHA-256.
    pub fn sum(&self) -> String {
        sha256::hex(&self.bytes)
    }
}

/// The file `SHA256SUMS`, which `sha256sum --check` reads.
pub fn sums(files: &[File]) -> String {
    files.iter().map(|file| sha256::line(&file.bytes, &file.name)).collect()
}

/// A linked program as the board takes it.
fn written(elf: &[u8], format: Format) -> Result<Vec<u8>> {
    match format {
        Format::Uf2 => uf2::of_elf(elf),
        Format::Uf2Rp2350 => uf2::of_rp2350_elf(elf),
        Format::Uf2Nrf52840 => uf2::of_nrf52840_elf(elf),
        Format::Hex => hex(elf),
        Format::Bin(start) => bin(elf, start),
        Format::Elf => Ok(elf.to_vec()),
        Format::Gba => gba::of_elf(elf),
    }
}

/// The parts of a program that are loaded, by their addresses in the flash.
fn parts(elf: &[u8]) -> Result<Vec<(u32, &[u8])>> {
    let mut parts: Vec<_> = segments::of_elf(elf)?.into_iter().map(|segment| (segment.load, segment.bytes)).collect();
    parts.retain(|(_, bytes)| !bytes.is_empty());
    parts.sort_by_key(|(address, _)| *address);
    ensure!(!parts.is_empty(), "the program is empty");
    Ok(parts)
}

fn bin(elf: &[u8], start: u32) -> Result<Vec<u8>> {
    let mut image = vec![];
    for (address, bytes) in parts(elf)? {
        let from = address.checked_sub(start).context("a segment lies before the flash")? as usize;
        ensure!(from >= image.len() && from < 1 << 24, "a segment lies at {address:#010x}, which is not in the flash");
        image.resize(from, 0xff);
        image.extend(bytes);
    }
    Ok(image)
}

fn hex(elf: &[u8]) -> Result<Vec<u8>> {
    const RECORD: usize = 16;
    let (mut records, mut upper) = (vec![], None);
    for (address, bytes) in parts(elf)? {
        // Records do not cross a multiple of 64 KiB: their addresses begin at one of `RECORD`.
        let mut at = address;
        let mut rest = bytes;
        while !rest.is_empty() {
            let (line, after) = rest.split_at(rest.len().min(RECORD - at as usize % RECORD));
            if upper != Some(at >> 16) {
                upper = Some(at >> 16);
                records.push(ihex::Record::ExtendedLinearAddress((at >> 16) as u16));
            }
            records.push(ihex::Record::Data { offset: at as u16, value: line.to_vec() });
            at += line.len() as u32;
            rest = after;
        }
    }
    records.push(ihex::Record::EndOfFile);
    Ok(ihex::create_object_file_representation(&records)?.into_bytes())
}
