//! The paper's results (docs/METHOD.md 2.6) on our own walk and run, and its closing claim: the more frames, the more is saved.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use harness::paths;
use pantin_tools::export::bvh;
use pantin_tools::import::{self, Options};
use pantin_tools::motion::{Kind, Motion};

use super::tool::{self, Converted};
use super::{Goal, Setting, plot, table};
use xtask::steps::say;

const BOUND_CM: f64 = 0.5;

/// Our motions, the paper's bytes for its own, and half of them: the goal.
const MOTIONS: [(&str, &str, f64); 2] = [("walk", "380", 190.0), ("run", "204", 102.0)];

/// Both tables.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let mut goals = vec![];
    let (mut rows, exact) = (vec![], setting.tool.has_option("convert", "--exact")?);
    for (name, papers, most) in MOTIONS {
        let path = paths::root().join("motions").join(name).with_extension("keys");
        let made = setting.tool.converted(&path, &format!("{name}-{BOUND_CM}cm"), &tool::options(BOUND_CM, None))?;
        rows.push(row(name, &format!("{BOUND_CM} cm"), papers, &made));
        let what = format!("our {name} within {BOUND_CM} cm ({} frames, {} moving channels)", made.info.frames, made.info.moving);
        goals.push(Goal::at_most(what, made.info.motion_bytes, most, 0, "bytes"));
        if exact {
            let made = setting.tool.converted(&path, &format!("{name}-exact"), &["--exact".into()])?;
            rows.push(row(name, "exact", papers, &made));
            goals.push(Goal::told(format!("our {name}, exact"), format!("{:.0} bytes", made.info.motion_bytes)));
        }
    }
    table::print(&["motion", "bound", "frames", "moving", "per-frame bytes", "bytes", "saved", "the paper's"], &rows);
    if !exact {
        say("   this host tool has no `convert --exact`: exact bytes are not measured");
    }
    goals.extend(saving(setting)?);
    Ok(goals)
}

/// 16 bits for each frame of each channel that moves: a per-frame file as small as a plain one can be.
fn per_frame(made: &Converted) -> f64 {
    made.info.frames * made.info.moving * 2.0
}

fn saved(made: &Converted) -> f64 {
    100.0 * (1.0 - made.info.motion_bytes / per_frame(made))
}

fn row(name: &str, bound: &str, papers: &str, made: &Converted) -> Vec<String> {
    let info = &made.info;
    let numbers = [info.frames, info.moving, per_frame(made), info.motion_bytes].map(|number| number.to_string());
    let mut row = vec![name.to_owned(), bound.to_owned()];
    row.extend(numbers);
    row.extend([format!("{:.1} %", saved(made)), papers.to_owned()]);
    row
}

/// The walk's first frames, the walk, and the walk walked again.
fn saving(setting: &Setting) -> Result<Vec<Goal>> {
    let walk = import::load(&paths::root().join("motions/walk.keys"), &Options::default())?.motion;
    let whole = walk.frames;
    let lengths = [whole / 8, whole / 4, whole / 2, whole, 2 * whole, 4 * whole];
    let (mut rows, mut points) = (vec![], vec![]);
    for frames in lengths {
        let path = cut(setting, &walk, frames)?;
        let unit = Some(walk.rig.cm_per_unit);
        let made = setting.tool.converted(&path, &format!("walk-{frames}-{BOUND_CM}cm"), &tool::options(BOUND_CM, unit))?;
        rows.push(row("walk", &format!("{BOUND_CM} cm"), "", &made));
        points.push((frames as f64, saved(&made)));
    }
    table::print(&["motion", "bound", "frames", "moving", "per-frame bytes", "bytes", "saved", ""], &rows);
    let path = setting.out.join("saving.svg");
    let (first, last) = (points[0], points[points.len() - 1]);
    let series = [plot::Series { name: "our walk, 0.5 cm".into(), points }];
    plot::percent(&path, ["frames", "% saved against the per-frame file"], &series)?;
    say(&format!("   wrote {}", path.display()));
    let value = format!("{:.1} % to {:.1} %", first.1, last.1);
    Ok(vec![Goal::told(format!("saved against a 16-bit per-frame file, walk of {} to {} frames", first.0, last.0), value)])
}

/// The first `frames` frames of the walk, which goes on where it ends, as a file.
fn cut(setting: &Setting, walk: &Motion, frames: usize) -> Result<PathBuf> {
    let (mut values, kinds) = (walk.values.clone(), walk.rig.channel_kinds());
    for (values, (_, kind)) in values.iter_mut().zip(&kinds) {
        // The way ahead is a straight line in time; everything else comes back to where it began.
        let last = values.len() - 1;
        let ahead = if *kind == Kind::Zposition { 2.0 * values[last] - values[last - 1] - values[0] } else { 0.0 };
        let stride = values.clone();
        let place = |frame: usize| stride[frame % walk.frames] + ahead * (frame / walk.frames) as f64;
        *values = (0..frames).map(place).collect();
    }
    let path: &Path = &setting.out.join(format!("walk-{frames}.bvh"));
    let keys = vec![None; values.len()];
    let motion = Motion { frames, values, keys, looped: false, ..walk.clone() };
    bvh::save(&motion, path).with_context(|| path.display().to_string())?;
    Ok(path.to_owned())
}
