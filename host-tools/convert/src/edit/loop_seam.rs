//! A motion whose last frame is nearly its first becomes one that comes round.
//!
//! The last frame is to be the first one again: half of their difference is added towards the end and half taken away towards
//! the begin, on a straight line over the clip, and the last frame, now equal to the first, left out. So no joint moves by much more
//! than half of the seam.

use crate::error::{Error, Setting, require};
use crate::euler;
use crate::fit::bounds::Bounds;
use crate::fk::{FramePose, distance, frame_pose, local, positions};
use crate::motion::{Kind, Motion};
use crate::note::Remedy;
use crate::pose_bound::{PoseBound, angle_deg, bounded, shell_distance_cm};
use anyhow::Result;

/// A loop, and what closing it took.
#[derive(Clone, Debug)]
pub struct Closed {
    /// Marked as a loop.
    pub motion: Motion,
    /// The farthest that a joint in the last frame was from where it is in the first, in cm, and that joint. The points of its shell count
    /// if the bound is one on the shell.
    pub seam_cm: f64,
    /// The joint of the greatest seam.
    pub seam_joint: String,
    /// The farthest that a joint in the last frame was turned in the world from how it is in the first, in degrees.
    pub seam_deg: f64,
    /// The farthest that a joint was moved, in cm, measured alike.
    pub moved_cm: f64,
    /// The joint.
    pub joint: String,
    /// The farthest that a joint was turned in the world, in degrees.
    pub turned_deg: f64,
    /// The farthest that a joint was turned in its parent, in degrees.
    pub turned_joint_deg: f64,
    /// The farthest that a channel's value was moved, one a channel, in the motion's units.
    pub moved: Vec<f64>,
    /// Channels of the root's place that do not come back: the movement of one cycle.
    pub travel: Vec<(String, f64)>,
}

/// What the seam of a motion may be.
#[derive(Clone, Copy, Debug)]
pub enum Most<'a> {
    /// Greatest distance and rotation of a joint in the last frame from where it is in the first, and of scalars the greatest difference
    /// as a part of full scale.
    Distance(&'a PoseBound, f64),
    /// The greatest difference of each channel.
    Channels(&'a Bounds),
}

fn open(text: String) -> Error {
    Error::setting(Setting::Loop, text)
}

/// Joints that the closed seam leaves farther than this from each other, in cm, are not closed. Angles that turn alike another way come out of a matrix,
/// which blurs them where two axes nearly coincide.
const CLOSED_CM: f64 = 1e-3;

/// Closes `motion`. Refuses a seam that is more than `most`, naming its worst joint or channel.
pub fn close(motion: &Motion, most: Most) -> Result<Closed> {
    first_that_fits(motion, most, |ways| close_but_for(motion, most, ways))
}

/// The result of the first choice of ways that `attempt` accepts, or the error of the choice with the least seam.
///
/// A place of the root that does not come back is a way that the figure goes, and is kept, or a part of the seam, and is closed. As few as possible are ways: those
/// that are more than the bound, and others where the seam is within the bound without them alone. So a looser bound takes what a tighter one takes.
pub(crate) fn first_that_fits<T>(motion: &Motion, most: Most, attempt: impl Fn(&[usize]) -> Result<T>) -> Result<T> {
    let steps = if motion.frames > 0 { differences(motion) } else { Vec::new() };
    let mut refused = None;
    for ways in choices(motion, &steps, most) {
        let seam_cm = if motion.frames > 0 { seam(motion, &ways, most.shell_cm()).cm } else { 0.0 };
        match attempt(&ways) {
            Ok(done) => return Ok(done),
            Err(error) if refused.as_ref().is_none_or(|(least, _)| seam_cm < *least) => refused = Some((seam_cm, error)),
            Err(_) => {}
        }
    }
    Err(refused.map_or_else(|| open("the motion has no seam".into()).into(), |(_, error)| error))
}

/// The seam of a motion, and the least bounds with which it is closed.
pub(crate) struct LeastSeam {
    /// How far the farthest joint is off in cm, and the joint.
    pub cm: f64,
    pub joint: String,
    /// How far a joint is turned in the world at most, in degrees.
    pub degrees: f64,
    pub bound_cm: f64,
    pub bound_deg: f64,
}

/// The seam of the choice of ways with which the least bound on the points of `pose` is enough. Closing takes less than the part `closing` of a bound.
pub(crate) fn least_seam(motion: &Motion, pose: &PoseBound, closing: f64) -> Result<LeastSeam> {
    let bound = PoseBound { shell: pose.shell, ..PoseBound::places(f64::MAX) };
    let most = Most::Distance(&bound, f64::MAX);
    let steps = differences(motion);
    let mut least: Option<LeastSeam> = None;
    for ways in choices(motion, &steps, most) {
        let closed = close_but_for(motion, most, &ways)?;
        let (bound_cm, degrees) = (closed.seam_cm.max(closed.moved_cm / closing), closed.seam_deg);
        if least.as_ref().is_none_or(|other| bound_cm < other.bound_cm) {
            let (cm, joint, bound_deg) = (closed.seam_cm, closed.seam_joint, degrees.max(closed.turned_deg / closing));
            least = Some(LeastSeam { cm, joint, degrees, bound_cm, bound_deg });
        }
    }
    least.ok_or_else(|| open("the motion has no seam".into()).into())
}

/// Ways of the root that are chosen from at most: all choices are tried.
const WAYS: usize = 6;

/// The choices of channels that are ways, those with fewest first.
fn choices(motion: &Motion, steps: &[f64], most: Most) -> Vec<Vec<usize>> {
    let kinds = motion.rig.channel_kinds();
    let limit = |channel: usize| match most {
        Most::Distance(bound, _) => bound.max_cm / motion.rig.cm_per_unit,
        Most::Channels(bounds) => bounds.greatest[channel],
    };
    // A figure goes over the ground: a height that does not come back is a part of the seam.
    let level = |kind: Kind| kind.axis() != Some(motion.rig.up.axis());
    let goes = |channel: usize| places_root(motion, kinds[channel]) && level(kinds[channel].1);
    let moved = (0..steps.len()).filter(|&channel| steps[channel] != 0.0 && goes(channel));
    let (far, near): (Vec<usize>, Vec<usize>) = moved.partition(|&channel| steps[channel].abs() > limit(channel));
    // Channels that are bounded one by one need no choice.
    let near = if matches!(most, Most::Channels(_)) { &[][..] } else { &near[..near.len().min(WAYS)] };
    let mut choices: Vec<Vec<usize>> = (0..1u32 << near.len())
        .map(|chosen| {
            let also = near.iter().enumerate().filter(|(bit, _)| chosen >> bit & 1 != 0).map(|(_, &channel)| channel);
            far.iter().copied().chain(also).collect()
        })
        .collect();
    choices.sort_by_key(Vec::len);
    choices
}

/// Closes `motion`, but for channels that are ways of the figure.
pub(crate) fn close_but_for(motion: &Motion, most: Most, ways: &[usize]) -> Result<Closed> {
    if motion.looped {
        return Ok(Closed {
            motion: motion.clone(),
            seam_cm: 0.0,
            seam_joint: String::new(),
            seam_deg: 0.0,
            moved_cm: 0.0,
            joint: String::new(),
            turned_deg: 0.0,
            turned_joint_deg: 0.0,
            moved: vec![0.0; motion.values.len()],
            travel: Vec::new(),
        });
    }
    let short = || open(format!("{} frames are no loop; expected 3 or more", motion.frames));
    require!(motion.frames > 2, short());
    let mut steps = differences(motion);
    let travel: Vec<(usize, f64)> = ways.iter().map(|&channel| (channel, -std::mem::take(&mut steps[channel]))).collect();
    check(motion, &steps, ways, most)?;
    let shell_cm = most.shell_cm();
    let gap = seam(motion, ways, shell_cm);
    let (seam_cm, seam_joint, seam_deg) = (gap.cm, gap.name(motion), gap.degrees);
    let last = (motion.frames - 1) as f64;
    let part = |frame: usize| frame as f64 / last - 0.5;
    let mut out = motion.clone();
    for (values, step) in out.values.iter_mut().zip(&steps) {
        values.iter_mut().enumerate().for_each(|(frame, value)| *value += step * part(frame));
    }
    let gap = seam(&out, ways, shell_cm).cm;
    let jump = || open(format!("the seam's angles are too different to be closed (the pose would still jump by {gap:.3} cm)"));
    require!(gap < CLOSED_CM, jump());
    for (keys, step) in out.keys.iter_mut().zip(&steps) {
        *keys = keys.take().filter(|_| *step == 0.0);
    }
    let closing = farthest(motion, &out, shell_cm);
    out.values.iter_mut().for_each(|values| values.truncate(motion.frames - 1));
    out.keys.iter_mut().for_each(|keys| *keys = None);
    out.frames -= 1;
    // The frame that is left out is frame 0 again.
    out.events.iter_mut().filter(|event| event.frame == out.frames).for_each(|event| event.frame = 0);
    out.events.sort_by_key(|event| event.frame);
    out.events.dedup();
    out.looped = true;
    let moved = steps.iter().map(|step| step.abs() / 2.0).collect();
    let named = travel.into_iter().map(|(channel, way)| (motion.rig.channel_name(channel), way)).collect();
    Ok(Closed {
        motion: out,
        seam_cm,
        seam_joint,
        seam_deg,
        moved_cm: closing.cm,
        joint: closing.name(motion),
        turned_deg: closing.degrees,
        turned_joint_deg: closing.joint_degrees,
        moved,
        travel: named,
    })
}

/// A loop of a motion that was one cycle already.
#[derive(Clone, Debug)]
pub struct Joined {
    /// Marked as a loop.
    pub motion: Motion,
    /// The farthest that a joint goes from the last frame to the first, in cm, and the farthest that one goes in any other step; but for
    /// the way of the root. `None` without joints.
    pub joints_cm: Option<[f64; 2]>,
    /// The same of scalars, as a part of full scale. `None` without scalars.
    pub scalars: Option<[f64; 2]>,
}

/// Makes a loop of a motion that is one cycle without its first frame again at the end: frame 0 follows the last frame.
pub fn join_ends(motion: &Motion) -> Result<Joined> {
    let short = || Error::setting(Setting::CloseLoop, format!("{} frames are no loop; expected 3 or more", motion.frames));
    require!(motion.frames > 2, short());
    let mut out = motion.clone();
    out.looped = true;
    out.keys.iter_mut().for_each(|keys| *keys = None);
    let kinds = motion.rig.channel_kinds();
    let ways: Vec<usize> = (0..kinds.len()).filter(|&channel| places_root(motion, kinds[channel])).collect();
    let still: Vec<Vec<f64>> = motion
        .values
        .iter()
        .enumerate()
        .map(|(channel, values)| if ways.contains(&channel) { vec![values[0]; values.len()] } else { values.clone() })
        .collect();
    let joints = |from: usize, to: usize| {
        let (a, b) = (positions(&motion.rig, &still, from), positions(&motion.rig, &still, to));
        greatest(a.into_iter().zip(b).map(|(a, b)| distance(a, b))).0
    };
    let scalars = |from: usize, to: usize| {
        let values = motion.rig.scalars.iter().zip(&motion.values[motion.rig.joint_channels()..]);
        values.map(|(scalar, values)| (values[to] - values[from]).abs() / scalar.full_scale).fold(0.0, f64::max)
    };
    let steps = |step: &dyn Fn(usize, usize) -> f64| {
        let inside = (1..motion.frames).map(|frame| step(frame - 1, frame)).fold(0.0, f64::max);
        [step(motion.frames - 1, 0), inside]
    };
    Ok(Joined {
        motion: out,
        joints_cm: (!motion.rig.joints.is_empty()).then(|| steps(&joints)),
        scalars: (!motion.rig.scalars.is_empty()).then(|| steps(&scalars)),
    })
}

/// Whether a channel moves the whole figure from place to place: a position of a joint below nothing that turns.
pub(super) fn places_root(motion: &Motion, (joint, kind): (Option<usize>, Kind)) -> bool {
    let firsts = motion.rig.first_channels();
    let stands = |values: &[f64]| values.iter().all(|value| *value == values[0]);
    let turns = |above: usize| {
        let kinds = motion.rig.joints[above].kinds.iter().enumerate();
        kinds.into_iter().any(|(slot, kind)| !kind.is_position() && !stands(&motion.values[firsts[above] + slot]))
    };
    kind.is_position() && joint.is_some_and(|joint| !(0..joint).any(turns))
}

/// Degrees by which another triple of angles has to be nearer than the plain one.
const SHORTER_DEG: f64 = 1e-3;

/// What takes each channel's last value to the first one's pose: angles to the nearest that turn alike.
fn differences(motion: &Motion) -> Vec<f64> {
    let last = motion.frames - 1;
    let kinds = motion.rig.channel_kinds();
    let plain = |(values, (_, kind)): (&Vec<f64>, &(Option<usize>, Kind))| {
        let way = values[0] - values[last];
        if kind.is_rotation() { euler::nearest(way, 0.0) } else { way }
    };
    let mut steps: Vec<f64> = motion.values.iter().zip(&kinds).map(plain).collect();
    for (joint, first) in motion.rig.joints.iter().zip(motion.rig.first_channels()) {
        let slots: Vec<usize> = (0..joint.kinds.len()).filter(|&slot| joint.kinds[slot].is_rotation()).collect();
        let axes: Vec<usize> = slots.iter().filter_map(|&slot| joint.kinds[slot].axis()).collect();
        if axes.len() == 3 && axes.iter().fold(0, |seen, axis| seen | 1 << axis) == 7 {
            let turn = local(joint, |slot| motion.values[first + slot][0]).0;
            let before = std::array::from_fn(|n| motion.values[first + slots[n]][last]);
            let near = euler::near(&turn, [axes[0], axes[1], axes[2]], before);
            let way: [f64; 3] = std::array::from_fn(|n| near[n] - before[n]);
            // Angles that turn alike another way come out of a matrix, which blurs them: the plain way is exact.
            let own: f64 = slots.iter().map(|slot| steps[first + slot].abs()).sum();
            if way.iter().map(|way| way.abs()).sum::<f64>() < own - SHORTER_DEG {
                (0..3).for_each(|n| steps[first + slots[n]] = way[n]);
            }
        }
        // A quaternion turns like its opposite: to the nearer one.
        let ends = |slot: usize| [0, last].map(|frame| motion.values[first + slot][frame]);
        let parts = (0..joint.kinds.len()).filter(|&slot| joint.kinds[slot].is_quaternion());
        let parts: Vec<usize> = parts.collect();
        let along: f64 = parts.iter().map(|&slot| ends(slot)[0] * ends(slot)[1]).sum();
        for slot in parts.into_iter().filter(|_| along < 0.0) {
            let [from, to] = ends(slot);
            steps[first + slot] = -from - to;
        }
    }
    steps
}

/// How far two poses are from each other: the greatest distance of a bounded joint, that joint, and the greatest rotations.
#[derive(Clone, Copy, Default)]
struct Gap {
    cm: f64,
    joint: usize,
    degrees: f64,
    joint_degrees: f64,
}

impl Gap {
    fn between(motion: &Motion, a: &FramePose, b: &FramePose, shell_cm: f64) -> Gap {
        let mut gap = Gap::default();
        let joints = motion.rig.joints.iter().zip(bounded(&motion.rig)).enumerate();
        for (index, (joint, _)) in joints.filter(|(_, (_, bounded))| *bounded) {
            let shell_cm = if joint.end_site { 0.0 } else { shell_cm };
            let cm = shell_distance_cm(&a.worlds[index], &b.worlds[index], shell_cm);
            gap = gap.or(Gap {
                cm,
                joint: index,
                degrees: angle_deg(&a.worlds[index].0, &b.worlds[index].0),
                joint_degrees: angle_deg(&a.turns[index], &b.turns[index]),
            });
        }
        gap
    }

    /// The greater of both in each measure.
    fn or(self, other: Gap) -> Gap {
        let far = if other.cm > self.cm { other } else { self };
        let (degrees, joint_degrees) = (self.degrees.max(other.degrees), self.joint_degrees.max(other.joint_degrees));
        Gap { degrees, joint_degrees, ..far }
    }

    fn name(&self, motion: &Motion) -> String {
        if motion.rig.joints.is_empty() { String::new() } else { motion.rig.joint_name(self.joint) }
    }
}

impl Most<'_> {
    /// The distance in cm of the shell's points from their joint; 0 if places alone are measured.
    fn shell_cm(self) -> f64 {
        match self {
            Most::Distance(bound, _) => bound.shell_cm().unwrap_or(0.0),
            Most::Channels(_) => 0.0,
        }
    }
}

/// How far the last frame's pose is from the first one's, but for the ways.
fn seam(motion: &Motion, ways: &[usize], shell_cm: f64) -> Gap {
    let mut ends: Vec<Vec<f64>> = motion.values.iter().map(|values| vec![values[0], values[motion.frames - 1]]).collect();
    ways.iter().for_each(|&channel| ends[channel][1] = ends[channel][0]);
    let [first, last] = [0, 1].map(|frame| frame_pose(&motion.rig, &ends, frame));
    Gap::between(motion, &first, &last, shell_cm)
}

fn greatest(distances: impl Iterator<Item = f64>) -> (f64, usize) {
    let indexed = distances.enumerate().map(|(index, distance)| (distance, index));
    indexed.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
}

fn check(motion: &Motion, steps: &[f64], ways: &[usize], most: Most) -> Result<()> {
    let rig = &motion.rig;
    let limits: Vec<(usize, f64)> = match most {
        Most::Channels(bounds) => bounds.greatest.iter().copied().enumerate().collect(),
        Most::Distance(bound, part) => {
            let gap = seam(motion, ways, most.shell_cm());
            let cm = bound.max_cm;
            if gap.cm > cm {
                let (name, gap) = (gap.name(motion), gap.cm);
                let text =
                    format!("{name} is {gap:.3} cm off in the last frame from where it is in the first; the bound is {cm} cm");
                return Err(open(text).remedy(Remedy::ChooseFrames).into());
            }
            for (degrees, most, whose) in [
                (gap.degrees, bound.max_rotation_deg, "in the world"),
                (gap.joint_degrees, bound.max_joint_deg, "against its parent"),
            ] {
                let most = most.unwrap_or(f64::INFINITY);
                let text = || {
                    format!(
                        "a joint turns by {degrees:.3} degrees {whose} from the last frame to the first; the bound is {most} degrees"
                    )
                };
                require!(degrees <= most, open(text()).remedy(Remedy::ChooseFrames));
            }
            rig.scalars
                .iter()
                .enumerate()
                .map(|(index, scalar)| (rig.joint_channels() + index, part * scalar.full_scale))
                .collect()
        }
    };
    for (channel, limit) in limits {
        let (name, gap) = (rig.channel_name(channel), steps[channel].abs());
        let text = || format!("{name} differs by {gap:.4} in the last frame from the first; the bound is {limit:.4}");
        require!(gap <= limit, open(text()).remedy(Remedy::ChooseFrames));
    }
    Ok(())
}

/// How far the farthest joint was moved in any frame.
fn farthest(from: &Motion, to: &Motion, shell_cm: f64) -> Gap {
    let at = |frame: usize| {
        let [a, b] = [from, to].map(|motion| frame_pose(&motion.rig, &motion.values, frame));
        Gap::between(from, &a, &b, shell_cm)
    };
    (0..from.frames).map(at).fold(Gap::default(), Gap::or)
}
