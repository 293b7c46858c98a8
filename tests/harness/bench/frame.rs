//! Guest instructions of a frame on every machine, part by part; size and memory of the reference board's image; how many
//! figures a small core keeps at 30 frames a second.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use harness::build::Firmware;
use harness::icount::{self, FRAME_REGIONS, Stats};
use harness::qemu::{LM3S6965EVB, Launch, MICROBIT, MPS2_AN386, Machine, SX1};
use harness::sync::Session;
use harness::{image, paths};

use super::{Goal, Setting, reference, table, tool};
use crate::cmd::steps::say;

/// Pictures of a run.
const PICTURES: usize = 60;
const BOUND_CM: f64 = 1.0;

/// A column of the table.
struct Column {
    name: &'static str,
    machine: Machine,
    /// Features of the board's package.
    features: &'static str,
    /// Most instructions: decode and kinematics of the whole rig, kinematics of the display's body, clear and draw.
    most: Option<[f64; 4]>,
}

const COLUMNS: [Column; 5] = [
    Column { name: "M3, 128x64, 4 bits", machine: LM3S6965EVB, features: "", most: Some([2700.0, 15e3, 8e3, 20e3]) },
    Column { name: "M0, 128x64, 1 bit", machine: MICROBIT, features: "", most: Some([3200.0, 30e3, 15e3, 25e3]) },
    Column { name: "ARMv4T, 176x220, RGB565", machine: SX1, features: "", most: Some([2700.0, 20e3, 10e3, 60e3]) },
    Column { name: "M4F, 128x64, 4 bits", machine: MPS2_AN386, features: "", most: None },
    Column { name: "M4F, the same with micromath", machine: MPS2_AN386, features: "micromath", most: None },
];

/// Measures all of it.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let clips = clips(setting)?;
    let mut goals = vec![];
    for column in &COLUMNS {
        goals.extend(frames(column, &clips)?);
    }
    goals.extend(reference_image(&clips[0].1)?);
    goals.extend(figures(&clips[1].1)?);
    Ok(goals)
}

/// A captured clip, whole and on the display's body; ours where there is none.
fn clips(setting: &Setting) -> Result<[(String, PathBuf); 2]> {
    let walk = || (paths::root().join("motions/walk.keys"), "our walk".to_owned(), None);
    let (path, name, unit) = match reference::named("bvh_xia_strut-walk")? {
        Some(clip) => (clip.path.clone(), clip.name.clone(), clip.cm_per_unit()),
        None => walk(),
    };
    let options = tool::options(BOUND_CM, unit);
    let whole = setting.tool.converted(&path, &format!("{name}-frame"), &options)?;
    let body = [options, vec!["--retarget".into(), "display".into()]].concat();
    let body = setting.tool.converted(&path, &format!("{name}-display"), &body)?;
    Ok([(name.clone(), whole.clip), (format!("{name} on the display's body"), body.clip)])
}

/// Plays a clip in step; the counts of each kind of region, without the first picture's.
fn played(machine: Machine, features: &str, clip: &Path, words: &[String]) -> Result<Vec<Stats>> {
    let firmware = Firmware::featuring(features, machine.name, machine.name, machine.target, &[clip])?;
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let counts = folder.path().join("counts");
    let mut launch = Launch::new(machine, firmware.elf()).counting(&icount::plugin(machine.emulator)?, &counts);
    for word in words {
        launch = launch.argument(word.clone());
    }
    let mut session = Session::start(launch)?;
    for _ in 0..PICTURES {
        session.next(&[])?;
    }
    let outcome = session.end()?;
    ensure!(outcome.code == 0, "{} ended with code {}: {}", machine.name, outcome.code, outcome.stderr.trim());
    let counts = icount::read(&counts)?;
    // The first picture is sent whole, and its clip has just been opened.
    icount::by_kind(counts.get(FRAME_REGIONS.len()..).unwrap_or(&[]), FRAME_REGIONS.len())
}

fn frames(column: &Column, clips: &[(String, PathBuf); 2]) -> Result<Vec<Goal>> {
    let Column { name, machine, features, most } = column;
    say(&format!("   instructions a frame, {name} ({}), mean of {} pictures", machine.name, PICTURES - 1));
    let [whole, body] = [&clips[0], &clips[1]].map(|(_, clip)| played(*machine, features, clip, &[]));
    let (whole, body) = (whole?, body?);
    let rows: Vec<_> = [(&clips[0].0, &whole), (&clips[1].0, &body)]
        .into_iter()
        .map(|(clip, stats)| {
            let mut row = vec![clip.clone()];
            row.extend(stats[..3].iter().map(|kind| format!("{:.0}", kind.mean())));
            // Where a picture goes over a line, the wait for it is the host's: the least is the program's own.
            row.push(stats[3].least.to_string());
            row
        })
        .collect();
    table::print(&["clip", "decode", "kinematics and camera", "clear and draw", "flush, least"], &rows);
    let values = [whole[0].mean(), whole[1].mean(), body[1].mean(), whole[2].mean()];
    let what = ["decode, 31 joints", "kinematics and camera, 31 joints", "kinematics and camera, display body", "clear and draw"];
    Ok(what
        .iter()
        .zip(values)
        .enumerate()
        .map(|(index, (what, value))| {
            let what = format!("instructions a frame, {name}: {what}");
            match most {
                Some(most) => Goal::at_most(what, value, most[index], 0, ""),
                None => Goal::told(what, format!("{value:.0}")),
            }
        })
        .collect())
}

/// The reference board's image with our two clips, and the memory that it has touched after playing the captured one.
fn reference_image(clip: &Path) -> Result<Vec<Goal>> {
    let firmware = Firmware::build(LM3S6965EVB.name, LM3S6965EVB.name, LM3S6965EVB.target, &[])?;
    let size = image::loaded(firmware.elf())?;
    let firmware = Firmware::build(LM3S6965EVB.name, LM3S6965EVB.name, LM3S6965EVB.target, &[clip])?;
    let mut session = Session::start(Launch::new(LM3S6965EVB, firmware.elf()))?;
    for _ in 0..PICTURES {
        session.next(&[])?;
    }
    let used = memory_used(&mut session)? - FRAME_BYTES;
    session.end()?;
    Ok(vec![
        Goal::at_most("flash of the reference board's whole image, two clips in it", size as f64, 48.0 * 1024.0, 0, "bytes"),
        Goal::at_most("its RAM beside the framebuffer, playing 31 joints", used as f64, 8.0 * 1024.0, 0, "bytes"),
    ])
}

/// The reference machine's RAM, and what its framebuffer takes of it.
const RAM: (u32, usize) = (0x2000_0000, 64 * 1024);
const FRAME_BYTES: usize = 128 * 64 / 2;
/// Below it lies what the linker has placed; the stack comes from the RAM's end.
const STATIC_BYTES: usize = 4096;

/// Bytes of RAM that hold something else than the zero of the emulator's start: statics, and the stack down to its deepest.
fn memory_used(session: &mut Session) -> Result<usize> {
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

/// Figures at 30 frames a second by instructions alone, from what two, three and four cost.
fn figures(clip: &Path) -> Result<Vec<Goal>> {
    let cost = |count: usize| -> Result<f64> {
        let stats = played(LM3S6965EVB, "several", clip, &[format!("figures={count}")])?;
        Ok(stats[..3].iter().map(Stats::mean).sum::<f64>() + stats[3].least as f64)
    };
    let (two, four) = (cost(2)?, cost(4)?);
    let each = (four - two) / 2.0;
    let fit = |clock: f64, each: f64, rest: f64| ((clock / 30.0 - rest) / each).floor();
    let m3 = fit(50e6, each, two - 2.0 * each);
    // A single figure on the smaller core: all of it counts as the figure's.
    let alone = played(MICROBIT, "", clip, &[])?;
    let alone = alone[..3].iter().map(Stats::mean).sum::<f64>();
    let m0 = fit(48e6, alone, 0.0);
    Ok(vec![
        Goal::told("figures (display body) at 30 frames a second, 50 MHz Cortex-M3, one instruction a cycle", format!("{m3:.0}")),
        Goal::told("figures (display body) at 30 frames a second, 48 MHz Cortex-M0, one instruction a cycle", format!("{m0:.0}")),
    ])
}
