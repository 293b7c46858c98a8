//! The decoder in C on an Arduino Uno, emulated by simavr cycle by cycle: its numbers do not depend on this machine's load.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::vectors;
use pantin::codec::crc;
use pantin::{ChannelState, Clip, EulerOrder, Player};
use serde_json::Value;
use tempfile::TempDir;
use xtask::setup;

use super::{SECTIONS, compile, output};

/// RAM of an ATmega328P, in bytes.
const RAM: u32 = 2048;

/// Processor cycles in a millisecond.
const CYCLES_PER_MS: f64 = 16_000.0;

/// What the program measures, and the most milliseconds that it may take.
const LIMITS: [(&str, &str, Option<f64>); 7] = [
    ("own", "angles as the clip stores them", Some(0.05)),
    ("euler", "angles in another order", Some(1.5)),
    ("map", "angles of an exponential map", Some(1.5)),
    ("quaternion", "angles of a quaternion", Some(1.5)),
    ("chain", "angles of several forms in one joint", Some(2.5)),
    ("step", "a step to the next frame", None),
    ("restart", "going back to frame 0", None),
];

/// Clips with joints in every form, of at most 44 channels.
const CLIPS: [&str; 6] = ["own-map", "own-quaternion", "turn-orders", "mixed", "quaternion", "exponential-map"];

/// Plays our walk in the RAM of an Arduino Uno, from flash and through a page buffer of 128 bytes.
pub fn walk(folder: &TempDir) -> Result<()> {
    let log = play(folder, "walk", &["src/pantin.c", "tests/uno.c"])?;
    let crcs: Vec<&str> = log.iter().map(String::as_str).filter(|word| word.len() == 4).collect();
    let record: Value = serde_json::from_str(&std::fs::read_to_string(vectors::folder().join("walk.json"))?)?;
    ensure!(Value::from(crcs) == record["crcs"], "the frames differ: {log:?}");
    let used = log.iter().find_map(|word| word.strip_prefix('=')).context("no use of RAM in the output")?;
    let used = u32::from_str_radix(used, 16)?;
    println!("   {used} bytes of RAM, stack included");
    ensure!(used < RAM, "the Uno has {RAM} bytes");
    Ok(())
}

/// Reads all joints at all frames in all orders: the angles are those of the Rust decoder, and cost no more than the limits.
pub fn turns(folder: &TempDir) -> Result<()> {
    let mut most = [0u32; LIMITS.len()];
    for name in CLIPS {
        let log = play(folder, name, &["src/pantin.c", "src/pantin_turn.c", "tests/uno_turns.c"])?;
        let number = |key: &str| -> Result<u32> {
            let value = log.iter().find_map(|line| line.strip_prefix(key)?.strip_prefix(' '));
            Ok(u32::from_str_radix(value.with_context(|| format!("{name}: no {key} in {log:?}"))?, 16)?)
        };
        let expected = checksum(&vectors::folder().join(name).with_extension("ptn"))?;
        ensure!(number("crc")? == u32::from(expected), "{name}: the angles differ from those of the decoder in Rust");
        for (most, (key, ..)) in most.iter_mut().zip(LIMITS) {
            *most = (*most).max(number(key)?);
        }
    }
    for (cycles, (_, what, limit)) in most.into_iter().zip(LIMITS) {
        let ms = f64::from(cycles) / CYCLES_PER_MS;
        println!("   {ms:6.3} ms: {what}, the most of {} clips", CLIPS.len());
        if let Some(limit) = limit {
            ensure!(cycles > 0 && ms <= limit, "{what}: at most {limit} ms");
        }
    }
    Ok(())
}

/// The CRC of the Euler angles of all joints in all orders at all frames.
fn checksum(clip: &Path) -> Result<u16> {
    let bytes = std::fs::read(clip)?;
    let clip = Clip::new_checked(&bytes)?;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let joints: Vec<_> =
        clip.rig().joints().filter(|joint| !joint.name().is_empty()).filter_map(|joint| clip.find(joint.name())).collect();
    let mut player = Player::new(clip, &mut states, &mut pose)?;
    let mut sum = crc::INITIAL;
    for _ in 0..clip.frames() {
        for joint in &joints {
            let turn = player.turn(joint).map_err(|wrong| anyhow::anyhow!("{wrong}"))?;
            for angle in EulerOrder::ALL.into_iter().flat_map(|order| turn.euler(order)) {
                sum = crc::update(sum, &angle.to_bits().to_le_bytes());
            }
        }
        player.step();
    }
    Ok(sum)
}

/// Builds a program with a vector in flash and runs it. Returns the lines that it sends over the serial port.
fn play(folder: &TempDir, vector: &str, sources: &[&str]) -> Result<Vec<String>> {
    let clip = std::fs::read(vectors::folder().join(vector).with_extension("ptn"))?;
    let bytes: String = clip.iter().map(|byte| format!("{byte},")).collect();
    std::fs::write(folder.path().join("clip.h"), format!("static const uint8_t clip_bytes[] PROGMEM = {{{bytes}}};\n"))?;
    let mut command = Command::new("avr-gcc");
    command.args(["-mmcu=atmega328p", "-std=c99", "-mcall-prologues", "-Wl,--gc-sections", "-I"]);
    command.arg(folder.path()).args(SECTIONS);
    let program = compile(command, sources, &folder.path().join("uno.elf"))?;
    all_lines(&program)
}

/// Runs a program to its end, and returns the lines that it sends.
pub fn all_lines(program: &Path) -> Result<Vec<String>> {
    let mut simavr = Command::new(setup::emulator("simavr")?);
    simavr.args(["-m", "atmega328p", "-f", "16000000"]).arg(program);
    let printed = output(simavr)?;
    Ok(lines(&[printed.stdout, printed.stderr].concat()))
}

/// Runs a program, which may never end, until it has sent some lines, and returns those.
pub fn first_lines(count: usize, program: &Path) -> Result<Vec<String>> {
    let mut shell = Command::new("sh");
    // The emulator ends when nobody reads on.
    shell.args(["-c", "\"$0\" -m atmega328p -f 16000000 \"$1\" 2>&1 | head -n \"$2\""]);
    shell.arg(setup::emulator("simavr")?).arg(program).arg(count.to_string());
    Ok(lines(&output(shell)?.stdout))
}

/// The lines that a program sends over the serial port: simavr prints them in colours, with a point for the end of each. Others of simavr's own have no
/// point.
fn lines(printed: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(printed).replace("\x1b[32m", "").replace("\x1b[0m", "");
    text.lines().filter_map(|line| Some(line.strip_suffix('.')?.trim_end_matches('.').to_owned())).collect()
}
