//! What twice the frames a second cost: the 120 fps clips, and the same with every second and every fourth frame.

use std::path::PathBuf;

use anyhow::{Context, Result};
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::motion::Motion;

use super::reference::{self, Reference};
use super::table::geometric_mean;
use super::{Goal, Setting, table, tool};

const BOUND_CM: f64 = 1.0;

/// Percent more bytes at most for twice the frames.
const MOST: f64 = 15.0;

/// Converts each clip at 120, 60 and 30 fps.
pub fn run(setting: &Setting) -> Result<Vec<Goal>> {
    let Some(clips) = reference::all(setting)? else { return Ok(vec![]) };
    let (mut rows, mut more) = (vec![], [vec![], vec![]]);
    for clip in &clips {
        let options = ImportOptions::new().cm_per_unit(clip.cm_per_unit());
        let motion = import::load(&clip.path, &options)?.motion;
        if (motion.frame_time * 120.0 - 1.0).abs() > 0.01 {
            continue;
        }
        let mut bytes = [0.0; 3];
        for (bytes, stride) in bytes.iter_mut().zip([1, 2, 4]) {
            *bytes = measure(setting, clip, &motion, stride)?;
        }
        let ratios = [bytes[1] / bytes[2], bytes[0] / bytes[1]];
        more.iter_mut().zip(ratios).for_each(|(more, ratio)| more.push(ratio));
        let mut row = vec![clip.name.clone()];
        row.extend(bytes.map(|bytes| bytes.to_string()));
        row.extend(ratios.map(|ratio| format!("{:+.1} %", percent(ratio))));
        rows.push(row);
    }
    table::print(&["clip", "120 fps", "60 fps", "30 fps", "30 to 60", "60 to 120"], &rows);
    let steps = ["from 30 to 60", "from 60 to 120"].into_iter().zip(&more);
    let goals = steps.filter_map(|(step, ratios)| {
        let what = format!("more bytes {step} frames a second, {BOUND_CM} cm, geometric mean of {} clips", ratios.len());
        geometric_mean(ratios).map(|ratio| Goal::at_most(what, percent(ratio), MOST, 1, "%"))
    });
    Ok(goals.collect())
}

fn percent(ratio: f64) -> f64 {
    100.0 * (ratio - 1.0)
}

fn measure(setting: &Setting, clip: &Reference, motion: &Motion, stride: usize) -> Result<f64> {
    let path = match stride {
        1 => clip.path.clone(),
        _ => decimated(setting, clip, motion, stride)?,
    };
    // The name of the size part's clip where it is the same: it is not encoded twice.
    let name = if stride == 1 { clip.name.clone() } else { format!("{}-every{stride}", clip.name) };
    let made = setting.tool.converted(&path, &format!("{name}-{BOUND_CM}cm"), &tool::options(BOUND_CM, clip.cm_per_unit()));
    Ok(made.with_context(|| path.display().to_string())?.info.motion_bytes)
}

/// The motion with every `stride`th frame alone, as a file.
fn decimated(setting: &Setting, clip: &Reference, motion: &Motion, stride: usize) -> Result<PathBuf> {
    let every = |values: &Vec<f64>| values.iter().copied().step_by(stride).collect();
    let thin = Motion {
        frame_time: motion.frame_time * stride as f64,
        frames: motion.frames.div_ceil(stride),
        values: motion.values.iter().map(every).collect(),
        ..motion.clone()
    };
    let path = setting.out.join(format!("{}-every{stride}.bvh", clip.name));
    pantin_tools::output::save_bvh(&thin, &path)?;
    Ok(path)
}
