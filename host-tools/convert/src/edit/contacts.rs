//! When which point of a foot is on the ground: what a character's feet are held by.

use super::footsteps::{FootPoint, NO_FOOT, down, foot, goes_over, ground, tracks};
use super::sides::{Part, Side, parts};
use crate::error::{Error, Setting, require};
use crate::fk::all_positions;
use crate::memory::Memory;
use crate::motion::{Motion, Rig};
use anyhow::Result;
use pantin::{LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};

/// A foot of a rig.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Foot {
    /// The side of the body.
    pub side: Side,
    /// Its ankle: the joint below the shin.
    pub ankle: usize,
    /// What hangs on the ankle and can be on the ground, parents first: [`POINTS`] joints and End Sites at most.
    pub points: Vec<usize>,
}

/// Points of a foot beside its ankle.
pub const POINTS: usize = 4;

/// A stretch of frames in which one point of a foot is on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// 0 is the ankle, others are the foot's points from 1.
    pub point: usize,
    /// Its first frame.
    pub from: usize,
    /// The frame after its last one.
    pub to: usize,
}

/// Horizontal cm a second above which the ground moves in a clip that treads on the spot: no foot stands still in the world.
const TREADMILL: f64 = 15.0;
/// Seconds by which a footstep's event may be away from where a foot is found to come down.
const NEAR: f64 = 0.12;
/// What it costs to stand on another point of the foot, in cm of slide.
const HANDOVER_CM: f64 = 0.4;

/// The feet of a rig: by the names of their ankles, or where none are given by the usual names.
pub fn feet(rig: &Rig, named: [Option<&str>; 2]) -> Result<Vec<Foot>> {
    let names: Vec<String> = rig.joints.iter().map(|joint| joint.name.clone()).collect();
    let parts = parts(&names);
    let mut feet = Vec::new();
    for (side, named) in [Side::Left, Side::Right].into_iter().zip(named) {
        let found = match named {
            Some(name) => {
                let found = names.iter().position(|other| other == name);
                let missing = || Error::setting(Setting::Footsteps, format!("the rig has no joint `{name}`"));
                Some(found.ok_or_else(missing)?)
            }
            None => foot(&parts, side).map(|joint| ankle(rig, &parts, joint)),
        };
        feet.extend(found.map(|ankle| Foot { side, ankle, points: points(rig, ankle) }));
    }
    require!(!feet.is_empty(), Error::setting(Setting::Footsteps, NO_FOOT));
    Ok(feet)
}

/// A foot that hangs on a joint called ankle moves with it.
fn ankle(rig: &Rig, parts: &[Part], joint: usize) -> usize {
    rig.joints[joint].parent.filter(|&above| parts[above].rest.contains("ankle")).unwrap_or(joint)
}

fn points(rig: &Rig, ankle: usize) -> Vec<usize> {
    let mut points: Vec<usize> = Vec::new();
    for (index, joint) in rig.joints.iter().enumerate().filter(|(_, joint)| !joint.helper) {
        let hangs = joint.parent.is_some_and(|parent| parent == ankle || points.contains(&parent));
        if hangs && points.len() < POINTS {
            points.push(index);
        }
    }
    points
}

/// The contacts of each foot of a motion in the order of their frames; `None` for a motion that treads on the spot.
///
/// A foot comes down at the motion's events of footsteps, where one is near. Of the points of the foot that are low the one is taken that slides least.
pub fn contacts(motion: &Motion, feet: &[Foot], memory: Memory) -> Result<Option<Vec<Vec<Contact>>>> {
    let poses = all_positions(&motion.rig, &motion.values, motion.frames, memory)?;
    let tracks: Vec<Vec<FootPoint>> = feet.iter().map(|foot| tracks(motion, &poses, foot.ankle)).collect();
    let ground = ground(&tracks);
    let up = motion.rig.up.axis();
    if !goes_over(ground[(up + 1) % 3].hypot(ground[(up + 2) % 3]), &poses, motion, TREADMILL) {
        return Ok(None);
    }
    let of = |(foot, points): (&Foot, &Vec<FootPoint>)| {
        let mut planted = down(motion, points, ground);
        follow_events(motion, foot.side, &mut planted);
        let joints = std::iter::once(foot.ankle).chain(foot.points.iter().copied());
        let own: Vec<&FootPoint> = joints.filter_map(|joint| points.iter().find(|point| point.joint == joint)).collect();
        let mut contacts = Vec::new();
        for run in runs(&planted) {
            stand(motion, &own, run, &mut contacts);
        }
        contacts
    };
    Ok(Some(feet.iter().zip(&tracks).map(of).collect()))
}

/// Lets the foot come down at its events.
fn follow_events(motion: &Motion, side: Side, planted: &mut [bool]) {
    let name = if side == Side::Left { LEFT_FOOT_DOWN } else { RIGHT_FOOT_DOWN };
    let near = (NEAR / motion.frame_time).round() as usize;
    let frames = planted.len();
    for event in motion.events.iter().filter(|event| event.name == name) {
        let around = event.frame.saturating_sub(near)..=(event.frame + near).min(frames - 1);
        let starts = |frame: usize| frame > 0 && planted[frame] && !planted[frame - 1];
        if let Some(start) = around.filter(|&frame| starts(frame)).min_by_key(|frame| frame.abs_diff(event.frame)) {
            let (from, to) = (start.min(event.frame), start.max(event.frame));
            planted[from..to].iter_mut().for_each(|down| *down = event.frame < start);
        }
    }
}

/// Runs of frames that are true.
fn runs(planted: &[bool]) -> Vec<std::ops::Range<usize>> {
    let mut runs: Vec<std::ops::Range<usize>> = Vec::new();
    for frame in (0..planted.len()).filter(|&frame| planted[frame]) {
        match runs.last_mut().filter(|run| run.end == frame) {
            Some(run) => run.end += 1,
            None => runs.push(frame..frame + 1),
        }
    }
    runs
}

/// The points on which a foot stands in a run of frames: those that slide least together, with the cost of each change.
fn stand(motion: &Motion, points: &[&FootPoint], run: std::ops::Range<usize>, contacts: &mut Vec<Contact>) {
    let up = motion.rig.up.axis();
    let slide = |point: &FootPoint, frame: usize| {
        let velocity = point.velocity[frame];
        let flat = velocity[(up + 1) % 3].hypot(velocity[(up + 2) % 3]) * motion.frame_time;
        // A point that is high is none on which it stands.
        flat + if point.height[frame] < point.low { 0.0 } else { 1e3 }
    };
    // The least cost up to each frame on each point, and the point before.
    let mut costs: Vec<f64> = vec![0.0; points.len()];
    let mut before: Vec<Vec<usize>> = Vec::new();
    for frame in run.clone() {
        let least = (0..points.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0);
        let from: Vec<usize> =
            (0..points.len()).map(|point| if costs[point] <= costs[least] + HANDOVER_CM { point } else { least }).collect();
        let changed = |point: usize| if from[point] == point { 0.0 } else { HANDOVER_CM };
        costs = (0..points.len()).map(|point| costs[from[point]] + changed(point) + slide(points[point], frame)).collect();
        before.push(from);
    }
    let mut point = (0..points.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0);
    let mut stood: Vec<usize> = Vec::new();
    for from in before.iter().rev() {
        stood.push(point);
        point = from[point];
    }
    let mut last = usize::MAX;
    for (frame, point) in run.zip(stood.into_iter().rev()) {
        match contacts.last_mut().filter(|contact| point == last && contact.to == frame) {
            Some(contact) => contact.to = frame + 1,
            None => contacts.push(Contact { point, from: frame, to: frame + 1 }),
        }
        last = point;
    }
}
