//! When a transition looks right: pairs of frames of two clips that are alike in pose, speed and feet.

use anyhow::Result;
use pantin_animator::Transition;
use pantin_convert::Memory;
use pantin_convert::edit::contacts::{Contact, Foot};
use pantin_convert::fk::all_positions;
use pantin_convert::motion::Motion;

/// Seconds of velocity that count like a difference of places.
const FORESIGHT: f64 = 0.1;
/// What a foot costs that is on the ground in one clip alone, in cm.
const OTHER_FOOT_CM: f64 = 8.0;
/// What a cm costs by which the figure glides beside its way, and by which a foot steps to another place.
const GLIDE: f64 = 0.3;
const STEP: f64 = 0.2;
/// What a cm/s^2 costs by which the figure is accelerated more than this.
const ACCELERATION: f64 = 0.02;
const WITH_EASE: f64 = 1000.0;
/// What a cm costs by which the figure goes back on its way, and the speed below which it has none, in cm a second.
const BACK: f64 = 2.0;
const STANDS: f64 = 20.0;
/// What a cm costs by which a foot moves over the ground.
const DRAG: f64 = 2.0;
/// What a cm of a detour of a foot costs, in cm over the ground.
const DETOUR: f64 = 0.2;
/// The height below which it does, in cm.
const LOW_CM: f64 = 2.0;
/// The farthest that a foot is held beside its place in the new clip, in cm: one that is farther steps there, and is lifted by at most this.
const HELD_CM: f64 = 6.0;
const LIFT_CM: f64 = 9.0;
/// Seconds of a clip that is no loop in which a transition may enter it.
const FIRST: f64 = 0.2;
/// Frames of a clip that are compared at most.
const FRAMES: usize = 240;

/// What is compared of a clip.
pub(super) struct Clip {
    /// For each frame, each joint: horizontal places about their mean, the height, and the same of the velocity, in cm and cm a second.
    poses: Vec<Vec<[f64; 6]>>,
    /// The joint of each foot that is on the ground.
    feet: Vec<Vec<Option<usize>>>,
    /// The joints of each foot, and the least height of each joint of the figure.
    joints: Vec<Vec<usize>>,
    ground: Vec<f64>,
    frame_time: f64,
    looped: bool,
}

impl Clip {
    pub fn of(motion: &Motion, feet: &[Foot], contacts: &[Vec<Contact>]) -> Result<Clip> {
        let places = all_positions(&motion.rig, &motion.values, motion.frames, Memory::default())?;
        let up = motion.rig.up.axis();
        let upward = if motion.rig.up.is_negative() { -1.0 } else { 1.0 };
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
                [at(0) - mean[0], at(1) - mean[1], upward * at(2), v(0), v(1), upward * v(2)]
            };
            (0..places[frame].len()).map(joint).collect()
        };
        let stands = |frame: usize| {
            let joint = |(foot, own): (&Foot, &Vec<Contact>)| {
                let contact = own.iter().find(|contact| (contact.from..contact.to).contains(&frame))?;
                Some(contact.point.checked_sub(1).map_or(foot.ankle, |point| foot.points[point]))
            };
            feet.iter().zip(contacts).map(joint).collect()
        };
        let poses: Vec<Vec<[f64; 6]>> = (0..motion.frames).map(pose).collect();
        let least = |joint: usize| poses.iter().map(|pose| pose[joint][2]).fold(f64::INFINITY, f64::min);
        Ok(Clip {
            ground: (0..motion.rig.joints.len()).map(least).collect(),
            joints: feet.iter().map(|foot| std::iter::once(foot.ankle).chain(foot.points.iter().copied()).collect()).collect(),
            poses,
            feet: (0..motion.frames).map(stands).collect(),
            frame_time: motion.frame_time,
            looped: motion.looped,
        })
    }

    pub fn frames(&self) -> usize {
        self.poses.len()
    }

    /// In seconds.
    pub fn frame_time(&self) -> f64 {
        self.frame_time
    }
}

/// Two instants, the second of which follows the first.
struct Change<'a> {
    from: &'a Clip,
    to: &'a Clip,
    at: usize,
    start: usize,
    /// Frames that the transition takes.
    frames: usize,
    /// Cosine and sine of the turn about the vertical axis that brings the new pose to the old one.
    turn: [f64; 2],
    /// For each foot whether it is on the ground in both clips, and, if it is in one, how far it is in the old clip from where it is in the new one.
    grounded: Vec<(bool, Option<[f64; 2]>)>,
    /// The way to a foot that is on the ground in both clips: the figure comes there.
    way: Option<[f64; 2]>,
}

impl<'a> Change<'a> {
    fn new((from, at): (&'a Clip, usize), (to, start): (&'a Clip, usize), frames: usize) -> Change<'a> {
        let (mut along, mut across) = (0.0, 0.0);
        for (p, q) in from.poses[at].iter().zip(&to.poses[start]) {
            along += p[0] * q[0] + p[1] * q[1];
            across += q[0] * p[1] - q[1] * p[0];
        }
        let (sin, cos) = across.atan2(along).sin_cos();
        let mut change = Change { from, to, at, start, frames: frames.max(1), turn: [cos, sin], grounded: Vec::new(), way: None };
        let foot = |(old, new): (&Option<usize>, &Option<usize>)| {
            let way = |joint| {
                let [[x, y, _], _] = change.differs(joint);
                [x, y]
            };
            (old.is_some() && new.is_some(), new.or(*old).map(way))
        };
        let grounded: Vec<_> = from.feet[at].iter().zip(&to.feet[start]).map(foot).collect();
        let both = grounded.iter().filter_map(|&(both, way)| way.filter(|_| both));
        change.way = both.min_by(|a, b| far(*a).total_cmp(&far(*b)));
        change.grounded = grounded;
        change
    }

    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.turn;
        [x * cos - y * sin, x * sin + y * cos]
    }

    /// The figure's horizontal velocity before and after, in cm a second, at the speeds at which the clips play.
    fn velocities(&self, [from, to]: [f64; 2]) -> [[f64; 2]; 2] {
        let mean = |pose: &[[f64; 6]], axis: usize| pose.iter().map(|joint| joint[axis]).sum::<f64>() / pose.len().max(1) as f64;
        let (old, new) = (&self.from.poses[self.at], &self.to.poses[self.start]);
        [[3, 4].map(|axis| from * mean(old, axis)), self.turned([3, 4].map(|axis| to * mean(new, axis)))]
    }

    /// What the velocity changes by.
    fn velocity_change(&self, speeds: [f64; 2]) -> [f64; 2] {
        let [[x, y], [u, v]] = self.velocities(speeds);
        [u - x, v - y]
    }

    fn seconds(&self) -> f64 {
        self.frames as f64 * self.to.frame_time
    }

    /// Where the figure comes beside its new way, in cm: to a foot that is on the ground in both clips, or to where its velocity takes it as it dies out.
    fn arrives(&self, speeds: [f64; 2]) -> [f64; 2] {
        self.way.unwrap_or_else(|| self.coast(speeds))
    }

    /// A velocity that dies out takes the figure a third of the way that it would go.
    fn coast(&self, speeds: [f64; 2]) -> [f64; 2] {
        self.velocity_change(speeds).map(|change| -change * self.seconds() / 3.0)
    }

    /// What the figure glides beside that, in cm.
    fn glide(&self, speeds: [f64; 2]) -> [f64; 2] {
        let ([x, y], [a, b]) = (self.arrives(speeds), self.coast(speeds));
        [x - a, y - b]
    }

    /// The greatest acceleration of the figure in cm/s^2: where it begins, by its change of velocity and by its glide, or where it ends, by the glide.
    fn acceleration(&self, speeds: [f64; 2]) -> f64 {
        let seconds = self.seconds();
        let [glide, change] = [self.glide(speeds), self.velocity_change(speeds)];
        let at = |axis: usize| [6.0 * glide[axis] / seconds.powi(2), 2.0 * change[axis] / seconds];
        let ([a, b], [x, y]) = (at(0), at(1));
        (a + b).hypot(x + y).max(a.hypot(x))
    }

    /// How far the figure goes back, against its velocity before or after, whichever is greater, in cm.
    fn back(&self, speeds: [f64; 2]) -> f64 {
        let ([before, after], glide, seconds) = (self.velocities(speeds), self.glide(speeds), self.seconds());
        let ahead = if far(after) > far(before) { after } else { before };
        let back = |frame: usize| {
            let left = 1.0 - (frame as f64 - 0.5) / self.frames as f64;
            let step = |axis: usize| {
                let velocity = after[axis] + (before[axis] - after[axis]) * left * left;
                velocity * seconds + 6.0 * glide[axis] * left * (1.0 - left)
            };
            -(step(0) * ahead[0] + step(1) * ahead[1]) / far(ahead) / self.frames as f64
        };
        if far(ahead) < STANDS { 0.0 } else { (1..=self.frames).map(|frame| back(frame).max(0.0)).sum() }
    }

    /// By how much a joint's place and velocity differ in the old clip from those in the new one.
    fn differs(&self, joint: usize) -> [[f64; 3]; 2] {
        let (p, q) = (self.from.poses[self.at][joint], self.to.poses[self.start][joint]);
        let ([x, y], [u, v]) = (self.turned([q[0], q[1]]), self.turned([q[3], q[4]]));
        [[p[0] - x, p[1] - y, p[2] - q[2]], [p[3] - u, p[4] - v, p[5] - q[5]]]
    }

    /// How different the instants are, in cm: the mean over the joints, and what the feet cost.
    fn cost(&self, speeds: [f64; 2]) -> f64 {
        let size = |[x, y, z]: [f64; 3]| x.hypot(y).hypot(z);
        let joints = self.from.poses[self.at].len();
        let hasty = (self.acceleration(speeds) - WITH_EASE).max(0.0);
        let apart = |joint: usize| {
            let [place, velocity] = self.differs(joint);
            size(place) + FORESIGHT * size(velocity)
        };
        let poses = (0..joints).map(apart).sum::<f64>() / joints.max(1) as f64;
        poses + self.feet(speeds) + ACCELERATION * hasty + BACK * self.back(speeds)
    }

    /// What feet cost: those that are on the ground in one clip alone or elsewhere, and those that move over the ground.
    fn feet(&self, speeds: [f64; 2]) -> f64 {
        let (glide, [a, b]) = (self.glide(speeds), self.arrives(speeds));
        let mut cost = GLIDE * far(glide);
        for (foot, &(both, way)) in self.grounded.iter().enumerate() {
            let rest = way.map_or(0.0, |[x, y]| far([x - a, y - b]));
            let held = both && rest < HELD_CM;
            cost += STEP * rest + if way.is_none() || held { 0.0 } else { OTHER_FOOT_CM };
            let lift = if way.is_none() || held { 0.0 } else { (rest / 4.0).min(LIFT_CM) };
            cost += DRAG * self.drag(foot, glide, held, lift);
        }
        cost
    }

    /// How far a foot moves over the ground, in cm, while the transition lasts: a foot that rolls about one joint does not. With it a part of its detour.
    fn drag(&self, foot: usize, glide: [f64; 2], held: bool, lift: f64) -> f64 {
        let (count, step) = (self.to.poses.len(), self.to.frame_time);
        let joints: Vec<(usize, [[f64; 3]; 2])> =
            self.to.joints[foot].iter().map(|&joint| (joint, self.differs(joint))).collect();
        // What is left of a difference in place and in velocity, of a cm and of a cm a second.
        let swing = self.frames.min((Transition::SWING.as_secs_f64() / step).ceil() as usize).max(1);
        let left = |frame: usize| {
            let part = |frames: usize| (frame as f64 / frames as f64).min(1.0);
            let (whole, short) = (part(self.frames), part(swing));
            let rest = |part: f64| (1.0 - part) * (1.0 - part);
            [rest(whole) * (1.0 + 2.0 * whole), rest(short) * short * swing as f64 * step]
        };
        // The velocity of the figure dies out in all of the time.
        let [p, q] = self.velocity_change([1.0, 1.0]).map(|x| -x);
        let (mut total, mut path, mut net) = (0.0, 0.0, [0.0; 2]);
        let mut is_held = held;
        for frame in 1..=self.frames {
            let at = if self.to.looped { (self.start + frame) % count } else { (self.start + frame).min(count - 1) };
            is_held &= self.to.feet[at][foot].is_some();
            if is_held {
                continue;
            }
            let ([place, velocity], [place_before, velocity_before]) = (left(frame), left(frame - 1));
            let part = frame as f64 / self.frames as f64;
            let (mut least, mut lowest, mut own_way) = (f64::INFINITY, f64::INFINITY, None);
            let coast = step * (1.0 - part) * (1.0 - part);
            for (joint, [[x, y, z], [u, v, w]]) in &joints {
                let pose = self.to.poses[at][*joint];
                let way = self.turned([pose[3] * step, pose[4] * step]);
                let moved = |own: f64, glide: f64, speed: f64, figure: f64| {
                    (own - glide) * (place - place_before) + (speed - figure) * (velocity - velocity_before) + figure * coast
                };
                let way = [way[0] + moved(*x, glide[0], *u, p), way[1] + moved(*y, glide[1], *v, q)];
                least = least.min(far(way));
                own_way.get_or_insert(way);
                lowest = lowest.min(pose[2] + z * place + w * velocity - self.to.ground[*joint]);
            }
            if lowest + 4.0 * part * (1.0 - part) * lift < LOW_CM {
                total += least;
            }
            let [x, y] = own_way.unwrap_or_default();
            (path, net) = (path + x.hypot(y), [net[0] + x, net[1] + y]);
        }
        total + DETOUR * (path - far(net))
    }
}

fn far([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// Pairs of a frame of the old clip and the frame of the new one that follows it: whenever a transition is asked for, the best pair within a time is
/// among them. `start` is the only frame of the new clip, if one is given; a transition takes `length` frames of it. The clips play at these speeds.
pub(super) fn best(
    from: &Clip,
    to: &Clip,
    start: Option<usize>,
    within: f64,
    length: usize,
    speeds: [f64; 2],
) -> Vec<(usize, usize)> {
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
            let costs = starts.iter().map(|&start| (start, Change::new((from, at), (to, start), length).cost(speeds)));
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

/// The least of the greatest accelerations of the figure in a transition of `length` frames at one of these pairs of frames, in cm/s^2, and by how much its
/// velocity changes then, in cm a second, and its place so that feet stay where they are, in cm.
pub(super) fn acceleration(from: &Clip, to: &Clip, pairs: &[(usize, usize)], length: usize, speeds: [f64; 2]) -> [f64; 3] {
    let changes = pairs.iter().map(|&(at, start)| {
        let change = Change::new((from, at), (to, start), length);
        [change.acceleration(speeds), far(change.velocity_change(speeds)), far(change.glide(speeds))]
    });
    changes.min_by(|a, b| a[0].total_cmp(&b[0])).unwrap_or_default()
}
