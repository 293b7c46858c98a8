//! When a transition looks right: pairs of frames of two clips that are alike in pose, speed and feet.

use anyhow::Result;
use pantin_convert::Memory;
use pantin_convert::edit::contacts::Contact;
use pantin_convert::fk::all_positions;
use pantin_convert::motion::Motion;

/// Seconds of velocity that count like a difference of places.
const FORESIGHT: f64 = 0.1;
/// What a foot costs that is on the ground in one clip alone, in cm.
const OTHER_FOOT_CM: f64 = 8.0;
/// Seconds of a clip that is no loop in which a transition may enter it.
const FIRST: f64 = 0.2;
/// Frames of a clip that are compared at most.
const FRAMES: usize = 240;

/// What is compared of a clip.
pub(super) struct Clip {
    /// For each frame, each joint: horizontal places about their mean, the height, and the same of the velocity, in cm and cm a second.
    poses: Vec<Vec<[f64; 6]>>,
    /// Which feet are on the ground.
    feet: Vec<Vec<bool>>,
    frame_time: f64,
    looped: bool,
}

impl Clip {
    pub fn of(motion: &Motion, contacts: &[Vec<Contact>]) -> Result<Clip> {
        let places = all_positions(&motion.rig, &motion.values, motion.frames, Memory::default())?;
        let up = motion.rig.up.axis();
        let axes = [(up + 1) % 3, (up + 2) % 3, up];
        let pose = |frame: usize| {
            let (before, after) = (frame.saturating_sub(1), (frame + 1).min(motion.frames - 1));
            let seconds = (after - before).max(1) as f64 * motion.frame_time;
            let count = places[frame].len().max(1) as f64;
            let mean: Vec<f64> =
                axes.iter().map(|&axis| places[frame].iter().map(|place| place[axis]).sum::<f64>() / count).collect();
            let joint = |joint: usize| {
                let at = |axis: usize| places[frame][joint][axes[axis]];
                let v = |axis: usize| (places[after][joint][axes[axis]] - places[before][joint][axes[axis]]) / seconds;
                [at(0) - mean[0], at(1) - mean[1], at(2), v(0), v(1), v(2)]
            };
            (0..places[frame].len()).map(joint).collect()
        };
        let feet = |frame: usize| {
            let down = |foot: &Vec<Contact>| foot.iter().any(|contact| (contact.from..contact.to).contains(&frame));
            contacts.iter().map(down).collect()
        };
        Ok(Clip {
            poses: (0..motion.frames).map(pose).collect(),
            feet: (0..motion.frames).map(feet).collect(),
            frame_time: motion.frame_time,
            looped: motion.looped,
        })
    }
}

/// How different two instants are, in cm: the mean over the joints, after the turn about the vertical axis that brings the poses together.
fn apart(a: (&Clip, usize), b: (&Clip, usize)) -> f64 {
    let [own, other] = [a, b].map(|(clip, frame)| &clip.poses[frame]);
    let (mut along, mut across) = (0.0, 0.0);
    for (p, q) in own.iter().zip(other) {
        along += p[0] * q[0] + p[1] * q[1];
        across += q[0] * p[1] - q[1] * p[0];
    }
    let (sin, cos) = across.atan2(along).sin_cos();
    let turned = |x: f64, y: f64| [x * cos - y * sin, x * sin + y * cos];
    let distance = |(p, q): (&[f64; 6], &[f64; 6])| {
        let ([x, y], [u, v]) = (turned(q[0], q[1]), turned(q[3], q[4]));
        let way = (p[0] - x).hypot(p[1] - y).hypot(p[2] - q[2]);
        let velocity = (p[3] - u).hypot(p[4] - v).hypot(p[5] - q[5]);
        way + FORESIGHT * velocity
    };
    let joints = own.len().max(1) as f64;
    let [own_feet, other_feet] = [a, b].map(|(clip, frame)| &clip.feet[frame]);
    let feet = own_feet.iter().zip(other_feet).filter(|(own, other)| own != other).count();
    own.iter().zip(other).map(distance).sum::<f64>() / joints + OTHER_FOOT_CM * feet as f64
}

/// Pairs of a frame of the old clip and the frame of the new one that follows it: whenever a transition is asked for, the best pair within a time is
/// among them. `start` is the only frame of the new clip, if one is given.
pub(super) fn best(from: &Clip, to: &Clip, start: Option<usize>, within: f64) -> Vec<(usize, usize)> {
    let (frames, others) = (from.poses.len(), to.poses.len());
    let starts: Vec<usize> = match start {
        Some(start) => vec![start.min(others - 1)],
        None if to.looped => (0..others).step_by(others.div_ceil(FRAMES)).collect(),
        None => (0..=((FIRST / to.frame_time) as usize).min(others - 1)).collect(),
    };
    let stride = frames.div_ceil(FRAMES);
    let found: Vec<(usize, usize, f64)> = (0..frames)
        .step_by(stride)
        .filter_map(|at| {
            let costs = starts.iter().map(|&start| (start, apart((from, at), (to, start))));
            costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(start, cost)| (at, start, cost))
        })
        .collect();
    let window = ((within / from.frame_time) as usize / stride).max(1);
    let mut chosen: Vec<(usize, usize)> = Vec::new();
    for first in 0..found.len() {
        let ahead =
            (first..first + window).map(|index| if from.looped { index % found.len() } else { index.min(found.len() - 1) });
        // Of equal ones the first.
        if let Some(index) = ahead.min_by(|&a, &b| found[a].2.total_cmp(&found[b].2)) {
            let (at, start, _) = found[index];
            chosen.push((at, start));
        }
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}
