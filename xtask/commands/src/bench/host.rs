//! Time on this machine: a pose and a seek, and encoding at each effort.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use harness::build::{self, Build};
use harness::paths;

use super::{Goal, Setting, reference, table, tool};

const BOUND_CM: f64 = 1.0;

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
    Ok(goals)
}

fn play(setting: &Setting, name: &str, path: &std::path::Path, unit: Option<f64>) -> Result<Vec<Goal>> {
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
    })
}

fn encode(setting: &Setting, name: &str, path: &std::path::Path, unit: Option<f64>) -> Result<Vec<Goal>> {
    let (mut rows, mut results) = (vec![], vec![]);
    for effort in ["fast", "default", "best"] {
        let mut options = tool::options(BOUND_CM, unit);
        options.extend(["--effort".to_owned(), effort.to_owned()]);
        let made = setting.tool.convert(path, &format!("{name}-{BOUND_CM}cm-{effort}"), &options)?;
        let speed = made.info.seconds() / made.seconds.unwrap_or(f64::INFINITY);
        let numbers =
            [format!("{}", made.info.motion_bytes), format!("{:.2}", made.info.seconds() / speed), format!("{speed:.1}")];
        rows.push([vec![effort.to_owned()], numbers.to_vec()].concat());
        results.push((made.info.motion_bytes, speed));
    }
    table::print(&[&format!("{name}, {BOUND_CM} cm: effort"), "bytes", "encode s", "x real time"], &rows);
    let [(fast_bytes, fast), (bytes, speed), (best_bytes, best)] = results[..] else { return Ok(vec![]) };
    let at_least = |what: &str, value: f64, least: f64| Goal {
        what: what.into(),
        value: format!("{value:.1} x real time"),
        goal: format!("at least {least}"),
        met: value >= least,
    };
    Ok(vec![
        at_least("encoding 31 joints at 120 fps, default effort", speed, 1.0),
        at_least("encoding, fast", fast, 20.0),
        Goal::at_most("bytes, fast relative to default", fast_bytes / bytes, 2.0, 2, ""),
        Goal::told("bytes, best relative to default", format!("{:.3} ({best:.1} x real time)", best_bytes / bytes)),
    ])
}
