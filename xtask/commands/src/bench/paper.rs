//! The paper's results (docs/METHOD.md 2.6) on our own walk and run, and its closing claim: the more frames, the more is saved.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use harness::paths;
use pantin_convert::fit::bounds::EXACT_DEGREES;
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::motion::{Kind, Motion};

use super::tool::{self, Converted};
use super::{Goal, Setting, paper_keys, plot, table};
use xtask::steps::say;

const BOUND_CM: f64 = 0.5;

/// Our motions, the paper's bytes for its own, and the goal within [`BOUND_CM`]: half of them.
const MOTIONS: [(&str, f64, f64); 2] = [("walk", 380.0, 190.0), ("run", 204.0, 102.0)];
/// Bounds of rotations in degrees, and of positions in percent of their range.
const DEGREES: [&str; 2] = ["0.05", "0.1"];

/// Both tables.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let mut goals = vec![];
    let mut rows = vec![];
    for (name, papers, most) in MOTIONS {
        let path = paths::root().join("motions").join(name).with_extension("keys");
        let keys = Keys::of(&std::fs::read_to_string(&path).with_context(|| path.display().to_string())?);
        let made = setting.tool.converted(&path, &format!("{name}-exact"), &["--exact".into()])?;
        rows.push(row(name, &format!("exact: {EXACT_DEGREES} degrees"), Some(&keys), papers, &made));
        goals.push(Goal::at_most(format!("our {name}, exact"), made.info.motion_bytes, papers, 0, "bytes"));
        for degrees in DEGREES {
            let options = ["--max-channel-error".to_owned(), degrees.to_owned()];
            let made = setting.tool.converted(&path, &format!("{name}-{degrees}degrees"), &options)?;
            rows.push(row(name, &format!("{degrees} degrees"), Some(&keys), papers, &made));
            goals
                .push(Goal::told(format!("our {name} within {degrees} degrees"), format!("{:.0} bytes", made.info.motion_bytes)));
        }
        let made = setting.tool.converted(&path, &format!("{name}-{BOUND_CM}cm"), &tool::places_options(BOUND_CM, None))?;
        rows.push(row(name, &format!("{BOUND_CM} cm"), Some(&keys), papers, &made));
        let what = format!("our {name} within {BOUND_CM} cm ({} frames, {} moving channels)", made.info.frames, made.info.moving);
        goals.push(Goal::at_most(what, made.info.motion_bytes, most, 0, "bytes"));
    }
    table::print(&HEADER, &rows);
    goals.extend(paper_keys::run()?);
    goals.extend(saving(setting)?);
    Ok(goals)
}

const HEADER: [&str; 11] = [
    "motion",
    "bound",
    "frames",
    "moving",
    "motion bytes",
    "file bytes",
    "2(k-1) numbers",
    "keys",
    "per frame",
    "saved",
    "the paper's",
];

/// What the key frames of a motion take at 16 bits a number.
struct Keys {
    /// Two numbers a segment of each moving channel: as many as the paper's method needs at most.
    segments: usize,
    /// The key values of each moving channel.
    values: usize,
}

impl Keys {
    /// Of the text of a .keys file: below each line `keys ...` there is a row for each key, its frame and a value for each channel.
    fn of(text: &str) -> Keys {
        let mut keys = Keys { segments: 0, values: 0 };
        let mut first = true;
        for line in text.lines() {
            let words = line.split_whitespace().count();
            match line.chars().next() {
                Some(' ') => {
                    keys.values += 2 * (words - 1);
                    keys.segments += if first { 0 } else { 2 * 2 * (words - 1) };
                    first = false;
                }
                _ => first = true,
            }
        }
        keys
    }
}

/// 16 bits for each frame of each channel that moves: a per-frame file as small as a plain one can be.
fn per_frame(made: &Converted) -> f64 {
    made.info.frames * made.info.moving * 2.0
}

fn saved(made: &Converted) -> f64 {
    100.0 * (1.0 - made.info.motion_bytes / per_frame(made))
}

fn row(name: &str, bound: &str, keys: Option<&Keys>, papers: f64, made: &Converted) -> Vec<String> {
    let info = &made.info;
    let mut row = vec![name.to_owned(), bound.to_owned()];
    row.extend([info.frames, info.moving, info.motion_bytes, info.file_bytes].map(|number| number.to_string()));
    row.extend(
        [keys.map(|keys| keys.segments), keys.map(|keys| keys.values)]
            .map(|bytes| bytes.map_or_else(String::new, |bytes| bytes.to_string())),
    );
    row.extend([per_frame(made).to_string(), format!("{:.1} %", saved(made))]);
    row.push(if keys.is_some() { papers.to_string() } else { String::new() });
    row
}

/// The walk's first frames, the walk, and the walk walked again.
fn saving(setting: &Setting) -> Result<Vec<Goal>> {
    let walk = import::load(&paths::root().join("motions/walk.keys"), &ImportOptions::new())?.motion;
    let whole = walk.frames;
    let lengths = [whole / 8, whole / 4, whole / 2, whole, 2 * whole, 4 * whole];
    let (mut rows, mut points) = (vec![], vec![]);
    for frames in lengths {
        let path = cut(setting, &walk, frames)?;
        let unit = Some(walk.rig.cm_per_unit);
        let made =
            setting.tool.converted(&path, &format!("walk-{frames}-{BOUND_CM}cm"), &tool::places_options(BOUND_CM, unit))?;
        rows.push(row("walk", &format!("{BOUND_CM} cm"), None, 0.0, &made));
        points.push((frames as f64, saved(&made)));
    }
    table::print(&HEADER, &rows);
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
    pantin_tools::output::save_bvh(&motion, path).with_context(|| path.display().to_string())?;
    Ok(path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_counted_at_16_bits() {
        for (name, segments, values) in [("walk", 352, 220), ("run", 264, 176)] {
            let path = paths::root().join("motions").join(name).with_extension("keys");
            let keys = Keys::of(&std::fs::read_to_string(path).unwrap());
            assert_eq!((keys.segments, keys.values), (segments, values), "{name}");
        }
    }
}
