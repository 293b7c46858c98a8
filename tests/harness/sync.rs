//! The firmware's `sync` mode: it shows a frame, sends its number over the serial port, and waits for a byte.
//!
//! Firmware to host: `F` and the frame's number, 4 bytes, little-endian; before it, on a machine without a display of its own, the
//! windows that changed. Host to firmware: a line feed for the next frame, `q` to end with code 0; before either, letters of the
//! app's keys. The mode does not depend on time, so every picture is of a known frame.

use std::io::{BufReader, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;

use anyhow::{Context, Result};
use serde_json::json;

use crate::display::{Picture, Way};
use crate::qemu::{Launch, Outcome, Qemu};
use crate::wire::{self, Memory};

/// The argument that selects this mode on the semihosting command line.
pub const ARGUMENT: &str = "sync";

/// A letter as it shares the line with packets, damaged ones too.
pub fn letter(letter: u8) -> [u8; 5] {
    [0, 0, letter, 0, 0]
}

/// A firmware that plays in step.
pub struct Session {
    qemu: Qemu,
    line: BufReader<UnixStream>,
    memory: Option<Memory>,
    begun: bool,
}

impl Session {
    /// Starts it.
    pub fn start(launch: Launch) -> Result<Self> {
        let display = launch.machine().display.context("this machine shows no pictures")?;
        let launch = launch.argument(ARGUMENT).serial();
        let mut qemu = if display.way == Way::Wire { launch } else { launch.display() }.start()?;
        let line = BufReader::new(qemu.serial()?.try_clone()?);
        let memory = (display.way == Way::Wire).then(|| Memory::new(display));
        Ok(Self { qemu, line, memory, begun: false })
    }

    /// The next picture, after these letters of keys, and the number that the firmware gives it. The first one takes no letters.
    pub fn next(&mut self, keys: &[u8]) -> Result<(u32, Picture)> {
        Ok((self.step(keys)?, self.picture()?))
    }

    /// Goes on to the next picture without looking at it.
    pub fn step(&mut self, keys: &[u8]) -> Result<u32> {
        if self.begun {
            self.send(&[keys, &[pantin_app::NEXT]].concat())?;
        }
        self.begun = true;
        // Sets the time that reading may take.
        self.qemu.serial()?;
        wire::shown(&mut self.line, self.memory.as_mut()).map_err(|error| self.qemu.explain(error))
    }

    /// The picture after these bytes of a line that brings motion, and a frame's time. The first one takes none.
    pub fn hear(&mut self, bytes: &[u8]) -> Result<(u32, Picture)> {
        if self.begun {
            self.send(&[bytes, &letter(pantin_app::NEXT)].concat())?;
        }
        self.begun = true;
        self.qemu.serial()?;
        let number = wire::shown(&mut self.line, self.memory.as_mut()).map_err(|error| self.qemu.explain(error))?;
        Ok((number, self.picture()?))
    }

    /// Waits for the picture after bytes that came another way than by the serial port; the number that the firmware gives it.
    pub fn heard(&mut self) -> Result<u32> {
        self.qemu.serial()?;
        wire::shown(&mut self.line, self.memory.as_mut()).map_err(|error| self.qemu.explain(error))
    }

    /// What is shown.
    pub fn picture(&mut self) -> Result<Picture> {
        match &self.memory {
            Some(memory) => Ok(memory.picture()),
            None => self.qemu.picture(),
        }
    }

    /// Writes `length` bytes of the machine's memory to a file.
    pub fn memory(&mut self, start: u32, length: usize, path: &Path) -> Result<()> {
        self.save("pmemsave", start, length, path)
    }

    /// The same of what the processor alone has at an address: QEMU hangs the microbit's flash there.
    pub fn memory_of_processor(&mut self, start: u32, length: usize, path: &Path) -> Result<()> {
        self.save("memsave", start, length, path)
    }

    fn save(&mut self, command: &str, start: u32, length: usize, path: &Path) -> Result<()> {
        let path = path.to_str().context("QMP names files in UTF-8")?;
        let words = json!({ "val": start, "size": length, "filename": path });
        self.qemu.control()?.execute(command, words).map(drop)
    }

    /// Ends the firmware and waits for that.
    pub fn end(mut self) -> Result<Outcome> {
        // Where packets share the line, a letter ends with two zeros.
        self.send(&[pantin_app::QUIT, 0, 0])?;
        self.qemu.wait()
    }

    /// Sends bytes to the firmware.
    pub fn send(&mut self, bytes: &[u8]) -> Result<()> {
        let written = self.qemu.serial()?.write_all(bytes);
        written.context("the firmware takes no answer").map_err(|error| self.qemu.explain(error))
    }

    /// A byte from it, where it answers something else than with a picture.
    pub fn receive(&mut self) -> Result<u8> {
        self.qemu.serial()?;
        let mut byte = [0];
        self.line.read_exact(&mut byte).context("the firmware says nothing").map_err(|error| self.qemu.explain(error))?;
        Ok(byte[0])
    }

    /// The firmware begins a clip by itself: its first picture is not asked for.
    pub fn begins(&mut self) {
        self.begun = false;
    }

    /// Stops the machine where it is.
    pub fn stop(&mut self) -> Result<()> {
        self.qemu.control()?.execute("stop", json!({})).map(drop)
    }

    /// Restarts the machine, like a power cycle: the contents of its flash stay. The firmware must be waiting.
    pub fn reset(&mut self) -> Result<()> {
        self.qemu.control()?.execute("system_reset", json!({}))?;
        self.memory = self.qemu.machine().display.filter(|display| display.way == Way::Wire).map(Memory::new);
        self.begins();
        Ok(())
    }
}

/// Plays the first `frames` frames and hands each picture, with the number that the firmware gave it, to `see`.
pub fn play(launch: Launch, frames: usize, mut see: impl FnMut(u32, Picture) -> Result<()>) -> Result<Outcome> {
    let mut session = Session::start(launch)?;
    for _ in 0..frames {
        let (number, picture) = session.next(&[])?;
        see(number, picture)?;
    }
    session.end()
}
