//! Channels that move no joint: each for itself within its bound, and where one keeps within another's, both by the same segments.
//!
//! Faces are nearly the same on both sides: in recordings a quarter of what moves can follow.

use super::search::{Effort, Fitted, Tube, search};
use super::start_cost::step_of;
use crate::encode::clip::Start;
use crate::motion::Rig;
use anyhow::{Result, anyhow};
use pantin::codec::layout::{FOLLOW_BITS, MAX_STEP};
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// Raw values: beyond them a scalar would come round from the other side.
const LEAST: f64 = i32::MIN as f64;
const MOST: f64 = i32::MAX as f64;
/// Part of the bound that is used: the rest covers rounding in files.
const USED: f64 = 0.9995;
/// The price of an error as large as the bound, in bits a frame: enough to prefer the middle where bits are equal.
const PRICE: f64 = 0.02;
/// Steps that are tried, against the one that is as large as the bound.
const STEPS: RangeInclusive<i32> = -3..=4;
/// Second differences are at most this many times the source's greatest, so that a face does not jerk.
const BEND: f64 = 1.45;
/// How much wider the last search of a code is, and how much farther it lets hypotheses be behind the best: 1 % fewer bytes for a third more time.
const WIDER: usize = 4;
const WIDER_MARGIN: f64 = 2.0;
/// Channels that one is tried to follow: those that leave most room.
const LEADERS: usize = 4;
/// What a channel at rest, and that one follows, cost, about.
const REST_BITS: f64 = 0.4;
const FOLLOWS_BITS: f64 = 2.0 + FOLLOW_BITS as f64;

/// A channel's raw values, and how far it may be off.
pub struct Aim {
    /// The values.
    pub target: Vec<f64>,
    /// The greatest error.
    pub bound: f64,
}

/// Channels that have one code.
struct Group {
    members: Vec<usize>,
    tube: Tube,
    code: Fitted,
}

/// Codes the scalars of `rig`, whose channels come after those of joints.
pub fn fit(rig: &Rig, aims: &[Aim], effort: Effort) -> Result<Vec<Fitted>> {
    let first = rig.joint_channels();
    // Scalars are searched once: slopes from all hypotheses take little time.
    let slopes = if effort.slopes > 0 { usize::MAX } else { 0 };
    let coder = Coder { effort: Effort { slopes, ..effort } };
    let alone = |(scalar, aim): (usize, &Aim)| {
        let tube = aim.tube();
        let code = if aim.rests() { Some(rest(aim.target.len())) } else { coder.code(&tube) };
        let refused = || anyhow!("channel {}: no code within its bound was found", rig.channel_name(first + scalar));
        Ok((tube, code.ok_or_else(refused)?))
    };
    let alone = aims.par_iter().enumerate().map(alone).collect::<Result<Vec<_>>>()?;
    let mut codes: Vec<Fitted> = alone.iter().map(|(_, code)| code.clone()).collect();
    let mut groups: Vec<Group> = Vec::new();
    let moving: Vec<usize> = (0..codes.len()).filter(|&scalar| matches!(codes[scalar].start, Start::Moving { .. })).collect();
    for (place, &scalar) in moving.iter().enumerate() {
        let (tube, code) = &alone[scalar];
        let near = &moving[place.saturating_sub(1 << FOLLOW_BITS)..place];
        match coder.leader(&groups, near, tube, code) {
            Some((at, shared, code)) => {
                groups[at].members.push(scalar);
                (groups[at].tube, groups[at].code) = (shared, code);
            }
            None => groups.push(Group { members: vec![scalar], tube: tube.clone(), code: code.clone() }),
        }
    }
    let refined: Vec<_> = groups.par_iter().map(|group| coder.refined(&group.tube, &group.code)).collect();
    for (Group { members, .. }, code) in groups.into_iter().zip(refined) {
        let leader = first + members[0];
        for &follower in &members[1..] {
            let start = Start::Follows { leader };
            codes[follower] =
                Fitted { start, segments: Vec::new(), path: code.path.clone(), bits: FOLLOWS_BITS, start_bits: FOLLOWS_BITS };
        }
        codes[members[0]] = code;
    }
    Ok(codes)
}

fn rest(frames: usize) -> Fitted {
    Fitted { start: Start::Rest, segments: Vec::new(), path: vec![0.0; frames], bits: REST_BITS, start_bits: REST_BITS }
}

impl Aim {
    fn rests(&self) -> bool {
        self.target.iter().all(|x| x.abs() <= self.bound * USED)
    }

    fn tube(&self) -> Tube {
        let bound = self.bound * USED;
        let lo = self.target.iter().map(|x| (x - bound).max(LEAST)).collect();
        let hi = self.target.iter().map(|x| (x + bound).min(MOST)).collect();
        let frames = self.target.len();
        let bend = self.target.windows(3).fold(0.0, |most: f64, x| most.max((x[0] + x[2] - 2.0 * x[1]).abs()));
        let (a, b) = (vec![PRICE / (bound * bound); frames], vec![0.0; frames]);
        Tube { x: self.target.clone(), lo, hi, a, b, bend: BEND * bend, start: Default::default() }
    }
}

/// What both tubes leave, if it is room enough at every frame.
fn shared(one: &Tube, other: &Tube) -> Option<Tube> {
    let lo: Vec<f64> = one.lo.iter().zip(&other.lo).map(|(a, b)| a.max(*b)).collect();
    let hi: Vec<f64> = one.hi.iter().zip(&other.hi).map(|(a, b)| a.min(*b)).collect();
    let open = lo.iter().zip(&hi).all(|(lo, hi)| lo < hi);
    let x = lo.iter().zip(&hi).map(|(lo, hi)| 0.5 * (lo + hi)).collect();
    open.then(|| Tube { x, lo, hi, a: one.a.clone(), b: one.b.clone(), bend: one.bend.min(other.bend), start: one.start.clone() })
}

fn narrowest(tube: &Tube) -> f64 {
    tube.lo.iter().zip(&tube.hi).fold(f64::MAX, |least, (lo, hi)| least.min(hi - lo))
}

struct Coder {
    effort: Effort,
}

impl Coder {
    /// The cheapest code that is found within the tube. Where none bends as little as it should, one that bends more.
    fn code(&self, tube: &Tube) -> Option<Fitted> {
        let within = |tube: &Tube| {
            let tries: Vec<_> = steps(tube).into_par_iter().filter_map(|step| search(tube, step, self.effort)).collect();
            tries.into_iter().min_by(|a, b| a.bits.total_cmp(&b.bits))
        };
        let free = Tube { bend: f64::INFINITY, ..tube.clone() };
        // One must be found, whatever it costs.
        let finer = || {
            let wide = Effort { beam: 4 * self.effort.beam, ..self.effort };
            (0..*steps(tube).start()).rev().find_map(|step| search(&free, step, wide))
        };
        within(tube).or_else(|| within(&free)).or_else(finer)
    }

    /// Searches wider at the step that was found best. What others follow keeps moving.
    fn refined(&self, tube: &Tube, code: &Fitted) -> Fitted {
        let wide = Effort { beam: WIDER * self.effort.beam, margin: WIDER_MARGIN * self.effort.margin, ..self.effort };
        let found = step_of(&code.start).and_then(|step| search(tube, step, wide));
        let alike = |found: &Fitted| std::mem::discriminant(&found.start) == std::mem::discriminant(&code.start);
        found.filter(|found| alike(found) && found.bits < code.bits).unwrap_or_else(|| code.clone())
    }

    /// The group that a channel joins if that takes fewer bits, with what they share. Leaders are among `near`.
    fn leader(&self, groups: &[Group], near: &[usize], tube: &Tube, code: &Fitted) -> Option<(usize, Tube, Fitted)> {
        let groups = groups.iter().enumerate().filter(|(_, group)| near.contains(&group.members[0]));
        let mut tries: Vec<_> = groups.filter_map(|(at, group)| Some((at, group, shared(&group.tube, tube)?))).collect();
        tries.sort_by(|a, b| narrowest(&b.2).total_cmp(&narrowest(&a.2)));
        tries.truncate(LEADERS);
        let together = |(at, group, shared): (usize, &Group, Tube)| {
            let found = self.code(&shared).filter(|found| matches!(found.start, Start::Moving { .. }))?;
            let gain = group.code.bits + code.bits - found.bits - FOLLOWS_BITS;
            (gain > 0.0).then_some((gain, (at, shared, found)))
        };
        let found = tries.into_par_iter().filter_map(together).collect::<Vec<_>>();
        found.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, found)| found)
    }
}

/// Channel steps around the one that is as large as half of the tube.
fn steps(tube: &Tube) -> RangeInclusive<u8> {
    let widest = tube.lo.iter().zip(&tube.hi).fold(1.0, |most: f64, (lo, hi)| most.max(0.5 * (hi - lo)));
    let middle = (2.0 * widest.log2()).round() as i32;
    let within = |step: i32| step.clamp(0, i32::from(MAX_STEP)) as u8;
    within(middle + STEPS.start())..=within(middle + STEPS.end())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::level::Level;
    use crate::motion::Scalar;
    use crate::pose_bound::PoseBound;

    const RAW: f64 = 1e9;
    const BOUND: f64 = 0.02;

    fn bend(x: &[f64]) -> f64 {
        x.windows(3).fold(0.0, |most, x| f64::max(most, (x[0] + x[2] - 2.0 * x[1]).abs()))
    }

    #[test]
    fn a_channel_near_another_follows_it_and_all_keep_their_bounds_and_bend_little() {
        let wave = |speed: f64, other: f64| (0..200).map(|t| (0.4 * (speed * f64::from(t)).sin() + other).abs()).collect();
        let other = vec![0.0; 200];
        let values: Vec<Vec<f64>> = vec![wave(0.06, 0.0), other, wave(0.05, 0.0), wave(0.06, 0.015), wave(0.06, 0.06)];
        let scalars = (0..values.len()).map(|index| Scalar { name: format!("s{index}"), full_scale: 1.0 }).collect();
        let rig = Rig { joints: Vec::new(), scalars, cm_per_unit: 1.0, ..Rig::default() };
        let raw = |values: &Vec<f64>| values.iter().map(|x| x * RAW).collect();
        let aims: Vec<Aim> = values.iter().map(|values| Aim { target: raw(values), bound: BOUND * RAW }).collect();
        let codes = fit(&rig, &aims, Level::DEFAULT.plan(PoseBound::places(1.0)).effort).unwrap();
        assert_eq!((codes[1].start, codes[3].start), (Start::Rest, Start::Follows { leader: 0 }));
        assert!([0, 2, 4].iter().all(|&alone| matches!(codes[alone].start, Start::Moving { .. })));
        for (code, aim) in codes.iter().zip(&aims) {
            let off = code.path.iter().zip(&aim.target).map(|(p, x)| (p - x).abs());
            assert!(off.fold(0.0, f64::max) <= aim.bound);
            assert!(bend(&code.path) <= 1.5 * bend(&aim.target));
        }
    }
}
