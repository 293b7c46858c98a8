//! Recordings: the clips of `convert --stream` against one clip of all frames, at the same bound and effort.

use anyhow::Result;

use super::reference::Reference;
use super::table::geometric_mean;
use super::{Goal, Setting, table, tool};

const BOUND_CM: f64 = 1.0;
/// Delays in seconds, and the goals for the bytes relative to one clip: the geometric mean, and the worst clip. The second delay is the default.
const DELAYS: [(f64, f64, f64); 3] = [(2.0, 1.3, f64::INFINITY), (4.0, 1.3, f64::INFINITY), (10.0, 1.3, 1.3)];

/// Every clip at every delay.
pub fn run(setting: &Setting, clips: &[Reference]) -> Result<Vec<Goal>> {
    let (mut lines, mut goals) = (vec![], vec![]);
    let mut ratios = DELAYS.map(|_| vec![]);
    for clip in clips {
        let options = tool::shell_options(BOUND_CM, clip.cm_per_unit());
        let whole = setting.tool.converted(&clip.path, &format!("{}-{BOUND_CM}cm", clip.name), &options)?;
        let mut line = vec![clip.name.clone(), format!("{:.1}", whole.info.seconds()), whole.info.motion_bytes.to_string()];
        for ((delay, ..), ratios) in DELAYS.iter().zip(&mut ratios) {
            let (bytes, count) = setting.tool.record(&clip.path, *delay, &options)?;
            let ratio = bytes / whole.info.motion_bytes;
            line.push(format!("{ratio:.3} ({count})"));
            ratios.push(ratio);
        }
        lines.push(line);
    }
    let title = |delay: f64| format!("/one clip, {delay} s (clips)");
    let titles = DELAYS.map(|(delay, ..)| title(delay));
    let header: Vec<&str> = ["clip", "s", "bytes"].into_iter().chain(titles.iter().map(String::as_str)).collect();
    table::print(&header, &lines);
    for ((delay, mean, most), ratios) in DELAYS.iter().zip(&ratios) {
        let what =
            |of: &str| format!("bytes at {BOUND_CM} cm of a recording with a delay of {delay} s, relative to one clip, {of}");
        goals.extend(geometric_mean(ratios).map(|ratio| Goal::at_most(what("geometric mean"), ratio, *mean, 3, "")));
        let worst = ratios.iter().copied().reduce(f64::max);
        goals.extend(worst.map(|ratio| match most.is_finite() {
            true => Goal::at_most(what("worst clip"), ratio, *most, 3, ""),
            false => Goal::told(what("worst clip"), format!("{ratio:.3}")),
        }));
    }
    Ok(goals)
}
