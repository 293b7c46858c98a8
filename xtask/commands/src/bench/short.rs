//! Short clips, where the start is a large part of the file, and noisy capture at tight bounds.

use anyhow::Result;

use super::reference::Reference;
use super::table::{geometric_mean, number};
use super::{Goal, Setting, error, table, tool};

/// The bound of the short clips.
const BOUND_CM: f64 = 1.0;
/// Frames of the cuts from the middle of each clip that has twice as many.
const CUTS: [f64; 2] = [25.0, 60.0];
/// Clips with few bytes, and the goals in bytes of motion.
const SMALL: [(&str, f64); 2] = [("bvh_mixamo-beta_run-loop", 464.0), ("bvh_mixamo-mia_gesture", 564.0)];
/// A noisy capture, its bounds, and the goals relative to the ideal coder.
const NOISY: &str = "bvh_assimp_boxing";
const NOISY_BOUNDS: [(f64, Option<f64>); 3] = [(0.06, None), (0.1, Some(0.5)), (0.15, None)];

/// All rows of which the clips are there.
pub fn run(setting: &Setting, clips: &[Reference]) -> Result<Vec<Goal>> {
    let mut goals = cuts(setting, clips)?;
    for (name, most) in SMALL {
        let Some(clip) = clips.iter().find(|clip| clip.name == name) else { continue };
        let options = tool::shell_options(BOUND_CM, clip.cm_per_unit());
        let made = setting.tool.converted(&clip.path, &format!("{name}-{BOUND_CM}cm"), &options)?;
        goals.push(Goal::at_most(format!("bytes of {name} at {BOUND_CM} cm"), made.info.motion_bytes, most, 0, "bytes"));
    }
    if let Some(clip) = clips.iter().find(|clip| clip.name == NOISY) {
        goals.extend(noisy(setting, clip)?);
    }
    Ok(goals)
}

fn cuts(setting: &Setting, clips: &[Reference]) -> Result<Vec<Goal>> {
    let mut goals = vec![];
    for cut in CUTS {
        let mut bytes = vec![];
        for clip in clips {
            let mut options = tool::shell_options(BOUND_CM, clip.cm_per_unit());
            let whole = setting.tool.converted(&clip.path, &format!("{}-{BOUND_CM}cm", clip.name), &options)?;
            if whole.info.frames < 2.0 * cut {
                continue;
            }
            let from = ((whole.info.frames - cut) / 2.0).floor();
            options.extend(["--from".to_owned(), from.to_string(), "--to".to_owned(), (from + cut - 1.0).to_string()]);
            let made = setting.tool.converted(&clip.path, &format!("{}-{BOUND_CM}cm-{cut}", clip.name), &options)?;
            bytes.push(made.info.motion_bytes);
        }
        let what = format!("bytes at {BOUND_CM} cm of {cut} frames from the middle of {} clips, geometric mean", bytes.len());
        goals.extend(geometric_mean(&bytes).map(|mean| Goal::told(what, format!("{mean:.0} bytes"))));
    }
    Ok(goals)
}

fn noisy(setting: &Setting, clip: &Reference) -> Result<Vec<Goal>> {
    let (mut goals, mut lines) = (vec![], vec![]);
    for (bound, most) in NOISY_BOUNDS {
        let options = tool::shell_options(bound, clip.cm_per_unit());
        let made = setting.tool.converted(&clip.path, &format!("{}-{bound}cm", clip.name), &options)?;
        let back = tempfile::Builder::new().suffix(".bvh").tempfile()?;
        setting.tool.expand(&made.clip, back.path())?;
        let got = error::between(&clip.path, back.path(), clip.cm_per_unit())?;
        let ideal = clip.peers.as_ref().and_then(|peers| peers.at(got.shell).ideal);
        let ratio = ideal.map(|ideal| made.info.motion_bytes / ideal);
        lines.push(vec![bound.to_string(), format!("{:.4}", got.shell), made.info.motion_bytes.to_string(), number(ratio, 3)]);
        let what = format!("bytes of {NOISY} at {bound} cm, relative to an ideal second-difference coder");
        goals.extend(ratio.map(|ratio| match most {
            Some(most) => Goal::at_most(what, ratio, most, 3, ""),
            None => Goal::told(what, format!("{ratio:.3}")),
        }));
    }
    table::print(&[NOISY, "joints", "bytes", "/ideal"], &lines);
    Ok(goals)
}
