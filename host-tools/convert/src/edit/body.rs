//! A motion on the rig of another figure, so that motions of any sources end in one bank.
//!
//! Fifteen joints of both figures are known by their usual names: hips, chest, head, and upper arm, forearm, hand, thigh, shin, foot of both sides. Each turns
//! as the source's joint has turned since its rest pose, from a rest pose that aims the limbs where the source's point. So limbs keep their directions
//! in the world, whatever the proportions. Joints of one name in both figures (fingers, toes, collars, necks) turn alike; the spine's
//! share the turn from hips to chest; all others are carried by their parents.
//!
//! A source whose rest pose faces another way than the body's is turned by quarters of a turn, so that figures which were built facing different ways face one way.
//!
//! The length of the legs scales the way, and the hips' height over the ankles. Near the ground, two-bone inverse kinematics puts an ankle where the source's is
//! from its thigh, in that scale, and to a height that is off by at most 0.7 cm over the ground on which the body stands in its own file. In the air a leg points where
//! the source's does. Within 0.7 cm nothing is corrected, because a leg that is nearly straight would have to bend far for it.

use super::display::{Pose, add, aim, cross, dot, norm, pose, stands, subtract, transposed};
use super::display_names::{sources, sources_of_body};
use super::facing::facing;
use super::rotation::{between, turns_freely, up, write};
use super::sides::parts;
use crate::error::{Error, Setting, require};
use crate::fk::{IDENTITY, Matrix, about, apply, frame_pose, from_exponential, product};
use crate::motion::{Joint, Motion, Rig};
use anyhow::{Context, Result};
use std::f64::consts::PI;

/// Indices of the fifteen.
const HIPS: usize = 0;
const CHEST: usize = 1;
const HEAD: usize = 2;
/// Upper arm, forearm, hand.
const ARMS: [[usize; 3]; 2] = [[3, 4, 5], [6, 7, 8]];
/// Thigh, shin, foot.
const LEGS: [[usize; 3]; 2] = [[9, 10, 11], [12, 13, 14]];

/// A motion on another body.
#[derive(Clone, Debug)]
pub struct Embodied {
    /// The motion; the source's scalars go on.
    pub motion: Motion,
    /// The greatest angle in degrees between the direction of a bone of an arm and the source's.
    pub arms_deg: f64,
    /// The same for legs in the air.
    pub legs_deg: f64,
    /// The greatest difference in cm between the heights of an ankle near the ground and of the source's, in the scale of the body.
    pub ankles_cm: f64,
    /// Degrees to the left by which the motion was turned because the source's rest pose faces another way than the body's: -90, 0, 90 or 180.
    pub turned_deg: i32,
    /// Degrees to the left by which the figure faces another way in the mean of all frames than the body at rest. `None` if it turns to all sides.
    pub facing_deg: Option<f64>,
    /// Degrees by which one foot of the body points higher than the other in its first frame, if it rests in that: a figure that does not stand with all
    /// turns at 0. The feet of all motions lean so far then.
    pub uneven_deg: f64,
    /// Those of the body's fifteen joints that cannot turn in all directions, by their names.
    pub limited: Vec<String>,
}

/// Heights in cm of an ankle over its least one below which a foot is near the ground, and above which it is in the air.
const GROUND_CM: f64 = 5.0;
const AIR_CM: f64 = 15.0;
/// How far in cm an ankle may be from the height of the source's before its leg bends for it.
const FREE_CM: f64 = 0.7;

/// One of the two figures.
struct Figure {
    /// The joint that each of the 15 stands for.
    joints: [usize; 15],
    /// Its rest pose.
    rest: Pose,
    /// Whether the rest pose is one with all turns at 0, in which a figure stands upright.
    upright: bool,
    /// Length of a leg, from thigh to ankle.
    leg: f64,
    /// From the ankles to the toes at rest, or to the ends of the feet.
    feet: [Option<[f64; 3]>; 2],
}

/// How many degrees higher one foot may point than the other in a frame in which a figure stands.
pub const UNEVEN_DEG: f64 = 8.0;

impl Figure {
    fn new(motion: &Motion, joints: [usize; 15], to_up: &Matrix) -> Result<Figure> {
        let zero = pose(motion, None);
        let upright = stands(&zero, &joints);
        let rest = if upright { zero } else { pose(motion, Some(0)) };
        let rest = rotated(rest, to_up);
        let length = |[thigh, shin, foot]: [usize; 3]| {
            let at = |role: usize| rest[joints[role]].1;
            norm(subtract(at(shin), at(thigh))) + norm(subtract(at(foot), at(shin)))
        };
        let leg = LEGS.iter().map(|&leg| length(leg)).sum::<f64>() / 2.0;
        require!(leg > 0.0, Error::setting(Setting::Body, "the figure's legs have no length"));
        let feet = LEGS.map(|leg| {
            let foot = joints[leg[2]];
            let toes = motion.rig.joints.iter().position(|joint| joint.parent == Some(foot))?;
            Some(subtract(rest[toes].1, rest[foot].1))
        });
        Ok(Figure { joints, rest, upright, leg, feet })
    }

    /// By how many degrees one foot points higher than the other, if the figure rests in its first frame.
    fn uneven_deg(&self, vertical: [f64; 3]) -> f64 {
        match self.feet.map(|way| Some(dot(unit(way?), vertical).clamp(-1.0, 1.0).asin().to_degrees())) {
            [Some(left), Some(right)] if !self.upright => (left - right).abs(),
            _ => 0.0,
        }
    }

    fn place(&self, role: usize) -> [f64; 3] {
        self.rest[self.joints[role]].1
    }

    /// From a joint of the 15 to another at rest.
    fn bone(&self, from: usize, to: usize) -> [f64; 3] {
        subtract(self.place(to), self.place(from))
    }

    /// From right to left.
    fn lateral(&self) -> [f64; 3] {
        let across = |left: usize, right: usize| subtract(self.place(left), self.place(right));
        add(across(LEGS[0][0], LEGS[1][0]), across(ARMS[0][0], ARMS[1][0]))
    }
}

/// How a joint of the body turns.
#[derive(Clone, Copy)]
enum Turn {
    /// As the source's joint does from its rest, after a turn that takes the body's rest to the source's.
    Follows { source: usize, from: Matrix },
    /// A part of the way from one joint of the body to another.
    Shares { above: usize, below: usize, part: f64 },
    /// With its parent.
    Carried,
    /// Not at all: it is above the hips.
    Stands,
}

/// The two figures, and what leads from one to the other.
struct Plan<'a> {
    source: Figure,
    body: Figure,
    rig: &'a Rig,
    turns: Vec<Turn>,
    to_up: Matrix,
    /// The body's size over the source's.
    scale: f64,
    vertical: [f64; 3],
    /// The least height of the source's ankles over all frames, and the height of the body's over its ground.
    ankles: [f64; 2],
    /// Quarters of a turn to the left that the motion is turned by, because the source's rest pose faces another way than the body's.
    quarters: i32,
    /// Whether they are one figure.
    same: bool,
}

/// Puts `motion` on the rig of `body`. `map` is the text of a map file for the source's names, or nothing. Errors name the joints that were not found.
pub fn onto(motion: &Motion, body: &Motion, map: &str) -> Result<Embodied> {
    let plan = Plan::new(motion, body, map)?;
    let rig = Rig { scalars: motion.rig.scalars.clone(), ..body.rig.clone() };
    let channels = rig.joint_channels();
    let mut values: Vec<Vec<f64>> = vec![vec![0.0; motion.frames]; channels];
    let firsts = rig.first_channels();
    let mut out = Embodied {
        motion: motion.clone(),
        arms_deg: 0.0,
        legs_deg: 0.0,
        ankles_cm: 0.0,
        turned_deg: 90 * plan.quarters,
        facing_deg: None,
        uneven_deg: plan.body.uneven_deg(plan.vertical),
        limited: plan.limited(),
    };
    for frame in 0..motion.frames {
        let source = rotated(pose(motion, Some(frame)), &plan.to_up);
        let (turns, hips) = plan.pose(&source);
        plan.write(&turns, hips, frame, &firsts, &mut values);
        plan.measure(&source, &frame_pose(&rig, &values, frame).worlds, &mut out);
    }
    values.extend_from_slice(&motion.values[motion.rig.joint_channels()..]);
    let mut keys = vec![None; channels];
    keys.extend_from_slice(&motion.keys[motion.rig.joint_channels()..]);
    out.motion = Motion { rig, values, keys, events: motion.events.clone(), ..*motion };
    out.facing_deg = facing(&out.motion).map(|ahead| plan.left_of_rest(ahead));
    out.motion.origin.error_cm *= plan.scale * body.rig.cm_per_unit / motion.rig.cm_per_unit;
    Ok(out)
}

impl<'a> Plan<'a> {
    fn new(motion: &Motion, body: &'a Motion, map: &str) -> Result<Plan<'a>> {
        let vertical = up(&body.rig);
        let to_up = turn_between(up(&motion.rig), vertical);
        let of_source = |error: anyhow::Error| match Error::of(&error, Error::source) {
            Error::Setting(Setting::Retarget, problem) => Error::Setting(Setting::Body, problem),
            other => other,
        };
        let joints = sources(&motion.rig, map).map_err(of_source)?;
        let mut source = Figure::new(motion, joints, &to_up)?;
        let figure = Figure::new(body, sources_of_body(&body.rig)?, &IDENTITY).context("the body")?;
        hangs_together(&body.rig, &figure.joints)?;
        let quarters = quarters(&source, &figure, vertical);
        let to_up = product(&about_vertical_by(vertical, f64::from(quarters) * PI / 2.0), &to_up);
        if quarters != 0 {
            source = Figure::new(motion, joints, &to_up)?;
        }
        let least = least_ankle(motion, &source, &to_up, vertical);
        let same = quarters == 0 && is_same(&motion.rig, &body.rig);
        let ankles = [least, if same { least } else { stands_at(body, &figure, vertical) }];
        let mut plan = Plan {
            scale: figure.leg / source.leg,
            turns: Vec::new(),
            rig: &body.rig,
            source,
            body: figure,
            to_up,
            vertical,
            ankles,
            quarters,
            same,
        };
        plan.turns = plan.turns(&motion.rig);
        Ok(plan)
    }

    /// Degrees by which a horizontal direction is to the left of where the body faces at rest.
    fn left_of_rest(&self, ahead: [f64; 3]) -> f64 {
        angle_about(self.vertical, cross(self.body.lateral(), self.vertical), ahead).to_degrees()
    }

    /// Those of the fifteen joints that cannot turn in all directions.
    fn limited(&self) -> Vec<String> {
        let joints = self.body.joints.iter().map(|&joint| &self.rig.joints[joint]);
        joints.filter(|joint| !turns_freely(joint)).map(|joint| joint.name.clone()).collect()
    }

    /// How each of the body's joints turns.
    fn turns(&self, source: &Rig) -> Vec<Turn> {
        let from = self.rest_turns();
        let names = |rig: &Rig| parts(&rig.joints.iter().map(|joint| joint.name.clone()).collect::<Vec<_>>());
        let (own, other) = (names(self.rig), names(source));
        let alike = |joint: usize| {
            let same = |index: &usize| other[*index].side == own[joint].side && other[*index].rest == own[joint].rest;
            let mut found = (0..other.len()).filter(|index| !source.joints[*index].end_site).filter(same);
            found.next().filter(|index| found.next().is_none() && !self.source.joints.contains(index))
        };
        // What one figure does it does on itself, whatever it rests in.
        let follows = |index: usize, source: usize, from: Matrix| {
            let itself = || product(&self.source.rest[source].0, &transposed(&self.body.rest[index].0));
            Turn::Follows { source, from: if self.same { itself() } else { from } }
        };
        let mut role_above = vec![None; self.rig.joints.len()];
        let mut turns = Vec::with_capacity(self.rig.joints.len());
        for (index, joint) in self.rig.joints.iter().enumerate() {
            let role = self.body.joints.iter().position(|&own| own == index);
            role_above[index] = role.or(joint.parent.and_then(|parent| role_above[parent]));
            turns.push(match (role, role_above[index]) {
                (Some(role), _) => follows(index, self.source.joints[role], from[role]),
                (None, None) => Turn::Stands,
                (None, Some(_)) if joint.end_site => Turn::Carried,
                (None, Some(above)) => match alike(index) {
                    Some(source) => follows(index, source, from[above]),
                    None => self.shared(index, above).unwrap_or(Turn::Carried),
                },
            });
        }
        turns
    }

    /// A joint of the spine or of the neck, between two of the 15.
    fn shared(&self, joint: usize, above: usize) -> Option<Turn> {
        let below = match above {
            HIPS => CHEST,
            CHEST => HEAD,
            _ => return None,
        };
        let chain: Vec<usize> = self.chain(self.body.joints[above], self.body.joints[below])?;
        let place = chain.iter().position(|&other| other == joint)? + 1;
        let part = place as f64 / (chain.len() + 1) as f64;
        Some(Turn::Shares { above: self.body.joints[above], below: self.body.joints[below], part })
    }

    /// The joints between two, of which one is above the other.
    fn chain(&self, above: usize, below: usize) -> Option<Vec<usize>> {
        let mut chain = Vec::new();
        let mut at = self.rig.joints[below].parent?;
        while at != above {
            chain.insert(0, at);
            at = self.rig.joints[at].parent?;
        }
        Some(chain)
    }

    /// For each of the 15, the turn from the body's rest pose to one in which its limbs point where the source's do at rest.
    fn rest_turns(&self) -> [Matrix; 15] {
        let (source, body) = (&self.source, &self.body);
        let facing = about_vertical(self.vertical, body.lateral(), source.lateral());
        let aimed = |start: &Matrix, from: usize, to: &[usize]| {
            let bones = |figure: &Figure| to.iter().map(|&to| unit(figure.bone(from, to))).collect::<Vec<_>>();
            aim(*start, &bones(body), &bones(source))
        };
        let mut turns = [facing; 15];
        if !(source.upright && body.upright) {
            turns[HIPS] = aimed(&facing, HIPS, &[CHEST, LEGS[0][0], LEGS[1][0]]);
            turns[CHEST] = aimed(&turns[HIPS], CHEST, &[HEAD, ARMS[0][0], ARMS[1][0]]);
            turns[HEAD] = turns[CHEST];
        }
        let flat = [source, body].iter().all(|figure| figure.uneven_deg(self.vertical) < UNEVEN_DEG);
        for [first, second, third] in ARMS.into_iter().chain(LEGS) {
            turns[first] = aimed(&turns[if first < LEGS[0][0] { CHEST } else { HIPS }], first, &[second]);
            turns[second] = aimed(&turns[first], second, &[third]);
            // A hand goes on as its forearm does. A foot of a figure that stands is flat, and points where it points.
            turns[third] = match LEGS.iter().position(|leg| leg[2] == third) {
                Some(_) if source.upright && body.upright => facing,
                Some(side) if flat => match (body.feet[side], source.feet[side]) {
                    (Some(own), Some(other)) => about_vertical(self.vertical, own, other),
                    _ => turns[second],
                },
                _ => turns[second],
            };
        }
        turns
    }

    /// The turns of the body's joints since its rest, and where the hips are.
    fn pose(&self, source: &Pose) -> (Vec<Matrix>, [f64; 3]) {
        let mut turns = vec![IDENTITY; self.turns.len()];
        for (index, turn) in self.turns.iter().enumerate() {
            turns[index] = match *turn {
                Turn::Follows { source: joint, from } => {
                    product(&product(&source[joint].0, &transposed(&self.source.rest[joint].0)), &from)
                }
                Turn::Carried => self.rig.joints[index].parent.map_or(IDENTITY, |parent| turns[parent]),
                Turn::Shares { .. } | Turn::Stands => IDENTITY,
            };
        }
        // Those that share come after all that they lie between.
        for index in 0..turns.len() {
            if let Turn::Shares { above, below, part } = self.turns[index] {
                turns[index] = between(&turns[above], &turns[below], part);
            } else if let (Turn::Carried, Some(parent)) = (self.turns[index], self.rig.joints[index].parent) {
                turns[index] = turns[parent];
            }
        }
        let at = |role: usize| self.scaled(source[self.source.joints[role]].1);
        let thighs = LEGS.map(|leg| at(leg[0]));
        let middle = add(thighs[0], thighs[1]).map(|x| x / 2.0);
        let below = LEGS.map(|leg| self.reach(&turns, HIPS, leg[0])).into_iter().fold([0.0; 3], add).map(|x| x / 2.0);
        let hips = subtract(middle, below);
        for leg in &LEGS {
            let ankle = at(leg[2]);
            let weight = self.nearness(ankle);
            if weight > 0.0 {
                let thigh = add(hips, self.reach(&turns, HIPS, leg[0]));
                let free = add(thigh, self.reach(&turns, leg[0], leg[2]));
                let mut goal = add(thigh, subtract(ankle, at(leg[0])));
                let off = dot(subtract(ankle, goal), self.vertical);
                let most = FREE_CM / self.rig.cm_per_unit;
                goal = add(goal, self.vertical.map(|x| x * (off - off.clamp(-most, most))));
                let goal = add(free, subtract(goal, free).map(|x| x * weight));
                self.bend(leg, thigh, goal, &mut turns);
            }
        }
        (turns, hips)
    }

    /// How near the ground an ankle is, given where it is in the body's scale: 1 on it, 0 in the air.
    fn nearness(&self, ankle: [f64; 3]) -> f64 {
        let height = (dot(ankle, self.vertical) - self.ankles[1]) * self.rig.cm_per_unit;
        let part = ((AIR_CM - height) / (AIR_CM - GROUND_CM)).clamp(0.0, 1.0);
        part * part * (3.0 - 2.0 * part)
    }

    /// A place of the source in the body's scale, over the body's ground.
    fn scaled(&self, place: [f64; 3]) -> [f64; 3] {
        let height = dot(place, self.vertical);
        let lifted = self.ankles[1] + self.scale * (height - self.ankles[0]);
        let level = place.map(|x| x * self.scale);
        add(level, self.vertical.map(|x| x * (lifted - self.scale * height)))
    }

    /// From one of the 15 to another below it, as the joints between them are turned.
    fn reach(&self, turns: &[Matrix], from: usize, to: usize) -> [f64; 3] {
        let (mut at, end) = (self.body.joints[to], self.body.joints[from]);
        let mut reach = [0.0; 3];
        while at != end {
            let Some(parent) = self.rig.joints[at].parent else { break };
            reach = add(reach, apply(&turns[parent], subtract(self.body.rest[at].1, self.body.rest[parent].1)));
            at = parent;
        }
        reach
    }

    /// Bends a leg so that its ankle is at the goal, in the plane in which the source's knee bends.
    fn bend(&self, &[thigh, shin, foot]: &[usize; 3], hip: [f64; 3], goal: [f64; 3], turns: &mut [Matrix]) {
        let (upper, lower) = (self.body.bone(thigh, shin), self.body.bone(shin, foot));
        let (a, b) = (norm(upper), norm(lower));
        let line = subtract(goal, hip);
        let reach = norm(line).clamp((a - b).abs() + 1e-6 * (a + b), (1.0 - 1e-6) * (a + b));
        let along = unit(line);
        let knee = apply(&turns[self.body.joints[thigh]], upper);
        let sideways = subtract(knee, along.map(|x| x * dot(knee, along)));
        if norm(sideways) < 1e-6 * a || norm(line) < 1e-6 * a {
            return;
        }
        let cosine = (a * a + reach * reach - b * b) / (2.0 * a * reach);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let bent = add(along.map(|x| x * a * cosine), unit(sideways).map(|x| x * a * sine));
        let shank = subtract(along.map(|x| x * reach), bent);
        for (role, rest, goal) in [(thigh, upper, bent), (shin, lower, shank)] {
            let joint = self.body.joints[role];
            let before = turns[joint];
            turns[joint] = aim(before, &[unit(rest)], &[unit(goal)]);
            self.carry(joint, turns);
        }
    }

    /// Turns what a joint carries with it.
    fn carry(&self, joint: usize, turns: &mut [Matrix]) {
        for index in joint + 1..turns.len() {
            if let (Turn::Carried, Some(parent)) = (self.turns[index], self.rig.joints[index].parent) {
                turns[index] = turns[parent];
            }
        }
    }

    /// Writes a frame's channels. What a joint cannot turn or move is left to those that it carries.
    fn write(&self, turns: &[Matrix], hips: [f64; 3], frame: usize, firsts: &[usize], values: &mut [Vec<f64>]) {
        let mut world: Pose = Vec::with_capacity(turns.len());
        let carrier = self.body.joints[HIPS];
        for (index, joint) in self.rig.joints.iter().enumerate() {
            let (above, place) = joint.parent.map_or((IDENTITY, [0.0; 3]), |parent| world[parent]);
            let rest = joint.parent.map_or(self.body.rest[index].1, |parent| self.offset(index, parent));
            let first = firsts[index];
            let goal = self.place(index, carrier, hips).map(|goal| apply(&transposed(&above), subtract(goal, place)));
            for (slot, kind) in joint.kinds.iter().enumerate().filter(|(_, kind)| kind.is_position()) {
                let axis = kind.axis().unwrap_or(0);
                values[first + slot][frame] = goal.unwrap_or(rest)[axis];
            }
            let turned = product(&turns[index], &self.body.rest[index].0);
            write(joint, first, values, frame, &product(&transposed(&above), &turned));
            let (turn, offset) = crate::fk::local(joint, |slot| values[first + slot][frame]);
            world.push((product(&above, &turn), add(place, apply(&above, offset))));
        }
    }

    /// Where a joint stands in its parent at rest.
    fn offset(&self, joint: usize, parent: usize) -> [f64; 3] {
        let rest = &self.body.rest;
        apply(&transposed(&rest[parent].0), subtract(rest[joint].1, rest[parent].1))
    }

    /// Where the hips, or a joint above them, should be in the world: there as high over the hips as at rest, and aside as the body is built. In a capture's first
    /// frame, which may be the rest, a joint above the hips often stands at the origin, metres away, and the figure would swing about it.
    fn place(&self, joint: usize, carrier: usize, hips: [f64; 3]) -> Option<[f64; 3]> {
        let rest = &self.body.rest;
        let (mut at, mut built) = (carrier, hips);
        while at != joint {
            let parent = self.rig.joints[at].parent?;
            built = subtract(built, apply(&rest[parent].0, self.rig.joints[at].offset));
            at = parent;
        }
        let height = dot(add(hips, subtract(subtract(rest[joint].1, rest[carrier].1), built)), self.vertical);
        Some(add(built, self.vertical.map(|x| x * height)))
    }

    /// How far the written frame is from the source.
    fn measure(&self, source: &Pose, world: &[(Matrix, [f64; 3])], out: &mut Embodied) {
        let cm = self.rig.cm_per_unit;
        let own = |role: usize| world[self.body.joints[role]].1;
        let other = |role: usize| source[self.source.joints[role]].1;
        let degrees = |from: usize, to: usize| {
            let (a, b) = (unit(subtract(own(to), own(from))), unit(subtract(other(to), other(from))));
            norm(subtract(a, b)).min(2.0) / 2.0
        };
        let limb =
            |[first, second, third]: [usize; 3]| 2.0 * degrees(first, second).max(degrees(second, third)).asin().to_degrees();
        out.arms_deg = ARMS.iter().map(|&arm| limb(arm)).fold(out.arms_deg, f64::max);
        for leg in LEGS {
            let ankle = self.scaled(other(leg[2]));
            match self.nearness(ankle) {
                0.0 => out.legs_deg = out.legs_deg.max(limb(leg)),
                1.0 => out.ankles_cm = out.ankles_cm.max(dot(subtract(own(leg[2]), ankle.map(|x| x * cm)), self.vertical).abs()),
                _ => {}
            }
        }
    }
}

/// Whether two rigs have the same joints at the same offsets.
fn is_same(one: &Rig, other: &Rig) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * (1.0 + a.abs());
    let alike = |(a, b): (&Joint, &Joint)| {
        a.name == b.name && a.parent == b.parent && a.offset.iter().zip(b.offset).all(|(a, b)| near(*a, b))
    };
    one.joints.len() == other.joints.len() && one.up == other.up && one.joints.iter().zip(&other.joints).all(alike)
}

/// Refuses a body whose limbs do not hang on its trunk: the turns of hips and chest would not carry them.
fn hangs_together(rig: &Rig, joints: &[usize; 15]) -> Result<()> {
    let limbs = ARMS.iter().map(|arm| (CHEST, arm)).chain(LEGS.iter().map(|leg| (HIPS, leg)));
    let bones = limbs.flat_map(|(trunk, &[first, second, third])| [(trunk, first), (first, second), (second, third)]);
    for (above, below) in bones.chain([(HIPS, CHEST), (CHEST, HEAD)]) {
        let [above, below] = [above, below].map(|role| joints[role]);
        let mut at = Some(below);
        while at.is_some_and(|at| at != above) {
            at = at.and_then(|at| rig.joints[at].parent);
        }
        let [above, below] = [above, below].map(|joint| &rig.joints[joint].name);
        let text = format!(
            "the body's joint {below} does not hang on {above}, which therefore does not carry it; take a figure whose joints hang on one another (a generated \
             Rigify rig's do not, in a file of its deforming bones alone)"
        );
        require!(at.is_some(), Error::setting(Setting::Body, text));
    }
    Ok(())
}

/// The least height of a figure's ankles over all frames.
fn least_ankle(motion: &Motion, figure: &Figure, to_up: &Matrix, vertical: [f64; 3]) -> f64 {
    let of = |frame: usize| {
        let pose = rotated(pose(motion, Some(frame)), to_up);
        LEGS.map(|leg| dot(pose[figure.joints[leg[2]]].1, vertical)).into_iter().fold(f64::MAX, f64::min)
    };
    (0..motion.frames).map(of).fold(f64::MAX, f64::min)
}

/// The height of the body's ankles when it stands: as low as they come in its own file, so that what is put on it stands where its own motions do. In a file in
/// which the body does not stand on the ground, over a ground of height 0.
fn stands_at(body: &Motion, figure: &Figure, vertical: [f64; 3]) -> f64 {
    let least = least_ankle(body, figure, &IDENTITY, vertical);
    if (0.0..figure.leg / 2.0).contains(&least) { least } else { ankle_height(&body.rig, figure, vertical) }
}

/// The height of the ankles at rest over the lowest end of a foot.
fn ankle_height(rig: &Rig, figure: &Figure, vertical: [f64; 3]) -> f64 {
    let height = |joint: usize| dot(figure.rest[joint].1, vertical);
    let below = |joint: &Joint, foot: usize| {
        let mut at = joint.parent;
        while at.is_some_and(|at| at > foot) {
            at = at.and_then(|at| rig.joints[at].parent);
        }
        at == Some(foot)
    };
    let of = |foot: usize| {
        let ends = (0..rig.joints.len()).filter(|&index| below(&rig.joints[index], foot)).map(height);
        height(foot) - ends.fold(height(foot), f64::min)
    };
    LEGS.iter().map(|leg| of(figure.joints[leg[2]])).sum::<f64>() / 2.0
}

/// Quarters of a turn to the left, -1 to 2, that take the source's rest pose to the way in which the body's faces. Rest poses alone say how a figure is built: what
/// a capture's first frame faces is part of the motion.
fn quarters(source: &Figure, body: &Figure, vertical: [f64; 3]) -> i32 {
    if !(source.upright && body.upright) {
        return 0;
    }
    let quarters = (angle_about(vertical, source.lateral(), body.lateral()) / (PI / 2.0)).round() as i32;
    if quarters == -2 { 2 } else { quarters }
}

/// The angle in radians about the vertical, counterclockwise seen from above, from one direction to another.
fn angle_about(vertical: [f64; 3], from: [f64; 3], to: [f64; 3]) -> f64 {
    let level = |v: [f64; 3]| subtract(v, vertical.map(|x| x * dot(v, vertical)));
    let (from, to) = (level(from), level(to));
    dot(cross(from, to), vertical).atan2(dot(from, to))
}

/// The turn about the vertical by an angle in radians.
fn about_vertical_by(vertical: [f64; 3], angle: f64) -> Matrix {
    from_exponential(vertical.map(|x| x * angle))
}

/// The turn about the vertical that takes a direction to the heading of another.
fn about_vertical(vertical: [f64; 3], from: [f64; 3], to: [f64; 3]) -> Matrix {
    let level = |v: [f64; 3]| unit(subtract(v, vertical.map(|x| x * dot(v, vertical))));
    turn_between(level(from), level(to))
}

/// The least turn that takes a direction to another; half a turn where they are opposite.
fn turn_between(from: [f64; 3], to: [f64; 3]) -> Matrix {
    if dot(from, to) < -1.0 + 1e-9 {
        let axis = (0..3).min_by(|&a, &b| from[a].abs().total_cmp(&from[b].abs())).unwrap_or(0);
        let half = about(axis, PI);
        return product(&turn_between(apply(&half, from), to), &half);
    }
    aim(IDENTITY, &[from], &[to])
}

fn rotated(pose: Pose, turn: &Matrix) -> Pose {
    pose.into_iter().map(|(own, place)| (product(turn, &own), apply(turn, place))).collect()
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = norm(vector);
    if length > 0.0 { vector.map(|x| x / length) } else { vector }
}
