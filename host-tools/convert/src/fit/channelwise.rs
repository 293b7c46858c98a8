//! Codes each channel for itself, without the figure, under the paper's two criteria (METHOD 2.3): (b) `|p_l(n) - p(n)| <= delta` at
//! every frame, or (a) `|w_l(n) - w(n)| <= epsilon`, where positions may drift.

use super::bounds::{Bounds, unit};
use super::chain::{Constraint, chain, known};
use super::cost::Costs;
use super::refusal::amount;
use super::search::{Effort, Fitted, Tube, in_grids, search};
use super::{raw, time};
use crate::encode::clip::{Channel, Coded, Start, position_grid, velocity_grid};
use crate::events;
use crate::motion::{Interpolation, Keys, Motion};
use anyhow::{Result, bail};
use pantin::codec::layout::MAX_STEP;
use rayon::prelude::*;
use std::ops::RangeInclusive;

/// Part of a bound that is used: the rest covers rounding on the way from raw values to the motion's units.
const USED: f64 = 0.9999;
/// No bound is narrower than this, in raw units: what rounding alone takes, and a little.
const NARROWEST: f64 = 0.6;
/// The price of an error as large as the bound, in bits a frame: enough to prefer the middle where bits are equal.
const PRICE: f64 = 0.1;
/// Steps that are tried, against the one that is as large as the bound: none outside was ever best.
const POSITION_STEPS: RangeInclusive<i32> = -3..=4;
const KNOWN_STEPS: RangeInclusive<i32> = -6..=3;
const ACCELERATION_STEPS: RangeInclusive<i32> = -3..=5;
/// First values lie this many grid steps around the target at most.
const AROUND: i32 = 3;
/// Beams of the chains: known curves are worth the time.
const EXACT_BEAM: usize = 40;
const BEAM: usize = 10;
/// The search in wide tubes, and for constants.
const EFFORT: Effort = Effort { beam: 14, margin: 9.0, slopes: usize::MAX, all_alike: false };
/// What a channel at rest costs, about.
const REST_BITS: f64 = 0.4;

/// One channel: its raw values, its value at rest, and its bound.
struct Aim<'a> {
    target: &'a [f64],
    rest: f64,
    bound: f64,
    /// Values beyond this come round from the other side; angles may.
    room: f64,
    constraint: Constraint,
    exact: bool,
    /// Frames between which its second difference is linear, if they are known.
    keys: Option<Vec<usize>>,
}

/// Codes `motion` with every channel within its bound. `progress` is called once per channel.
pub fn fit(motion: &Motion, bounds: &Bounds, progress: &(dyn Fn() + Sync)) -> Result<Coded> {
    fit_exponent(motion, bounds, raw::clip_length_exponent(&motion.rig, &motion.values), progress)
}

/// Codes `motion` with positions as multiples of 2^length_exponent units, which clips of its rig can share.
pub fn fit_exponent(motion: &Motion, bounds: &Bounds, length_exponent: i8, progress: &(dyn Fn() + Sync)) -> Result<Coded> {
    let scales = raw::scales(&motion.rig, length_exponent);
    let rests = raw::rests(&motion.rig, length_exponent);
    let kinds = motion.rig.channel_kinds();
    let frame_time_ns = time(motion)?;
    let code = |channel: usize| {
        let scale = scales[channel];
        let target = raw::target(&motion.values[channel], kinds[channel].1, scale);
        check_range(motion, channel, &target)?;
        let bound = (USED * bounds.greatest[channel] / scale).max(NARROWEST);
        let rest = f64::from(rests[channel]);
        let turns = motion.rig.channel_kinds()[channel].1.is_rotation();
        let room = if turns { f64::INFINITY } else { f64::from(i32::MAX) };
        let aim = Aim {
            target: &target,
            rest,
            bound,
            room,
            constraint: bounds.constraint,
            exact: bounds.exact,
            keys: linear_between(motion, channel),
        };
        let found = aim.best();
        progress();
        found.map_or_else(|| refuse(motion, channel, aim, scale), Ok)
    };
    let codes = (0..motion.values.len()).into_par_iter().map(code).collect::<Result<Vec<_>>>()?;
    let choices = motion.rig.joints.iter().filter(|joint| joint.kinds.iter().filter(|kind| kind.is_rotation()).count() == 3);
    let (events, event_names) = events::to_clip(&motion.events);
    Ok(Coded {
        frames: motion.frames as u32,
        frame_time_ns,
        length_exponent,
        exponentials: choices.map(|_| false).collect(),
        channels: codes.into_iter().map(|code| Channel { start: code.start, segments: code.segments }).collect(),
        events,
        event_names,
        looped: motion.looped,
    })
}

/// Angles wrap as angles do; of all else, a clip holds what 32 bits hold.
fn check_range(motion: &Motion, channel: usize, target: &[f64]) -> Result<()> {
    let kind = motion.rig.channel_kinds()[channel].1;
    let outside = target.iter().position(|x| x.abs() >= f64::from(i32::MAX));
    if let Some(frame) = outside.filter(|_| !kind.is_rotation()) {
        let (name, value) = (motion.rig.channel_name(channel), motion.values[channel][frame]);
        bail!("channel {name} at frame {frame} is {value}; a clip cannot hold as much there");
    }
    Ok(())
}

/// Reports by how much the best code would be off, and where.
fn refuse<T>(motion: &Motion, channel: usize, mut aim: Aim<'_>, scale: f64) -> Result<T> {
    let name = motion.rig.channel_name(channel);
    let unit = unit(motion.rig.channel_kinds()[channel].1);
    let bound = aim.bound * scale;
    for _ in 0..32 {
        aim.bound *= 2.0;
        let Some(found) = aim.best() else { continue };
        let off: Vec<f64> = found.path.iter().zip(aim.target).map(|(p, x)| p - x).collect();
        let off = match aim.constraint {
            Constraint::Positions => off,
            Constraint::Accelerations => seconds(&off),
        };
        let (frame, worst) =
            off.iter().enumerate().fold((0, 0.0), |worst, (frame, x)| if x.abs() > worst.1 { (frame, x.abs()) } else { worst });
        let (worst, bound) = (amount(worst * scale, bound), amount(bound, bound));
        bail!("channel {name} at frame {frame} would be {worst}{unit} off; the bound is {bound}{unit}");
    }
    bail!("channel {name}: no code was found at any bound")
}

/// Second differences; 0 at the first two frames, which have none.
fn seconds(x: &[f64]) -> Vec<f64> {
    let of = |n: usize| if n < 2 { 0.0 } else { x[n] + x[n - 2] - 2.0 * x[n - 1] };
    (0..x.len()).map(of).collect()
}

impl Aim<'_> {
    /// The cheapest code that is found.
    fn best(&self) -> Option<Fitted> {
        let frames = self.target.len();
        if self.target.iter().all(|x| (x - self.rest).abs() <= self.bound) {
            let path = vec![self.rest; frames];
            return Some(Fitted { start: Start::Rest, segments: Vec::new(), path, bits: REST_BITS, start_bits: REST_BITS });
        }
        if frames >= 3 && self.constraint == Constraint::Accelerations {
            return self.accelerations();
        }
        let tube = self.tube(self.target.to_vec(), self.room);
        let still = self.target.iter().all(|x| (x - self.target[0]).abs() <= self.bound);
        if frames < 3 || still || !self.exact {
            let found = cheapest(self.steps(POSITION_STEPS), |step| search(&tube, step, EFFORT))?;
            let Start::Moving { step, .. } = found.start else { return Some(found) };
            let steps = [step, (step + 1).min(MAX_STEP)];
            let chains = if frames < 3 { None } else { cheapest(steps, |step| positions(&tube, step, BEAM)) };
            return cheapest([Some(found), chains], |code| code);
        }
        if let Some(keys) = &self.keys {
            let found = cheapest(self.steps(KNOWN_STEPS), |step| known(&tube, keys, &starts(&tube, step), step));
            if found.is_some() {
                return found;
            }
        }
        cheapest(self.steps(POSITION_STEPS), |step| positions(&tube, step, EXACT_BEAM))
    }

    fn accelerations(&self) -> Option<Fitted> {
        let tube = self.tube(seconds(self.target), f64::INFINITY);
        let (p, v) = (self.target[0], self.target[1] - self.target[0]);
        cheapest(self.steps(ACCELERATION_STEPS), |step| {
            let near = |x: f64, grid: i32| (x / f64::from(grid)).round() * f64::from(grid);
            let start = start(near(p, position_grid(step)), near(v, velocity_grid(step)), step);
            // Nothing else bounds how the channel begins.
            let within = (start.0 - p).abs() <= self.bound && (start.0 + start.1 - p - v).abs() <= self.bound;
            within.then(|| chain(&tube, Constraint::Accelerations, &[start], step, BEAM)).flatten()
        })
    }

    fn tube(&self, x: Vec<f64>, room: f64) -> Tube {
        let lo = x.iter().map(|x| (x - self.bound).max(-room)).collect();
        let hi = x.iter().map(|x| (x + self.bound).min(room)).collect();
        let (a, b) = (vec![PRICE / (self.bound * self.bound); x.len()], vec![0.0; x.len()]);
        Tube { x, lo, hi, a, b, bend: f64::INFINITY, start: Default::default() }
    }

    /// Channel steps around the one that is as large as the bound.
    fn steps(&self, around: RangeInclusive<i32>) -> RangeInclusive<u8> {
        let middle = (2.0 * self.bound.max(1.0).log2()).round() as i32;
        let within = |step: i32| step.clamp(0, i32::from(MAX_STEP)) as u8;
        within(middle + around.start())..=within(middle + around.end())
    }
}

fn cheapest<T>(tries: impl IntoIterator<Item = T>, code: impl Fn(T) -> Option<Fitted>) -> Option<Fitted> {
    tries.into_iter().filter_map(code).min_by(|a, b| a.bits.total_cmp(&b.bits))
}

fn start(p: f64, v: f64, step: u8) -> (f64, f64, f64) {
    let (p_grids, v_grids) = in_grids(p, v, step);
    (p, v, Costs::get().start(p_grids, v_grids))
}

fn positions(tube: &Tube, step: u8, beam: usize) -> Option<Fitted> {
    chain(tube, Constraint::Positions, &starts(tube, step), step, beam)
}

/// The frames of a channel's keys, if its second difference is linear between them.
fn linear_between(motion: &Motion, channel: usize) -> Option<Vec<usize>> {
    match motion.keys[channel].as_ref()? {
        Keys::OnFrames { interpolation: Interpolation::Discrete, keys, .. } => {
            Some(keys.iter().map(|&(frame, _)| frame).collect())
        }
        _ => None,
    }
}

/// Positions and velocities near the target's first, with their bits.
fn starts(tube: &Tube, step: u8) -> Vec<(f64, f64, f64)> {
    let (p_grid, v_grid) = (f64::from(position_grid(step)), f64::from(velocity_grid(step)));
    let near = |x: f64, grid: f64| (-AROUND..=AROUND).map(move |offset| ((x / grid).round() + f64::from(offset)) * grid);
    let inside = |frame: usize, p: f64| (tube.lo[frame]..=tube.hi[frame]).contains(&p);
    let mut starts = Vec::new();
    for p in near(tube.x[0], p_grid).filter(|&p| inside(0, p)) {
        // Velocities near the target's own, and those that make up for an error of p at once.
        let both = near(tube.x[1] - tube.x[0], v_grid).chain(near(tube.x[1] - p, v_grid));
        starts.extend(both.filter(|&v| inside(1, p + v)).map(|v| start(p, v, step)));
    }
    starts
}
