//! The stretches of a motion that make the best loops.
//!
//! A cut from one frame to another loops well if the poses of both are alike, and those of the frames after them. The way that the figure goes on the ground does not count: a loop keeps
//! it. A stretch in which less happens than in the whole motion is no cycle, since standing still is a perfect loop: of those the best one of a second or more is proposed
//! apart, as one for standing. A stretch that cannot be closed, as its ends' angles are too different, is not proposed.

use super::cut;
use super::loop_seam::{LeastSeam, least_seam, places_root};
use crate::conversion::{CLOSING, Distance};
use crate::error::{Error, Setting, require};
use crate::fk::{all_positions, distance};
use crate::motion::Motion;
use crate::options::Options;
use anyhow::Result;

/// A proposal.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// The first frame.
    pub from: usize,
    /// The last frame, at which the pose is that of the first one again.
    pub to: usize,
    /// The farthest that a joint is in one pose from where it is in the other, in cm, as closing the loop measures it.
    pub seam_cm: f64,
    /// The least bound with which the loop is closed, in cm.
    pub bound_cm: f64,
    /// The joint.
    pub joint: String,
    /// The farthest that a joint is turned in the world from one pose to the other, in degrees.
    pub seam_deg: f64,
    /// The least bound on rotations in the world with which the loop is closed, in degrees.
    pub bound_deg: f64,
    /// Whether the figure moves little in it: a loop for standing, not a cycle.
    pub still: bool,
}

/// Proposals that are returned at most.
const CUTS: usize = 3;
/// Seconds: a shorter stretch is no cycle.
const SHORTEST: f64 = 0.4;
/// Part of the mean movement a frame below which a stretch is too still.
const LIVELY: f64 = 0.6;
/// Mean speed of the joints in cm a second below which the figure stands, whatever it does elsewhere in the motion.
const STANDING: f64 = 4.0;
/// Stretches that are tried at most: some cannot be closed.
const ATTEMPTS: usize = 24;
/// Seconds: a shorter stretch is too short to stand in.
const SHORTEST_STILL: f64 = 1.0;
/// Poses that are compared with each other at most; of a longer motion, every few frames, and then the frames beside the best.
const POSES: usize = 1200;

/// The best cuts, the best first, and after them one for standing, if the figure stands anywhere and none of the others is one. Seams are measured at the points that `options` bound, and joints
/// turn by less than [`Options::max_rotation_error`] there, if it is given.
pub fn find(motion: &Motion, options: &Options) -> Result<Vec<Cut>> {
    let bare = unmarked(motion);
    let motion = &bare;
    let shortest = ((SHORTEST / motion.frame_time).round() as usize).max(2);
    let wrong = |text: String| Error::setting(Setting::FindLoop, text);
    require!(!motion.rig.joints.is_empty(), wrong("the motion has no joints".into()));
    let frames = motion.frames;
    require!(frames > shortest + 1, wrong(format!("{frames} frames; expected more than {}", shortest + 1)));
    let poses = all_positions(&motion.rig, &on_the_spot(motion), motion.frames, options.memory)?;
    let apart = |a: usize, b: usize| greatest(&poses[a], &poses[b]);
    // The movement up to each frame.
    let mut moved = vec![0.0; motion.frames];
    for frame in 1..motion.frames {
        moved[frame] = moved[frame - 1] + mean(&poses[frame - 1], &poses[frame]);
    }
    let still = LIVELY * moved[motion.frames - 1] / (motion.frames - 1) as f64;
    let lively = |from: usize, to: usize| moved[to] - moved[from] >= still * (to - from) as f64;
    // Alike in the pose and in where it goes, or where it came from; of the whole motion only the pose is known.
    let cost = |from: usize, to: usize| {
        let beside = match (from.checked_sub(1), to + 1 < motion.frames) {
            (_, true) => apart(from + 1, to + 1).0,
            (Some(before), false) => apart(before, to - 1).0,
            (None, false) => 0.0,
        };
        apart(from, to).0.max(beside)
    };
    let stride = motion.frames.div_ceil(POSES);
    // Of each begin the best end, so that the list stays short.
    let best = |shortest: usize, fits: &dyn Fn(usize, usize) -> bool| {
        let of = |from: usize| {
            let ends = (from + shortest..motion.frames).step_by(stride).filter(|&to| fits(from, to));
            ends.map(|to| (cost(from, to), from, to)).min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let mut found: Vec<(f64, usize, usize)> = (0..motion.frames).step_by(stride).filter_map(of).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    };
    let standing = |from: usize, to: usize| {
        let most = (still / 2.0).max(STANDING * motion.frame_time);
        moved[to] - moved[from] < most * (to - from) as f64
    };
    let around = |frame: usize| frame.saturating_sub(stride - 1)..=(frame + stride - 1).min(motion.frames - 1);
    let refined = |from: usize, to: usize| {
        let pairs = around(from).flat_map(|from| around(to).map(move |to| (from, to)));
        let pairs = pairs.filter(|&(from, to)| to >= from + shortest && lively(from, to));
        pairs.min_by(|a, b| cost(a.0, a.1).total_cmp(&cost(b.0, b.1)))
    };
    let cut = |(from, to): (usize, usize)| proposal(motion, options, [from, to], standing(from, to));
    let near = |a: usize, b: usize| a.abs_diff(b) < shortest / 2 + stride;
    let (mut cuts, mut tried): (Vec<Cut>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
    for (_, from, to) in best(shortest, &lively) {
        if cuts.len() == CUTS || tried.len() == ATTEMPTS {
            break;
        }
        if !tried.iter().any(|&(other, end)| near(from, other) && near(to, end)) {
            tried.push((from, to));
            cuts.extend(refined(from, to).map(cut).transpose()?.flatten());
        }
    }
    cuts.sort_by(|a, b| a.seam_cm.total_cmp(&b.seam_cm));
    if !cuts.iter().any(|cut| cut.still) {
        let shortest = ((SHORTEST_STILL / motion.frame_time).round() as usize).max(2);
        for (_, from, to) in best(shortest, &standing).into_iter().take(ATTEMPTS) {
            if let Some(found) = cut((from, to))? {
                cuts.push(Cut { still: true, ..found });
                break;
            }
        }
    }
    Ok(cuts)
}

/// The proposal of a first and a last frame; `None` where no bound is enough to close the loop, as between angles that are too different, or more than `options` allow.
fn proposal(motion: &Motion, options: &Options, [from, to]: [usize; 2], still: bool) -> Result<Option<Cut>> {
    let part = cut::cut(motion, Some(from), Some(to))?;
    let Ok(LeastSeam { cm: seam_cm, joint, degrees: seam_deg, bound_cm, bound_deg }) =
        least_seam(&part, &Distance::of(options, &part)?.pose, CLOSING)
    else {
        return Ok(None);
    };
    if options.max_rotation_error.is_some_and(|most| bound_deg >= most) {
        return Ok(None);
    }
    // What the file's own rounding takes of a bound.
    let bound_cm = bound_cm + motion.origin.error_cm;
    Ok(Some(Cut { from, to, seam_cm, bound_cm, joint, seam_deg, bound_deg, still }))
}

/// The motion as one that is no loop yet.
fn unmarked(motion: &Motion) -> Motion {
    Motion { looped: false, ..motion.clone() }
}

/// The motion without the way of the root on the ground.
fn on_the_spot(motion: &Motion) -> Vec<Vec<f64>> {
    let kinds = motion.rig.channel_kinds();
    let goes = |channel: usize| kinds[channel].1.axis() != Some(motion.rig.up.axis()) && places_root(motion, kinds[channel]);
    let still =
        |(channel, values): (usize, &Vec<f64>)| if goes(channel) { vec![values[0]; values.len()] } else { values.clone() };
    motion.values.iter().enumerate().map(still).collect()
}

fn greatest(a: &[[f64; 3]], b: &[[f64; 3]]) -> (f64, usize) {
    let apart = a.iter().zip(b).map(|(a, b)| distance(*a, *b)).enumerate();
    apart.map(|(joint, cm)| (cm, joint)).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
}

fn mean(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| distance(*a, *b)).sum::<f64>() / a.len().max(1) as f64
}
