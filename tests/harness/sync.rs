//! The firmware's `sync` mode: it shows a frame, tells its number on the serial port, and waits for a byte.
//!
//! Firmware to host: `F` and the frame's number, 4 bytes, the least first. Host to firmware: a line feed for the next frame, `q` to end
//! with code 0; before either, letters of the app's keys. Time plays no part, so every picture is of a known frame.

use std::io::{Read, Write};

use anyhow::{Context, Result, ensure};

use crate::qemu::{Launch, Outcome, Qemu};
use pantin_tools::render::screen::Picture;

/// The word that asks for this mode on the semihosting command line.
pub const ARGUMENT: &str = "sync";

/// Plays the first `frames` frames and hands each picture, with the number that the firmware gave it, to `see`.
pub fn play(launch: Launch, frames: usize, mut see: impl FnMut(u32, Picture) -> Result<()>) -> Result<Outcome> {
    let mut qemu = launch.argument(ARGUMENT).serial().display().start()?;
    for played in 0..frames {
        if played > 0 {
            answer(&mut qemu, b'\n')?;
        }
        let number = shown(&mut qemu)?;
        let picture = qemu.picture()?;
        see(number, picture)?;
    }
    answer(&mut qemu, b'q')?;
    qemu.wait()
}

/// Begins the message that a frame is shown.
const SHOWN: u8 = b'F';

/// Waits until the firmware has shown a frame, and returns its number.
fn shown(qemu: &mut Qemu) -> Result<u32> {
    let mut message = [0; 5];
    let read = qemu.serial()?.read_exact(&mut message);
    read.context("no frame number from the firmware").map_err(|error| qemu.explain(error))?;
    let [letter, number @ ..] = message;
    ensure!(letter == SHOWN, "the firmware sent {letter:#x} in place of a frame's number");
    Ok(u32::from_le_bytes(number))
}

fn answer(qemu: &mut Qemu, byte: u8) -> Result<()> {
    let written = qemu.serial()?.write_all(&[byte]);
    written.context("the firmware takes no answer").map_err(|error| qemu.explain(error))
}
