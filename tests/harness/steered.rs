//! Our character's state machine, steered by the recorded session: its poses and its pictures.

use std::path::PathBuf;

use anyhow::{Context, Result};
use conformance::RATE;
use pantin_animator::Character;
use pantin_animator::machine::Table;
use pantin_animator::session::Replay;
use pantin_figure::surface::{Framebuffer, Gray4Rows};
use pantin_figure::{DrawStyle, View};
use pantin_tools::machine::playback::{Stage, play, session};

use crate::display::{OLED, Picture};
use crate::paths;
use crate::vectors::record::Crcs;

/// The bank with its state machine.
pub fn bank() -> PathBuf {
    paths::root().join("motions/character.ptb")
}

/// The session.
pub fn script() -> PathBuf {
    paths::root().join("motions/steer.txt")
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

/// The same, played here.
pub fn crcs() -> Result<Crcs> {
    let mut stepped = vec![];
    played(&std::fs::read(bank())?, |character| {
        stepped.push(conformance::crc_of_character(character));
        Ok(())
    })?;
    Ok(Crcs { stepped, sought: vec![] })
}

/// What the reference board's display shows of it, picture by picture, drawn here.
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
