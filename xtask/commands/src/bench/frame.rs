//! Guest instructions of a frame on every machine, part by part; size and memory of the reference board's image; how many
//! figures a small core keeps at 30 frames a second.

use std::path::{Path, PathBuf};

use anyhow::Result;
use harness::build::Firmware;
use harness::icount::Stats;
use harness::qemu::{LM3S6965EVB, MICROBIT, MPS2_AN386, Machine, SX1};
use harness::{image, paths};

use super::board::{self, PICTURES, played};
use super::{Goal, Setting, reference, table, tool};
use xtask::steps::say;

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

/// A column of the solid figure's table.
struct SolidColumn {
    name: &'static str,
    machine: Machine,
    /// Most instructions to clear and draw.
    most: f64,
}

const SOLID: [SolidColumn; 3] = [
    SolidColumn { name: "M3, 128x64, 4 bits", machine: LM3S6965EVB, most: 70e3 },
    SolidColumn { name: "M0, 128x64, 1 bit", machine: MICROBIT, most: 150e3 },
    SolidColumn { name: "ARMv4T, 176x220, RGB565", machine: SX1, most: 230e3 },
];

/// Measures all of it.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let clips = clips(setting)?;
    let mut goals = vec![];
    for column in &COLUMNS {
        goals.extend(frames(column, &clips)?);
    }
    for column in &SOLID {
        goals.push(solid(column, &clips[0])?);
    }
    goals.extend(solid_image(&clips[0].1)?);
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

/// A clip by itself.
fn alone(machine: Machine, features: &str, clip: &Path, words: &[String]) -> Result<Vec<Stats>> {
    Ok(played(machine, features, &[(clip, PICTURES)], words)?.remove(0))
}

fn frames(column: &Column, clips: &[(String, PathBuf); 2]) -> Result<Vec<Goal>> {
    let Column { name, machine, features, most } = column;
    say(&format!("   instructions per frame, {name} ({}), mean of {} pictures", machine.name, PICTURES - 1));
    let [whole, body] = [&clips[0], &clips[1]].map(|(_, clip)| alone(*machine, features, clip, &[]));
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
            let what = format!("instructions per frame, {name}: {what}");
            match most {
                Some(most) => Goal::at_most(what, value, most[index], 0, ""),
                None => Goal::told(what, format!("{value:.0}")),
            }
        })
        .collect())
}

/// A solid figure on a machine, beside the same image's lines.
fn solid(column: &SolidColumn, (clip, path): &(String, PathBuf)) -> Result<Goal> {
    let SolidColumn { name, machine, most } = column;
    say(&format!("   instructions per frame of a solid figure, {name} ({}), mean of {} pictures", machine.name, PICTURES - 1));
    let volume = alone(*machine, "solid", path, &["solid".into()])?;
    let lines = alone(*machine, "solid", path, &[])?;
    let row = |what: &str, stats: &[Stats]| {
        let means = stats[..3].iter().map(|kind| format!("{:.0}", kind.mean()));
        [format!("{clip}, {what}")].into_iter().chain(means).chain([stats[3].least.to_string()]).collect::<Vec<_>>()
    };
    let rows = [row("solid", &volume), row("lines", &lines)];
    table::print(&["clip", "decode", "kinematics and camera", "clear and draw", "flush, least"], &rows);
    Ok(Goal::at_most(format!("instructions per frame, {name}: clear and draw a solid figure"), volume[2].mean(), *most, 0, ""))
}

/// What the solid figure adds to an image, and to the memory that it touches.
fn solid_image(clip: &Path) -> Result<Vec<Goal>> {
    let flash = |features: &str| -> Result<f64> {
        let firmware = Firmware::featuring(features, MICROBIT.name, MICROBIT.name, MICROBIT.target, &[])?;
        Ok(image::loaded(firmware.elf())? as f64)
    };
    let bytes = flash("solid")? - flash("")?;
    let memory = board::memory("solid", clip, &["solid".into()])? as f64 - board::memory("", clip, &[])? as f64;
    Ok(vec![
        Goal::at_most("flash that the solid figure adds, Cortex-M0", bytes, 7.0 * 1024.0, 0, "bytes"),
        Goal::at_most("RAM that the solid figure adds, 128x64", memory, 1.2 * 1024.0, 0, "bytes"),
    ])
}

/// The reference board's image with our two clips, and the memory that it has touched after playing the captured one.
fn reference_image(clip: &Path) -> Result<Vec<Goal>> {
    let firmware = Firmware::build(LM3S6965EVB.name, LM3S6965EVB.name, LM3S6965EVB.target, &[])?;
    let size = image::loaded(firmware.elf())?;
    let used = board::memory("", clip, &[])?;
    Ok(vec![
        Goal::at_most("flash of the reference board's whole image, two clips in it", size as f64, 48.0 * 1024.0, 0, "bytes"),
        Goal::at_most("its RAM without the framebuffer, playing 31 joints", used as f64, 8.0 * 1024.0, 0, "bytes"),
    ])
}

/// Figures at 30 frames a second by instructions alone, from what two, three and four cost.
fn figures(clip: &Path) -> Result<Vec<Goal>> {
    let cost = |count: usize| -> Result<f64> {
        let stats = alone(LM3S6965EVB, "several", clip, &[format!("figures={count}")])?;
        Ok(stats[..3].iter().map(Stats::mean).sum::<f64>() + stats[3].least as f64)
    };
    let (two, four) = (cost(2)?, cost(4)?);
    let each = (four - two) / 2.0;
    let fit = |clock: f64, each: f64, rest: f64| ((clock / 30.0 - rest) / each).floor();
    let m3 = fit(50e6, each, two - 2.0 * each);
    // A single figure on the smaller core: all of it counts as the figure's.
    let stats = alone(MICROBIT, "", clip, &[])?;
    let alone = stats[..3].iter().map(Stats::mean).sum::<f64>();
    let m0 = fit(48e6, alone, 0.0);
    Ok(vec![
        Goal::told("figures (display body) at 30 frames a second, 50 MHz Cortex-M3, one instruction a cycle", format!("{m3:.0}")),
        Goal::told("figures (display body) at 30 frames a second, 48 MHz Cortex-M0, one instruction a cycle", format!("{m0:.0}")),
    ])
}
