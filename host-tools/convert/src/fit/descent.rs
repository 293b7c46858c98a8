//! Closed-loop descent (METHOD 5): each channel is coded again inside the tube that the true error of everything below it
//! still leaves, pass after pass, while the price of an error falls.

use super::figure::{Figure, Poses};
use super::measure::{self, Measure};
use super::refusal::refusal;
use super::rotation_coding::Rotations;
use super::search::{Effort, Fitted, Tube, search};
use super::start_cost::{StartCosts, step_of};
use crate::encode::clip::Start;
use crate::motion::Kind;
use crate::pose_bound::PoseBound;
use anyhow::{Result, bail};
use pantin::codec::layout::{FIRST_STEP, MAX_STEP};
use rayon::prelude::*;

/// The bound, and the encoder's effort.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// What the clip keeps to.
    pub bound: PoseBound,
    /// Passes over all channels.
    pub passes: usize,
    /// Further rounds, each of [`ROUND_PART`] of the passes, in which the price is raised to the middle and falls again. The best code of all rounds is taken.
    pub rounds: usize,
    /// The price of an error, relative to a bit, in the first and the last pass.
    pub prices: (f64, f64),
    /// Whether two steps are tried at a time, in early passes every other time, or one.
    pub both_steps: bool,
    /// Whether early passes try slopes and both steps as later ones do.
    pub thorough: bool,
    /// The search for one channel.
    pub effort: Effort,
    /// How joints' rotations are coded.
    pub rotations: Rotations,
}

impl Plan {
    /// The same with more passes for a short clip, which takes little time: `values` is the number of its channels times that of its frames.
    pub fn with_time_for(self, values: usize) -> Plan {
        let more = (VALUES_OF_A_PLAN / values.max(1) as f64).sqrt().clamp(1.0, MOST_PASSES);
        let passes = if self.both_steps { (self.passes as f64 * more) as usize } else { self.passes };
        // What early passes of a long clip leave out costs a short one several percent.
        let thorough = self.both_steps && more > 1.0;
        let slopes = if thorough { usize::MAX } else { self.effort.slopes };
        Plan { passes, thorough, effort: Effort { slopes, ..self.effort }, ..self }
    }
}

/// Channels that are coded at one time, at most.
const TOGETHER: usize = 4;
/// Searches of fewer frames take less time than another thread takes to begin.
const SHORT: usize = 16;
/// Clips of fewer values have more passes, up to this many times more: a clip of 25 frames becomes 4 % smaller by four times as many.
const VALUES_OF_A_PLAN: f64 = 40_000.0;
const MOST_PASSES: f64 = 4.0;

/// The passes of a further round, as a part of those of the first.
pub const ROUND_PART: f64 = 0.4;
/// Where a further round begins between the first price and the last: lower prices change too little, higher ones undo too much.
const ROUND_FROM: f64 = 0.5;

/// Part of the bound that the fit uses: the rest covers rounding in files.
const USED: f64 = 0.9995;
/// Attempts at a channel, and at its first code; from the third on the tube shrinks toward where the channel is.
const ATTEMPTS: usize = 4;
const FIRST_ATTEMPTS: usize = 16;
const SHRINK: f64 = 0.6;
/// The price grows by this much where an error comes near the bound, so that others keep room.
const CROWDING: f64 = 4.0;
/// Levers are taken as constant while a channel moves by this much at most: degrees.
const TRUST_DEGREES: f64 = 25.0;
/// Bits by which a new code must be better.
const GAIN: f64 = 0.01;

/// Passes to a mean, in those to a bound.
const MEAN_PASSES: usize = 3;
/// The price of the first pass to a mean, in bits for each mean distance and second.
const FIRST_PRICE: f64 = 144.0;
/// The price falls by this factor from pass to pass, or by less once it fell too far; by hardly any, it is as low as it can be.
const FALL: f64 = 0.8;
const FALL_LEAST: f64 = 0.995;
/// A mean this near below the one that was asked for is as good.
const NEAR_MEAN: f64 = 0.99;
/// End Sites are not part of the mean, but are seen: they have this part of a joint's price.
const END_SITE_PART: f64 = 0.1;

/// A channel's code, and what the search had found it to cost.
type Code = Fitted;

/// Bits that a step away from the best one costs, times the square of the distance, about: so much up to this many bits, then in proportion.
const STEP_LOSS: f64 = 0.3;
const BITS_OF_STEP_LOSS: f64 = 256.0;

/// The state of a descent.
pub struct Descent<'m> {
    figure: &'m Figure,
    plan: Plan,
    /// Part of the bound that a channel's first code may fill.
    first_part: f64,
    /// Targets, raw and unwrapped.
    targets: &'m [Vec<f64>],
    /// Units of the motion for a raw unit.
    scales: &'m [f64],
    /// Where the rig has each channel at rest, raw.
    rests: &'m [i32],
    /// Kinds as the file has them.
    kinds: &'m [Kind],
    original: &'m Poses,
    measure: Measure,
    poses: Poses,
    codes: Vec<Option<Code>>,
    /// The last pass that found each channel a better code.
    improved: Vec<usize>,
    seconds_a_frame: f64,
}

/// The codes of a pass whose mean is small enough.
struct Kept {
    price: f64,
    bits: f64,
    codes: Vec<Option<Code>>,
}

impl<'m> Descent<'m> {
    /// Starts from the original: nothing is coded yet, nothing is off but by the rig's own rounding.
    #[allow(clippy::too_many_arguments)]
    pub fn new(
        figure: &'m Figure,
        plan: Plan,
        first_part: f64,
        targets: &'m [Vec<f64>],
        scales: &'m [f64],
        rests: &'m [i32],
        kinds: &'m [Kind],
        original: &'m Poses,
        seconds_a_frame: f64,
    ) -> Self {
        let poses = figure.poses(|channel, frame| targets[channel][frame] * scales[channel]);
        let codes = vec![None; targets.len()];
        let improved = vec![0; targets.len()];
        let measure = Measure::of(&plan.bound, figure);
        Descent {
            figure,
            plan,
            first_part,
            targets,
            scales,
            rests,
            kinds,
            original,
            measure,
            poses,
            codes,
            improved,
            seconds_a_frame,
        }
    }

    /// All passes. `progress` receives the fraction that is done, 0 to 1.
    pub fn run(mut self, progress: &mut dyn FnMut(f64)) -> Result<Vec<Code>> {
        if let Some(mean_cm) = self.plan.bound.mean_cm {
            return self.run_to_mean(mean_cm, progress);
        }
        let passes = self.plan.passes;
        let round_passes = self.round_passes();
        let all = (passes + self.plan.rounds * round_passes) as f64;
        let mut kept: Option<(f64, Vec<Option<Code>>)> = None;
        let mut pass = 0;
        for round in 0..=self.plan.rounds {
            let (from, count) = if round == 0 { (0.0, passes) } else { (ROUND_FROM, round_passes) };
            for of_round in 0..count {
                let price = self.price(from + (1.0 - from) * of_round as f64 / (count.max(2) - 1) as f64);
                self.pass(pass, price, of_round + 1 == count, &mut |done| progress((pass as f64 + done) / all))?;
                pass += 1;
            }
            let bits = self.bits();
            match &kept {
                Some((least, codes)) if *least <= bits => {
                    self.codes.clone_from(codes);
                    self.poses = self.figure.poses(|channel, frame| self.value(channel, frame));
                }
                _ => kept = Some((bits, self.codes.clone())),
            }
        }
        Ok(self.codes.into_iter().flatten().collect())
    }

    /// Passes of a round after the first.
    fn round_passes(&self) -> usize {
        (ROUND_PART * self.plan.passes as f64) as usize
    }

    /// The price of an error for a frame, where `part` of the way from the first price to the last is done.
    fn price(&self, part: f64) -> f64 {
        let (first, last) = self.plan.prices;
        self.seconds_a_frame * 30.0 * first * (last / first).powf(part)
    }

    /// Bits of all codes.
    fn bits(&self) -> f64 {
        self.codes.iter().flatten().map(|code| code.bits).sum()
    }

    /// One pass. A channel that nothing helped lately is tried in every third pass only, unless `every` channel is.
    fn pass(&mut self, pass: usize, price: f64, every: bool, progress: &mut dyn FnMut(f64)) -> Result<()> {
        let channels = self.targets.len();
        let order = (0..channels).map(|i| if pass.is_multiple_of(2) { i } else { channels - 1 - i });
        let tried = |channel: usize| every || pass < self.improved[channel] + 3 || (pass + channel).is_multiple_of(3);
        let groups = self.groups(order.filter(|&channel| tried(channel)).collect());
        let (mut done, all) = (0, groups.iter().map(Vec::len).sum::<usize>().max(1));
        for group in groups {
            self.improve_all(&group, price, pass)?;
            done += group.len();
            progress(done as f64 / all as f64);
        }
        Ok(())
    }

    /// Channels that move no joint in common are coded at one time. The groups are the same however many threads there are, so the codes are too.
    fn groups(&self, mut order: Vec<usize>) -> Vec<Vec<usize>> {
        let joint = |channel: &usize| self.figure.channels[*channel].0;
        let apart = |one: &usize, other: &usize| joint(one).zip(joint(other)).is_some_and(|(a, b)| self.figure.apart(a, b));
        let mut groups = Vec::new();
        while !order.is_empty() {
            let mut group: Vec<usize> = Vec::with_capacity(TOGETHER);
            order.retain(|channel| {
                let joins = group.len() < TOGETHER && group.iter().all(|other| apart(channel, other));
                if joins {
                    group.push(*channel);
                }
                !joins
            });
            groups.push(group);
        }
        groups
    }

    /// Codes the channels of a group again, each if that is better.
    fn improve_all(&mut self, group: &[usize], price: f64, pass: usize) -> Result<()> {
        let mut poses = std::mem::take(&mut self.poses);
        let joints = group.iter().map(|&channel| (channel, self.figure.channels[channel].0));
        let found = if let [channel] = *group {
            vec![(channel, self.improve(channel, &mut poses, price, pass))]
        } else {
            let parts: Vec<_> =
                joints.map(|(channel, joint)| (channel, joint, joint.map(|joint| poses.take(self.figure, joint)))).collect();
            let improve = |(channel, joint, mut part): (usize, Option<usize>, Option<Poses>)| {
                let code = self.improve(channel, part.as_mut()?, price, pass);
                Some((channel, joint?, part?, code))
            };
            let improved: Vec<_> = parts.into_par_iter().filter_map(improve).collect();
            let put_back = |(channel, joint, mut part, code)| {
                poses.exchange(&mut part, self.figure, joint);
                (channel, code)
            };
            improved.into_iter().map(put_back).collect()
        };
        self.poses = poses;
        for (channel, code) in found {
            if let Some(code) = code? {
                self.codes[channel] = Some(code);
                self.improved[channel] = pass;
            }
        }
        Ok(())
    }

    /// Passes whose price for a centimetre falls until the mean is reached. A higher price would not undo what a lower one did, so a
    /// pass that goes too far is taken back and the price falls less from there.
    fn run_to_mean(mut self, mean_cm: f64, progress: &mut dyn FnMut(f64)) -> Result<Vec<Code>> {
        let passes = MEAN_PASSES * (self.plan.passes + self.plan.rounds * self.round_passes());
        let mut fall = FALL;
        let mut price = FIRST_PRICE * self.seconds_a_frame / mean_cm;
        let mut kept: Option<Kept> = None;
        for pass in 0..passes {
            self.pass(pass, price, false, &mut |done| progress((pass as f64 + done) / passes as f64))?;
            let part = self.mean() / mean_cm;
            if part <= 1.0 {
                let bits = self.bits();
                let saved = kept.as_ref().is_none_or(|kept| bits < 0.999 * kept.bits);
                kept = Some(Kept { price, bits, codes: self.codes.clone() });
                if part > NEAR_MEAN && !saved {
                    break;
                }
                // Far from the mean, one pass at a price is enough.
                if part < 0.6 || !pass.is_multiple_of(2) {
                    price *= fall;
                }
            } else if let Some(kept) = &kept {
                self.codes.clone_from(&kept.codes);
                self.poses = self.figure.poses(|channel, frame| self.value(channel, frame));
                fall = fall.sqrt();
                price = kept.price * fall;
                if fall > FALL_LEAST {
                    break;
                }
            } else {
                price /= fall * fall;
            }
        }
        let Some(kept) = kept else {
            bail!("no code with a mean error of {mean_cm} cm was found within {} cm at every joint", self.measure.max_cm);
        };
        Ok(kept.codes.into_iter().flatten().collect())
    }

    /// The mean distance of the joints from where they should be, in cm.
    fn mean(&self) -> f64 {
        let counted: Vec<usize> = (0..self.figure.rig.joints.len()).filter(|&joint| self.counts(joint)).collect();
        let frames = |joint: usize| (0..self.figure.frames).map(move |frame| (joint, frame));
        let distance = |(joint, frame)| self.measure.distance_cm(self.figure, &self.poses, self.original, joint, frame);
        counted.iter().flat_map(|&joint| frames(joint)).map(distance).sum::<f64>()
            / (counted.len() * self.figure.frames).max(1) as f64
    }

    /// Whether a joint is part of the mean.
    fn counts(&self, joint: usize) -> bool {
        !self.figure.rig.joints[joint].end_site && self.measure.bounded[joint]
    }

    /// The price, in bits, of a point's squared distance in cm, where it is off by the root of `square` now: the distance itself has the price.
    fn price_to_mean(&self, joint: usize, square: f64, price: f64, mean_cm: f64) -> f64 {
        let part = if self.counts(joint) { 1.0 / self.measure.points(self.figure, &[joint]) as f64 } else { END_SITE_PART };
        // In proportion to the square below the mean: otherwise what is exact by chance would stay so at any price.
        part * price / (2.0 * square.sqrt().max(mean_cm))
    }

    /// A better code of one channel, if one is found. `poses` have all that the channel moves, which becomes what the code makes of it.
    fn improve(&self, channel: usize, poses: &mut Poses, price: f64, pass: usize) -> Result<Option<Code>> {
        let moved = self.measure.moved(self.figure, channel);
        let bound = self.measure.max_cm * USED;
        let coded = self.codes[channel].is_some();
        let mut bounds = vec![if coded { bound } else { bound * self.first_part }; self.figure.frames];
        let axes = self.figure.axes(channel, |channel, frame| self.value(channel, frame), poses);
        let worst_now = self.worst(channel, poses, &moved);
        let attempts = if coded { ATTEMPTS } else { FIRST_ATTEMPTS };
        for attempt in 0..attempts {
            let shrink = SHRINK.powi((attempt as i32 - 1).max(0));
            let tube = self.tube(channel, price, poses, &moved, &axes, &bounds, shrink);
            let Some(best) = self.best(channel, &tube, pass, attempt) else {
                if coded || bounds[0] >= bound {
                    break;
                }
                bounds.iter_mut().for_each(|limit| *limit = bound);
                continue;
            };
            if let Some(now) = &self.codes[channel]
                && objective(&best, &tube) >= objective(now, &tube) - GAIN
            {
                return Ok(None);
            }
            self.refresh(channel, &best.path, poses);
            let worst = self.worst(channel, poses, &moved);
            if worst.iter().all(|&distance| distance <= bound) {
                return Ok(Some(best));
            }
            // Levers change along the way: leave less room where they misled, but never less than there is.
            for ((limit, distance), now) in bounds.iter_mut().zip(worst).zip(&worst_now) {
                if distance > bound {
                    *limit = (*limit * (bound / distance).powi(2) * 0.98).max(0.5 * (now + bound));
                }
            }
            self.refresh(channel, self.path(channel), poses);
        }
        if !coded {
            bail!(refusal(self.figure, &self.measure, poses, self.original, channel, &moved));
        }
        Ok(None)
    }

    fn path(&self, channel: usize) -> &[f64] {
        path(&self.codes, self.targets, channel)
    }

    /// A channel's value at a frame, in the motion's units.
    fn value(&self, channel: usize, frame: usize) -> f64 {
        self.path(channel)[frame] * self.scales[channel]
    }

    /// Poses with another path of a channel.
    fn refresh(&self, channel: usize, path: &[f64], poses: &mut Poses) {
        if let (Some(joint), ..) = self.figure.channels[channel] {
            let value = |other: usize, frame: usize| {
                if other == channel { path[frame] * self.scales[channel] } else { self.value(other, frame) }
            };
            self.figure.update(joint, value, poses);
        }
    }

    /// The greatest error of these joints, which the channel moves, at each frame, in cm.
    fn worst(&self, channel: usize, poses: &Poses, joints: &[usize]) -> Vec<f64> {
        let mover = self.figure.channels[channel].0;
        let mut worst = vec![0f64; self.figure.frames];
        for &joint in joints {
            let own = mover == Some(joint);
            for (frame, worst) in worst.iter_mut().enumerate() {
                *worst = worst.max(self.measure.worst_square(self.figure, poses, self.original, joint, frame, own));
            }
        }
        worst.iter().map(|square| square.sqrt()).collect()
    }

    /// The tube that the other channels' codes leave to this one.
    #[allow(clippy::too_many_arguments)]
    fn tube(
        &self,
        channel: usize,
        price: f64,
        poses: &Poses,
        moved: &[usize],
        axes: &[[f64; 3]],
        bounds: &[f64],
        shrink: f64,
    ) -> Tube {
        let frames = self.figure.frames;
        let target = &self.targets[channel];
        let scale = self.scales[channel];
        let translates = self.figure.translates(channel);
        let now: Vec<f64> = self.path(channel).iter().zip(target).map(|(p, x)| p - x).collect();
        let trust = self.trust(channel, translates, scale);
        // Many points below share one error: their sum counts as the root of their number.
        let points = self.measure.points(self.figure, moved).max(1) as f64;
        let share = price / (self.measure.max_cm.powi(2) * points.sqrt());
        let zeros = || vec![0.0; frames];
        let mut tube = Tube {
            x: target.clone(),
            lo: now.iter().map(|now| now - trust).collect(),
            hi: now.iter().map(|now| now + trust).collect(),
            a: zeros(),
            b: zeros(),
            bend: f64::INFINITY,
            start: self.start_costs(channel),
        };
        let Some(mover) = self.figure.channels[channel].0 else { return tube };
        for &joint in moved {
            for frame in 0..frames {
                let now = now[frame];
                let center = &poses.places[mover][frame];
                let motion = measure::Motion { axis: axes[frame].map(|x| x * scale), translates, center, now };
                let limit = bounds[frame] * bounds[frame];
                self.measure.each(self.figure, poses, self.original, [joint, mover], frame, &motion, |quantity| {
                    let weight = self.weight(joint, quantity.ee, price, share);
                    tube.a[frame] += weight * quantity.jj;
                    tube.b[frame] += weight * quantity.jr;
                    if !quantity.holds(limit, tube.lo[frame], tube.hi[frame]) {
                        let (lo, hi) = quantity.within(limit, now);
                        tube.lo[frame] = tube.lo[frame].max(lo);
                        tube.hi[frame] = tube.hi[frame].min(hi);
                    }
                });
            }
        }
        let most = self.range(channel);
        for frame in 0..frames {
            let (middle, now) = (target[frame] + now[frame], now[frame]);
            tube.lo[frame] = (middle + shrink * (tube.lo[frame] - now)).max((-most).min(target[frame]));
            tube.hi[frame] = (middle + shrink * (tube.hi[frame] - now)).min(most.max(target[frame]));
        }
        tube
    }

    /// The largest raw value that the decoder does not wrap into another rotation. Components of a quaternion, whose length is free, and of an
    /// exponential map near half a turn would reach it; Euler angles may wrap, and positions use half of their range.
    fn range(&self, channel: usize) -> f64 {
        let (_, kind, _) = self.figure.channels[channel];
        if kind.is_quaternion() || kind.is_exponential() { f64::from(i32::MAX) } else { f64::MAX }
    }

    /// By how many raw units a channel may change while its levers are taken as constant. One of a joint that is not bounded may rest.
    fn trust(&self, channel: usize, translates: bool, scale: f64) -> f64 {
        let free = self.figure.channels[channel].0.is_some_and(|joint| !self.measure.bounded[joint]);
        if translates || free { f64::MAX } else { TRUST_DEGREES / scale.abs() }
    }

    /// The price, in bits, of a quantity's squared error in cm, where that square is `ee` now.
    #[inline(always)]
    fn weight(&self, joint: usize, ee: f64, price: f64, share: f64) -> f64 {
        match self.plan.bound.mean_cm {
            Some(mean_cm) => self.price_to_mean(joint, ee, price, mean_cm),
            None => {
                let used = ee / (self.measure.max_cm * self.measure.max_cm);
                share * (1.0 + CROWDING * used * used * used)
            }
        }
    }

    /// What the channel's start costs beside those of the others.
    fn start_costs(&self, channel: usize) -> StartCosts {
        StartCosts::of(channel, self.kinds, |other| self.codes[other].as_ref().map(|code| &code.start))
    }

    /// The best of what the search finds at a few steps.
    fn best(&self, channel: usize, tube: &Tube, pass: usize, attempt: usize) -> Option<Fitted> {
        // What early passes find is soon replaced.
        let early = pass < self.plan.passes / 2;
        let both_steps = self.plan.both_steps && (!early || self.plan.thorough || (pass + channel).is_multiple_of(2));
        let pass = pass + attempt;
        if let Some(rest) = self.at_rest(channel, tube) {
            return Some(rest);
        }
        let (guess, other) = match &self.codes[channel] {
            Some(code) => {
                let rms = (code.path.iter().zip(&tube.x).map(|(p, x)| (p - x).powi(2)).sum::<f64>() / tube.x.len() as f64).sqrt();
                let step = step_of(&code.start).unwrap_or(FIRST_STEP);
                let near = step_index(1.6 * rms).clamp(step.saturating_sub(1), step + 1);
                let other = if pass.is_multiple_of(2) { near + 1 } else { near.saturating_sub(1) };
                // One that the others predict, as long as it is hardly worse.
                let loss = STEP_LOSS * ((code.bits - code.start_bits) / BITS_OF_STEP_LOSS).max(1.0);
                let bits = |step: u8| tube.start.step(step) + loss * f64::from(step.abs_diff(near)).powi(2);
                let cheap = (near.saturating_sub(3)..=(near + 3).min(MAX_STEP)).min_by(|&a, &b| bits(a).total_cmp(&bits(b)));
                let cheap = cheap.filter(|&cheap| cheap != near && pass % 3 != 2);
                (near, cheap.unwrap_or(other))
            }
            None => {
                // The tube of a channel that is exact so far is as wide as the bound.
                let width = (0..tube.x.len()).map(|f| tube.hi[f] - tube.lo[f]).fold(f64::MAX, f64::min);
                let near = step_index(0.15 * width);
                (near, near.saturating_sub(2))
            }
        };
        let mut effort = self.plan.effort;
        if early {
            let slopes = if self.plan.thorough { effort.slopes } else { 0 };
            effort = Effort { beam: effort.beam.div_ceil(2), margin: 0.7 * effort.margin, slopes, ..effort };
        }
        let one = || search(tube, guess.min(MAX_STEP), effort);
        let two = || if both_steps { search(tube, other.min(MAX_STEP), effort) } else { None };
        let (one, two) = if tube.x.len() < SHORT { (one(), two()) } else { rayon::join(one, two) };
        let best = [one, two].into_iter().flatten().min_by(|a, b| objective(a, tube).total_cmp(&objective(b, tube)));
        if best.is_some() || self.codes[channel].is_some() {
            return best;
        }
        // A first code must be found, whatever it costs.
        (0..guess.min(other)).rev().find_map(|step| search(tube, step, Effort { beam: 4 * effort.beam, ..effort }))
    }

    /// No code at all, if the rig has the channel within its tube.
    fn at_rest(&self, channel: usize, tube: &Tube) -> Option<Fitted> {
        let rest = f64::from(self.rests[channel]);
        let inside = (0..tube.x.len()).all(|f| (tube.lo[f]..=tube.hi[f]).contains(&rest));
        let flat = tube.a.iter().all(|&a| a == 0.0);
        let path = vec![rest; tube.x.len()];
        let cheap = flat || tube.price(&path) < 8.0;
        let bits = tube.start.bits(&Start::Rest);
        (inside && cheap).then_some(Fitted { start: Start::Rest, segments: Vec::new(), path, bits, start_bits: bits })
    }
}

/// A channel that is not coded yet is where it should be.
fn path<'c>(codes: &'c [Option<Code>], targets: &'c [Vec<f64>], channel: usize) -> &'c [f64] {
    codes[channel].as_ref().map_or(&targets[channel], |code| &code.path)
}

/// The price of a code's errors, and its bits beside the other channels' codes of now.
fn objective(code: &Fitted, tube: &Tube) -> f64 {
    code.bits - code.start_bits + tube.start.bits(&code.start) + tube.price(&code.path)
}

/// Index of the channel step nearest to `size` raw units.
fn step_index(size: f64) -> u8 {
    (2.0 * size.max(1.0).log2()).round().clamp(0.0, f64::from(MAX_STEP)) as u8
}
