//! Time on this machine: a pose and a seek, and encoding at each effort. Encoding is measured by processor time, which other programs change little.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::build::{self, Build};
use harness::paths;

use super::tool::Converted;
use super::{Goal, Setting, reference, table, tool};

const BOUND_CM: f64 = 1.0;
/// A figure with fingers, and the bound at which the search takes longest.
const MANY_JOINTS: &str = "bvh_mixamo-mia_gesture";
const LOOSE_CM: f64 = 3.0;
/// What the default effort is measured with, and what a take of 10 minutes is made of.
const LONG: &str = "bvh_cmu01_hops-and-turn";
/// The greatest processor time of the default effort, in seconds for a second of motion, with the shell bounded.
const MOST_PROCESSOR: f64 = 0.58;
/// The most memory for a take of 10 minutes, in MB.
const MOST_MEMORY: f64 = 400.0;
/// Frames of a take of 10 minutes.
const LONG_FRAMES: usize = 72_000;

/// ACL's time for a pose of 31 joints, AVX2: seek and decompress, in order, warm.
const ACL_NS: f64 = 548.0;

/// Plays and encodes a clip of 31 joints at 120 fps where there is one, else our walk.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let name = if setting.quick { "bvh_xia_strut-walk" } else { "bvh_cmu131_start-walk-stop" };
    let (name, path, unit) = match reference::named(name)? {
        Some(clip) => (clip.name.clone(), clip.path.clone(), clip.cm_per_unit()),
        None => ("walk".into(), paths::root().join("motions/walk.keys"), None),
    };
    let mut goals = play(setting, &name, &path, unit)?;
    goals.extend(encode(setting, &name, &path, unit)?);
    if !setting.quick {
        goals.extend(encode_default(setting)?);
        goals.extend(encode_many_joints(setting)?);
        goals.extend(encode_long(setting)?);
    }
    Ok(goals)
}

/// Seconds of processor time that a conversion took.
fn processor(made: &Converted) -> Result<f64> {
    made.processor.context("this system does not report the processor time of a program")
}

/// Processor time of the default effort for a lively clip of 31 joints at 120 fps.
fn encode_default(setting: &Setting) -> Result<Vec<Goal>> {
    let Some(clip) = reference::named(LONG)? else { return Ok(vec![]) };
    let options = tool::shell_options(BOUND_CM, clip.cm_per_unit());
    let made = setting.tool.convert(&clip.path, &format!("{LONG}-{BOUND_CM}cm-time"), &options)?;
    let (taken, what) =
        (processor(&made)? / made.info.seconds(), "processor time to encode a second of 31 joints at 120 fps, shell bounded");
    Ok(vec![Goal::at_most(format!("{what}, default effort"), taken, MOST_PROCESSOR, 2, "s")])
}

/// Speed for a figure with fingers at a loose bound.
fn encode_many_joints(setting: &Setting) -> Result<Vec<Goal>> {
    let Some(clip) = reference::named(MANY_JOINTS)? else { return Ok(vec![]) };
    let name = format!("{MANY_JOINTS}-{LOOSE_CM}cm-time");
    let made = setting.tool.convert(&clip.path, &name, &tool::options(LOOSE_CM, clip.cm_per_unit()))?;
    let speed = made.info.seconds() / processor(&made)?;
    Ok(vec![speed_at_least(&format!("encoding 75 joints at 30 fps within {LOOSE_CM} cm, default effort"), speed, 2.0)])
}

/// Time and memory of long takes.
fn encode_long(setting: &Setting) -> Result<Vec<Goal>> {
    let Some(clip) = reference::named(LONG)? else { return Ok(vec![]) };
    let (mut rows, mut goals, mut seconds) = (vec![], vec![], vec![]);
    for (frames, effort) in [(LONG_FRAMES / 2, "fast"), (LONG_FRAMES, "fast"), (LONG_FRAMES, "default")] {
        let path = repeated(setting, &clip.path, frames)?;
        let mut options = tool::options(BOUND_CM, clip.cm_per_unit());
        options.extend(["--effort".to_owned(), effort.to_owned()]);
        let made = setting.tool.convert(&path, &format!("long-{frames}-{effort}"), &options)?;
        let taken = processor(&made)?;
        rows.push(vec![
            format!("{frames} frames, {effort}"),
            format!("{}", made.info.motion_bytes),
            format!("{taken:.1}"),
            format!("{:.1}", made.info.seconds() / taken),
            made.peak_mb.map_or_else(String::new, |mb| format!("{mb:.0}")),
        ]);
        seconds.push(taken);
        if let Some(peak) = made.peak_mb.filter(|_| frames == LONG_FRAMES) {
            let what = format!("memory to encode {frames} frames of 31 joints, {effort} effort");
            goals.push(Goal::at_most(what, peak, MOST_MEMORY, 0, "MB"));
        }
    }
    table::print(&["a take, 1 cm", "bytes", "processor s", "x real time on one core", "MB"], &rows);
    let growth = seconds[1] / seconds[0];
    goals.push(Goal::at_most("processor time to encode twice the frames, effort fast", growth, 2.2, 2, "times"));
    Ok(goals)
}

/// A BVH file of so many frames: a shorter one's, over and over.
fn repeated(setting: &Setting, source: &Path, frames: usize) -> Result<PathBuf> {
    let text = std::fs::read_to_string(source).with_context(|| source.display().to_string())?;
    let (head, motion) = text.split_once("Frames:").context("a BVH file without frames")?;
    let (_, rest) = motion.split_once('\n').context("a BVH file without frames")?;
    let (time, rows) = rest.split_once('\n').context("a BVH file without a frame time")?;
    let rows: Vec<&str> = rows.lines().filter(|row| !row.trim().is_empty()).collect();
    ensure!(!rows.is_empty(), "{}: no frames", source.display());
    let mut out = format!("{head}Frames: {frames}\n{}\n", time.trim());
    for frame in 0..frames {
        out.push_str(rows[frame % rows.len()].trim());
        out.push('\n');
    }
    let path = setting.out.join(format!("long-{frames}.bvh"));
    std::fs::write(&path, out).with_context(|| path.display().to_string())?;
    Ok(path)
}

fn speed_at_least(what: &str, value: f64, least: f64) -> Goal {
    Goal {
        what: what.into(),
        value: format!("{value:.1} x real time on one core"),
        goal: format!("at least {least}"),
        met: value >= least,
    }
}

fn play(setting: &Setting, name: &str, path: &Path, unit: Option<f64>) -> Result<Vec<Goal>> {
    let made = setting.tool.converted(path, &format!("{name}-{BOUND_CM}cm"), &tool::options(BOUND_CM, unit))?;
    let output = Command::new(player()?).arg(&made.clip).output().context("cannot start the player")?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
    let text = String::from_utf8(output.stdout).context("the player prints no text")?;
    let number = |what: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(what));
        line.and_then(|line| line.trim().parse::<f64>().ok()).with_context(|| format!("the player prints no {what}"))
    };
    let (step, seek) = (number("step_ns")?, number("seek_ns")?);
    let rows = vec![
        vec!["a pose, in order, warm".into(), format!("{step:.0}")],
        vec!["a pose by a seek to any frame, mean".into(), format!("{seek:.0}")],
        vec!["ACL, a pose (measured elsewhere)".into(), format!("{ACL_NS:.0}")],
    ];
    table::print(&[&format!("{name}, {BOUND_CM} cm, {} moving channels", made.info.moving), "ns"], &rows);
    Ok(vec![
        Goal::at_most("time per pose on this machine, in order", step, (ACL_NS / 3.0).floor(), 0, "ns"),
        Goal::told("time per pose on this machine, by a seek to any frame", format!("{seek:.0} ns")),
    ])
}

fn player() -> Result<PathBuf> {
    build::cargo(&Build {
        workspace: paths::root(),
        arguments: ["--release", "--package", "pantin", "--example", "speed"].map(Into::into).into(),
        environment: vec![],
        product: "speed".into(),
        ..Build::default()
    })
}

fn encode(setting: &Setting, name: &str, path: &Path, unit: Option<f64>) -> Result<Vec<Goal>> {
    let (mut rows, mut results) = (vec![], vec![]);
    for effort in ["fast", "default", "best"] {
        let mut options = tool::options(BOUND_CM, unit);
        options.extend(["--effort".to_owned(), effort.to_owned()]);
        let made = setting.tool.convert(path, &format!("{name}-{BOUND_CM}cm-{effort}"), &options)?;
        let speed = made.info.seconds() / processor(&made)?;
        let numbers =
            [format!("{}", made.info.motion_bytes), format!("{:.2}", made.info.seconds() / speed), format!("{speed:.1}")];
        rows.push([vec![effort.to_owned()], numbers.to_vec()].concat());
        results.push((made.info.motion_bytes, speed));
    }
    table::print(&[&format!("{name}, {BOUND_CM} cm: effort"), "bytes", "processor s", "x real time on one core"], &rows);
    let [(fast_bytes, fast), (bytes, _), (best_bytes, best)] = results[..] else { return Ok(vec![]) };
    Ok(vec![
        speed_at_least("encoding 31 joints at 120 fps, fast", fast, 25.0),
        Goal::at_most("bytes, fast relative to default", fast_bytes / bytes, 2.0, 2, ""),
        Goal::told("bytes, best relative to default", format!("{:.3} ({best:.1} x real time on one core)", best_bytes / bytes)),
    ])
}
