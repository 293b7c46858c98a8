//! Our character's state machine, steered by the recorded session: its poses and its pictures.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use conformance::RATE;
use pantin_animator::Character;
use pantin_animator::machine::{FEET_SECTION, Table};
use pantin_animator::session::{Input, Replay};
use pantin_app::CHARACTER_KEYS;
use pantin_figure::surface::{Framebuffer, Gray4Rows};
use pantin_figure::{DrawStyle, View};
use pantin_pictures::machine::playback::{Stage, play, session};

use crate::build::Firmware;
use crate::display::{OLED, Picture};
use crate::qemu::{Launch, Machine};
use crate::sync::Session;
use crate::vectors::record::Crcs;
use crate::{paths, screen, simulator};

/// The bank with its state machine.
pub fn bank() -> PathBuf {
    paths::root().join("motions/character.ptb")
}

/// The session.
pub fn script() -> PathBuf {
    Program::Steer.script()
}

/// What a board plays of our character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// It is steered.
    Steer,
    /// It meets another one.
    Meet,
}

impl Program {
    /// The feature of a board that plays it.
    fn feature(self) -> &'static str {
        if self == Program::Meet { "meet" } else { "steer" }
    }

    /// The recorded session.
    fn script(self) -> PathBuf {
        paths::root().join("motions").join(if self == Program::Meet { "meet.txt" } else { "steer.txt" })
    }
}

/// The record: a CRC of each picture's pose, place and heading.
pub fn record() -> PathBuf {
    paths::root().join("tests/steered.txt")
}

/// What the record holds.
pub fn recorded() -> Result<Crcs> {
    let path = record();
    let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let crc = |line: &str| u16::from_str_radix(line, 16).with_context(|| format!("{}: {line:?} is no CRC", path.display()));
    Ok(Crcs { stepped: text.lines().map(crc).collect::<Result<_>>()?, sought: vec![] })
}

/// Plays the session by the bank's state machine.
fn played(bytes: &[u8], show: impl FnMut(&mut Character<'_, '_>) -> Result<()>) -> Result<()> {
    let text = std::fs::read_to_string(script())?;
    play(bytes, Replay::new(session(&text, "steer.txt", &Table::of_bank(bytes)?)?, RATE), show)
}

/// The letters of [`pantin_app::CHARACTER_KEYS`] that make a session's inputs, before each picture but the first.
pub fn letters(program: Program) -> Result<Vec<Vec<u8>>> {
    let bytes = std::fs::read(bank())?;
    let table = Table::of_bank(&bytes)?;
    let path = program.script();
    let text = std::fs::read_to_string(&path)?;
    let session = session(&text, &path.to_string_lossy(), &table)?;
    let pictures = u64::from(session.end_us()) * u64::from(RATE) / 1_000_000;
    let mut letters = vec![vec![]; pictures as usize];
    for timed in session.inputs() {
        let (Input::Press(input) | Input::Hold(input) | Input::Release(input)) = timed.input else { continue };
        let key = CHARACTER_KEYS.iter().find(|key| table.input(key.input) == Some(input)).context("an input without a letter")?;
        // The first picture at or after its time.
        let picture = (u64::from(timed.time_us) * u64::from(RATE)).div_ceil(1_000_000);
        letters[picture as usize - 1].push(key.letter);
    }
    Ok(letters)
}

/// What it holds, played here: without feet, for which the smallest machines have no stack.
pub fn crcs() -> Result<Crcs> {
    let mut stepped = vec![];
    played(&without_feet()?, |character| {
        stepped.push(conformance::crc_of_character(character));
        Ok(())
    })?;
    Ok(Crcs { stepped, sought: vec![] })
}

/// What the page's player shows of it, at the size of the reference board's display, drawn here.
pub fn pictures() -> Result<Vec<Picture>> {
    let bytes = std::fs::read(bank())?;
    let mut stage = Stage::new(&bytes, [OLED.width, OLED.height], View::default(), None)?;
    let mut framebuffer = Framebuffer::<Gray4Rows<128, 64, 1024>>::new();
    let mut shown = vec![];
    played(&bytes, |character| {
        framebuffer.clear();
        stage.place(character)?.draw_on(&mut framebuffer, DrawStyle::default());
        let value = |index: usize| {
            let grey = framebuffer.pixel(index % OLED.width, index / OLED.width);
            u16::from(embedded_graphics::pixelcolor::GrayColor::luma(&grey))
        };
        shown.push(Picture { display: OLED, pixels: (0..OLED.width * OLED.height).map(value).collect() });
        Ok(())
    })?;
    Ok(shown)
}

/// The bank without its table of feet: they are not held.
pub fn without_feet() -> Result<Vec<u8>> {
    pantin_convert::bank::without_section(&std::fs::read(bank())?, FEET_SECTION)
}

/// Plays a session on a machine with our character, in step with the host, and compares each picture with what the same program shows here; returns the
/// pictures. `style` is `lines` or `solid`.
pub fn on_board(machine: Machine, program: Program, style: &str) -> Result<Vec<Picture>> {
    let letters = letters(program)?;
    let display = machine.display.context("a machine without a display")?;
    let meets = program == Program::Meet;
    let expected = simulator::steer_in_step(&std::fs::read(bank())?, meets, display, &[style], &letters)?;
    let features = if style == "solid" { format!("{},solid", program.feature()) } else { program.feature().into() };
    let firmware = Firmware::featuring(&features, machine.name, machine.name, machine.target, &[])?;
    let mut session = Session::start(Launch::new(machine, firmware.elf()).argument(style))?;
    let nothing: Vec<u8> = vec![];
    for (number, (letters, expected)) in std::iter::once(&nothing).chain(&letters).zip(&expected).enumerate() {
        let (told, picture) = session.next(letters)?;
        ensure!(told as usize == number, "picture {number} is called {told}");
        ensure!(!expected.is_dark(), "picture {number} is dark");
        if let Some(difference) = screen::difference(&picture, expected) {
            anyhow::bail!("picture {number}: {difference}");
        }
    }
    Ok(expected)
}
