//! Finds the frames at which a foot begins to bear weight.
//!
//! A point of a foot (the joint itself, and what hangs on it) is planted while it is near the lowest place that it has in the clip and stands still against the
//! ground. The ground's own velocity is the median of what is near it: of a walk in place the ground moves backwards. A foot is down while one of
//! its points is planted, but for moments shorter than a person can step.

use super::sides::{Part, Side, parts};
use crate::error::{Error, Setting, require};
use crate::fk::{all_positions, distance};
use crate::memory::Memory;
use crate::motion::{Event, Motion};
use anyhow::Result;
use pantin::{LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};

/// Part of the leg's length by which a planted point is above its lowest place at most.
const LOW: f64 = 0.07;
/// Part of the foot's highest speeds, of which a tenth are higher, below which it stands.
const SLOW: f64 = 0.25;
/// Leg's lengths a second: feet that step are faster. Where a foot hardly leaves the ground in a clip, its highest speeds are those of standing.
const STEPPING: f64 = 1.0;
/// Seconds: a shorter time in the air is none, nor is a shorter one on the ground.
const SHORTEST: f64 = 0.07;
/// Seconds over which a velocity is measured, half before and half after the frame.
const SPAN: f64 = 0.05;
/// Names of a leg's end, in the order in which they are looked for.
const FEET: [&str; 3] = ["foot", "ankle", "toe"];

/// The events of `motion`, in the order of their frames.
pub fn footsteps(motion: &Motion, memory: Memory) -> Result<Vec<Event>> {
    let names: Vec<String> = motion.rig.joints.iter().map(|joint| joint.name.clone()).collect();
    let parts = parts(&names);
    let (left, right) = (foot(&parts, Side::Left), foot(&parts, Side::Right));
    require!(left.is_some() || right.is_some(), Error::setting(Setting::Footsteps, NO_FOOT));
    let poses = all_positions(&motion.rig, &motion.values, motion.frames, memory)?;
    let mut events = Vec::new();
    let feet: Vec<(usize, &str)> = left
        .into_iter()
        .map(|foot| (foot, LEFT_FOOT_DOWN))
        .chain(right.into_iter().map(|foot| (foot, RIGHT_FOOT_DOWN)))
        .collect();
    let tracks: Vec<Vec<FootPoint>> = feet.iter().map(|&(foot, _)| tracks(motion, &poses, foot)).collect();
    let ground = ground(&tracks);
    for ((_, name), points) in feet.into_iter().zip(&tracks) {
        let starts = starts(motion, &down(motion, points, ground));
        events.extend(starts.into_iter().map(|frame| Event { frame, name: name.into() }));
    }
    events.sort_by_key(|event| event.frame);
    Ok(events)
}

/// The joint of a side that is named as a foot, an ankle or a toe.
pub(super) fn foot(parts: &[Part], side: Side) -> Option<usize> {
    FEET.iter().find_map(|word| parts.iter().position(|part| part.side == Some(side) && part.rest.contains(word)))
}

/// Why no feet are found.
pub(super) const NO_FOOT: &str = "no joint is named as a left or a right foot, ankle or toe, as in LeftFoot, Foot_L or lfoot";

/// A point of a foot.
pub(super) struct FootPoint {
    /// Its joint.
    pub joint: usize,
    /// Above the lowest place of the clip, in cm.
    pub height: Vec<f64>,
    /// In cm a second.
    pub velocity: Vec<[f64; 3]>,
    /// Height below which it can be planted.
    pub low: f64,
    /// The least speed of a step.
    stepping: f64,
}

/// The foot's joint and all that hangs on it.
pub(super) fn tracks(motion: &Motion, poses: &[Vec<[f64; 3]>], foot: usize) -> Vec<FootPoint> {
    let joints = &motion.rig.joints;
    let mut of_foot = vec![false; joints.len()];
    for (index, joint) in joints.iter().enumerate() {
        of_foot[index] = index == foot || joint.parent.is_some_and(|parent| of_foot[parent]);
    }
    // Two bones up is where the leg begins, whatever the joints between are called.
    let above = |joint: usize| joints[joint].parent.unwrap_or(joint);
    let leg = distance(poses[0][foot], poses[0][above(foot)]) + distance(poses[0][above(foot)], poses[0][above(above(foot))]);
    let axis = motion.rig.up.axis();
    let sign = if motion.rig.up.is_negative() { -1.0 } else { 1.0 };
    let half = ((SPAN / motion.frame_time / 2.0).round() as usize).max(1);
    let track = |point: usize| {
        let heights: Vec<f64> = poses.iter().map(|pose| sign * pose[point][axis]).collect();
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let velocity = |frame: usize| {
            let (before, after) = (frame.saturating_sub(half), (frame + half).min(poses.len() - 1));
            let seconds = (after - before).max(1) as f64 * motion.frame_time;
            std::array::from_fn(|axis| (poses[after][point][axis] - poses[before][point][axis]) / seconds)
        };
        FootPoint {
            joint: point,
            height: heights.iter().map(|height| height - lowest).collect(),
            velocity: (0..poses.len()).map(velocity).collect(),
            low: LOW * leg,
            stepping: STEPPING * leg,
        }
    };
    (0..joints.len()).filter(|&point| of_foot[point]).map(track).collect()
}

/// The velocity of what is near the ground, axis by axis in the median.
pub(super) fn ground(feet: &[Vec<FootPoint>]) -> [f64; 3] {
    std::array::from_fn(|axis| {
        let near = |track: &'_ FootPoint| -> Vec<f64> {
            let frames = track.height.iter().zip(&track.velocity);
            frames.filter(|(height, _)| **height < track.low / 2.0).map(|(_, velocity)| velocity[axis]).collect()
        };
        let mut all: Vec<f64> = feet.iter().flatten().flat_map(near).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(0.0)
    })
}

/// Whether the figure goes over the ground, whose horizontal speed is given in cm a second, and does not tread on the spot: the ground is slower than
/// `standing`, or than a fourth of the figure's own speed. Feet that run hardly stand.
pub(super) fn goes_over(ground: f64, poses: &[Vec<[f64; 3]>], motion: &Motion, standing: f64) -> bool {
    let up = motion.rig.up.axis();
    let middle = |pose: &[[f64; 3]], axis: usize| pose.iter().map(|place| place[axis]).sum::<f64>() / pose.len() as f64;
    let (first, last) = (&poses[0], &poses[poses.len() - 1]);
    let [side, ahead] = [1, 2].map(|turn| (up + turn) % 3).map(|axis| middle(last, axis) - middle(first, axis));
    let seconds = (poses.len() - 1).max(1) as f64 * motion.frame_time;
    ground <= standing.max(side.hypot(ahead) / seconds / 4.0)
}

/// Whether the foot is down, for each frame.
pub(super) fn down(motion: &Motion, points: &[FootPoint], ground: [f64; 3]) -> Vec<bool> {
    let planted = |track: &FootPoint| -> Vec<bool> {
        let speeds: Vec<f64> = track.velocity.iter().map(|&velocity| distance(velocity, ground)).collect();
        // Of the moving frames alone: how long a foot stands before and after says nothing about its steps.
        let mut moving: Vec<f64> = speeds.iter().copied().filter(|&speed| speed > SLOW * track.stepping).collect();
        moving.sort_by(f64::total_cmp);
        let fast = moving.get(moving.len() * 9 / 10).map_or(track.stepping, |&fast| fast.max(track.stepping));
        let planted = track.height.iter().zip(&speeds);
        planted.map(|(&height, &speed)| height < track.low && speed < SLOW * fast).collect()
    };
    let planted: Vec<Vec<bool>> = points.iter().map(planted).collect();
    let mut down: Vec<bool> = (0..motion.frames).map(|frame| planted.iter().any(|point| point[frame])).collect();
    let shortest = (SHORTEST / motion.frame_time).ceil() as usize;
    drop_short(&mut down, false, shortest, motion.looped);
    drop_short(&mut down, true, shortest, motion.looped);
    down
}

/// Turns runs of `value` that are shorter than `shortest` frames into their opposite; but for those that the clip cuts off.
fn drop_short(down: &mut [bool], value: bool, shortest: usize, looped: bool) {
    let frames = down.len();
    let Some(first) = (0..frames).find(|&frame| down[frame] != value) else { return };
    // From a frame of the other value once round, so that no run of a loop is cut.
    let mut run = Vec::new();
    for frame in (first..frames).chain(0..=first) {
        let cut = !looped && (frame == 0 || run.last() == Some(&(frames - 1)));
        if cut {
            run.clear();
        }
        if down[frame] == value {
            run.push(frame);
            continue;
        }
        if run.len() < shortest && (looped || run.first() != Some(&0)) {
            run.iter().for_each(|&frame| down[frame] = !value);
        }
        run.clear();
    }
}

/// Frames at which the foot comes down. Without a loop, one that is down at the begin did so before.
fn starts(motion: &Motion, down: &[bool]) -> Vec<usize> {
    let before = |frame: usize| match frame {
        0 => {
            if motion.looped {
                down[down.len() - 1]
            } else {
                true
            }
        }
        frame => down[frame - 1],
    };
    (0..down.len()).filter(|&frame| down[frame] && !before(frame)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dropped(runs: &str, value: bool, looped: bool) -> String {
        let mut down: Vec<bool> = runs.bytes().map(|byte| byte == b'1').collect();
        drop_short(&mut down, value, 3, looped);
        down.into_iter().map(|down| if down { '1' } else { '0' }).collect()
    }

    #[test]
    fn short_runs_go_and_those_that_the_clip_cuts_stay() {
        assert_eq!(dropped("1110011100111", false, false), "1111111111111");
        assert_eq!(dropped("1100011100111", true, false), "1100011100111");
        assert_eq!(dropped("0011000111000", true, false), "0000000111000");
        assert_eq!(dropped("1000001110000", true, true), "0000001110000");
        assert_eq!(dropped("1000001110011", true, true), "1000001110011");
        assert_eq!(dropped("0000", true, true), "0000");
        assert_eq!(dropped("1111", true, false), "1111");
    }
}
