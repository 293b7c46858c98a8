//! A board's whole program playing a clip in step: instructions of each part of a frame, and the memory it has touched.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use harness::build::Firmware;
use harness::icount::{self, FRAME_REGIONS, Stats};
use harness::qemu::{LM3S6965EVB, Launch, Machine};
use harness::sync::Session;

/// Pictures of a run.
pub const PICTURES: usize = 60;

/// Plays clips in step, one after the other, a number of pictures of each; of each the counts of each kind of region, without the first
/// picture's.
pub fn played(machine: Machine, features: &str, clips: &[(&Path, usize)], words: &[String]) -> Result<Vec<Vec<Stats>>> {
    let files: Vec<&Path> = clips.iter().map(|(file, _)| *file).collect();
    let firmware = Firmware::featuring(features, machine.name, machine.name, machine.target, &files)?;
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let counts = folder.path().join("counts");
    let mut launch = Launch::new(machine, firmware.elf()).counting(&icount::plugin(machine.emulator)?, &counts);
    for word in words {
        launch = launch.argument(word.clone());
    }
    let mut session = Session::start(launch)?;
    for (clip, (_, pictures)) in clips.iter().enumerate() {
        session.step(if clip == 0 { b"" } else { b"n" })?;
        for _ in 1..*pictures {
            session.step(b"")?;
        }
    }
    let outcome = session.end()?;
    ensure!(outcome.code == 0, "{} ended with code {}: {}", machine.name, outcome.code, outcome.stderr.trim());
    let counts = icount::read(&counts)?;
    let kinds = FRAME_REGIONS.len();
    let mut rest = &counts[..];
    let mut stats = vec![];
    for (_, pictures) in clips {
        let (clip, after) =
            rest.split_at_checked(pictures * kinds).with_context(|| format!("{} counted too little", machine.name))?;
        // The first picture is sent whole, and its clip has just been opened.
        stats.push(icount::by_kind(clip.get(kinds..).unwrap_or(&[]), kinds)?);
        rest = after;
    }
    ensure!(rest.is_empty(), "{} counted {} regions too many", machine.name, rest.len());
    Ok(stats)
}

/// The reference board's RAM beside its framebuffer after playing a clip.
pub fn memory(features: &str, clip: &Path, words: &[String]) -> Result<usize> {
    let firmware = Firmware::featuring(features, LM3S6965EVB.name, LM3S6965EVB.name, LM3S6965EVB.target, &[clip])?;
    let launch = words.iter().fold(Launch::new(LM3S6965EVB, firmware.elf()), |launch, word| launch.argument(word.clone()));
    let mut session = Session::start(launch)?;
    for _ in 0..PICTURES {
        session.step(&[])?;
    }
    let used = used(&mut session)? - FRAME_BYTES;
    session.end()?;
    Ok(used)
}

/// The reference machine's RAM, and what its framebuffer takes of it.
const RAM: (u32, usize) = (0x2000_0000, 64 * 1024);
const FRAME_BYTES: usize = 128 * 64 / 2;
/// Below it lies what the linker has placed; the stack comes from the RAM's end.
const STATIC_BYTES: usize = 4096;

/// Bytes of RAM that hold something else than the zero of the emulator's start: statics, and the stack down to its deepest.
fn used(session: &mut Session) -> Result<usize> {
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let path = folder.path().join("ram");
    session.memory(RAM.0, RAM.1, &path)?;
    let bytes = std::fs::read(&path)?;
    let set = |bytes: &[u8]| bytes.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    let statics = set(&bytes[..STATIC_BYTES]);
    let stack = bytes[STATIC_BYTES..].iter().position(|&byte| byte != 0).map_or(0, |first| bytes.len() - STATIC_BYTES - first);
    ensure!(stack < bytes.len() - STATIC_BYTES, "the stack has reached the data");
    Ok(statics + stack)
}
