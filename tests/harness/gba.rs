//! The Game Boy Advance's cartridge image in mGBA, without a window: `tests/gba/run.c`.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;

use anyhow::{Context, Result, ensure};
use tempfile::TempDir;

use crate::build::Firmware;
use crate::display::{Depth, Display, Picture, Way};
use crate::segments::{self, Segment};
use crate::{paths, setup};

/// The Rust target of its programs.
pub const TARGET: &str = "armv4t-none-eabi";
/// The console's display.
pub const LCD: Display = Display { width: 240, height: 160, depth: Depth::Bgr555, way: Way::Bus("gba") };
/// Clock cycles of a frame of the display.
pub const FRAME_CYCLES: u32 = 280_896;
/// Most bytes of an image with all our motions, whose figures are lines.
pub const MOST: usize = 256 * 1024;
/// Most bytes where bodies have volume: joints keep how they are turned.
pub const MOST_SOLID: usize = 384 * 1024;

/// Where cartridges begin in the console's memory.
const CARTRIDGE: u64 = 0x0800_0000;
const HEADER: usize = 0xc0;

/// Features of the program that draws lines, and of the one that draws bodies with volume.
pub const LINES: &str = "face,steer";
/// See [`LINES`].
pub const SOLID: &str = "face,steer,solid,neck";

/// Builds the program with these features and clips, and returns the cartridge's image.
pub fn image(features: &str, clips: &[&Path]) -> Result<Vec<u8>> {
    let firmware = Firmware::featuring(features, "gba", "gba", TARGET, clips)?;
    of_elf(&std::fs::read(firmware.elf()).context("the program cannot be read")?)
}

/// Returns the cartridge's image of a linked program.
pub fn of_elf(elf: &[u8]) -> Result<Vec<u8>> {
    let mut image = vec![];
    for Segment { load, bytes, .. } in segments::of_elf(elf)? {
        if !bytes.is_empty() {
            let start = u64::from(load).checked_sub(CARTRIDGE);
            let start = start.context("a segment lies before the cartridge")? as usize;
            image.resize(image.len().max(start + bytes.len()), 0);
            image[start..start + bytes.len()].copy_from_slice(bytes);
        }
    }
    ensure!(image.len() > HEADER, "the program is empty");
    image.resize(image.len().next_multiple_of(4), 0);
    Ok(image)
}

/// A stretch of the program between two marks.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// The display's frame in which it ended.
    pub frame: u32,
    /// Clock cycles.
    pub cycles: u32,
    /// Instructions.
    pub instructions: u32,
}

/// A cartridge in the emulator, with the buttons that are held from a frame on, each in its bit.
pub struct Console {
    _folder: TempDir,
    rom: PathBuf,
    keys: Vec<(u32, u16)>,
}

impl Console {
    /// Inserts a cartridge.
    pub fn new(image: &[u8]) -> Result<Self> {
        let folder = tempfile::Builder::new().prefix("pantin-gba-").tempdir().context("cannot make a temporary folder")?;
        let rom = folder.path().join("pantin.gba");
        std::fs::write(&rom, image).context("cannot write the image")?;
        Ok(Self { _folder: folder, rom, keys: vec![] })
    }

    /// Holds buttons from a frame on, and releases the others.
    pub fn hold(mut self, frame: u32, keys: u16) -> Self {
        self.keys.push((frame, keys));
        self
    }

    fn command(&self, words: &[&str], frames: u32) -> Result<Command> {
        let mut command = Command::new(emulator()?);
        command.args(words).arg(&self.rom).arg(frames.to_string());
        command.args(self.keys.iter().map(|(frame, keys)| format!("{frame}:{keys}"))).stdin(Stdio::null());
        Ok(command)
    }

    /// Runs a number of frames and passes the pixels that the display showed in each to `see`: [`picture`] reads them.
    pub fn run(&self, frames: u32, mut see: impl FnMut(u32, &[u8])) -> Result<()> {
        let mut child = self.command(&[], frames)?.stdout(Stdio::piped()).spawn().context("cannot start the emulator")?;
        let mut bytes = vec![0; 2 * LCD.width * LCD.height];
        let mut output = child.stdout.take().context("the emulator has no output")?;
        for frame in 0..frames {
            output.read_exact(&mut bytes).context("the emulator ended early")?;
            see(frame, &bytes);
        }
        ensure!(child.wait()?.success(), "the emulator failed");
        Ok(())
    }

    /// Runs a number of frames and returns the stretches that the program marks.
    pub fn stretches(&self, frames: u32) -> Result<Vec<Stretch>> {
        let output = self.command(&["--cycles"], frames)?.output().context("cannot start the emulator")?;
        ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
        let text = String::from_utf8(output.stdout).context("the emulator printed no text")?;
        let stretch = |line: &str| {
            let mut numbers = line.split(' ').map(|word| word.parse().ok());
            let mut next = || numbers.next().flatten();
            Some(Stretch { frame: next()?, cycles: next()?, instructions: next()? })
        };
        text.lines().map(|line| stretch(line).with_context(|| format!("not a stretch: {line}"))).collect()
    }
}

/// The picture that pixels of the emulator make.
pub fn picture(bytes: &[u8]) -> Picture {
    let pixels = bytes.chunks_exact(2).map(|pixel| u16::from_le_bytes([pixel[0], pixel[1]])).collect();
    Picture { display: LCD, pixels }
}

/// The pixels that the emulator shows for a picture.
pub fn pixels(picture: &Picture) -> Vec<u8> {
    picture.pixels.iter().flat_map(|pixel| pixel.to_le_bytes()).collect()
}

/// Compiles the program that drives mGBA, once, and returns where it lies.
pub fn emulator() -> Result<PathBuf> {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let source = paths::root().join("tests/gba/run.c");
    let program = paths::root().join("target/gba/run");
    let newer = |path: &Path| std::fs::metadata(path).and_then(|data| data.modified()).ok();
    if newer(&program).is_some_and(|built| newer(&source).is_some_and(|written| written < built)) {
        return Ok(program);
    }
    setup::mgba()?;
    std::fs::create_dir_all(paths::root().join("target/gba")).context("cannot make target/gba")?;
    let part = program.with_extension(std::process::id().to_string());
    let output =
        Command::new("cc").args(["-O2", "-Wall", "-Wextra", "-Werror", "-o"]).arg(&part).arg(&source).arg("-lmgba").output();
    let output = output.context("cannot start cc")?;
    ensure!(output.status.success(), "cc {}: {}", source.display(), String::from_utf8_lossy(&output.stderr).trim());
    std::fs::rename(&part, &program).context("cannot keep the compiled program")?;
    Ok(program)
}
