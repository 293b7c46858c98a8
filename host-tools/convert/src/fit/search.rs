//! Finds the cheapest W and K segments of one channel within a tube, by a beam search (`beam.rs`).

use super::beam::{Beam, Hypothesis};
use super::cost::Costs;
use super::segment_price::{LANES, LONGEST, SegmentPrice};
use super::start_cost::StartCosts;
use crate::encode::clip::{Start, position_grid, velocity_grid};
use crate::encode::segment::Segment;
use pantin::codec::layout::MAX_STEP;
use pantin::codec::segment::{self, step as number_step};
use pantin::codec::step_size;

/// What a channel may do: at each frame within `lo..=hi`, at the price of `a e^2 + 2 b e` bits for the error e = p - x.
#[derive(Clone, Debug, Default)]
pub struct Tube {
    /// The target, raw.
    pub x: Vec<f64>,
    /// Least value allowed.
    pub lo: Vec<f64>,
    /// Greatest value allowed.
    pub hi: Vec<f64>,
    /// Quadratic price.
    pub a: Vec<f64>,
    /// Half of the linear price.
    pub b: Vec<f64>,
    /// Greatest second difference of [`search`]'s path.
    pub bend: f64,
    /// What its start costs.
    pub start: StartCosts,
}

impl Tube {
    /// The price of a path.
    pub fn price(&self, path: &[f64]) -> f64 {
        path.iter().enumerate().map(|(f, p)| self.price_at(f, *p)).sum()
    }

    fn price_at(&self, frame: usize, p: f64) -> f64 {
        let e = p - self.x[frame];
        e * (self.a[frame] * e + 2.0 * self.b[frame])
    }
}

/// A channel's code.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// How it begins.
    pub start: Start,
    /// Its segments.
    pub segments: Vec<Segment>,
    /// Its position at every frame, unwrapped.
    pub path: Vec<f64>,
    /// Bits of its symbols.
    pub bits: f64,
    /// Those of them that are its start's.
    pub start_bits: f64,
}

/// How hard to search.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Hypotheses that are extended from a frame.
    pub beam: usize,
    /// Bits by which a hypothesis may be behind the best.
    pub margin: f64,
    /// Hypotheses of a frame that are extended by slopes as well, the best ones.
    pub slopes: usize,
    /// Whether hypotheses at nearly the same position and velocity are all kept (slow); otherwise the best of them is.
    pub all_alike: bool,
}

/// What it is worth to spare a player the reading of a segment: 1 % more bytes for 7 % fewer segments, measured on eight clips.
pub const SEGMENT_BITS: f64 = 2.0;

/// Both steps of a mode's length for one channel.
pub(super) struct Steps {
    pub(super) w: [f64; 16],
    pub(super) k: [f64; 16],
}

/// The channel's own numbers during one search.
pub(super) struct Search<'t> {
    pub(super) tube: &'t Tube,
    /// What frames behind the present one cost.
    pub(super) price: SegmentPrice<'t>,
    step: u8,
    pub(super) steps: Steps,
    pub(super) costs: &'static Costs,
    pub(super) effort: Effort,
    pub(super) beam: Beam<f64>,
}

/// The cheapest code of a channel with this step, if any is found.
pub fn search(tube: &Tube, step: u8, effort: Effort) -> Option<Fitted> {
    let resting = constant(tube, step);
    if tube.x.len() < 3 {
        return resting.or_else(|| short(tube, step));
    }
    let moving = Search::new(tube, step, effort).run();
    match (resting, moving) {
        (Some(rest), Some(moving)) => {
            let better = rest.bits + tube.price(&rest.path) <= moving.bits + tube.price(&moving.path);
            Some(if better { rest } else { moving })
        }
        (rest, moving) => rest.or(moving),
    }
}

/// By how much wider a search is around a frame that no hypothesis passed. Those that were not kept may pass it.
const WIDER: usize = 4;
/// From how many frames before such a frame it is searched again, and from how many if that does not help.
const BACK: [usize; 2] = [192, 768];
/// By how much the step of a constant may be finer than its channel would have, or coarser.
const CONSTANT_STEPS: std::ops::RangeInclusive<i8> = -4..=24;

/// One value for all frames.
fn constant(tube: &Tube, step: u8) -> Option<Fitted> {
    let lo = tube.lo.iter().copied().fold(f64::MIN, f64::max);
    let hi = tube.hi.iter().copied().fold(f64::MAX, f64::min);
    if lo > hi {
        return None;
    }
    let frames = tube.x.len();
    let sum_a: f64 = tube.a.iter().sum();
    let sum_x: f64 = (0..frames).map(|f| tube.a[f] * tube.x[f] - tube.b[f]).sum();
    let best = if sum_a > 0.0 { (sum_x / sum_a).clamp(lo, hi) } else { 0.5 * (lo + hi) };
    let mut chosen: Option<(f64, Fitted)> = None;
    for finer in CONSTANT_STEPS {
        let Some(step) = step.checked_add_signed(-finer).filter(|&step| step <= MAX_STEP) else { continue };
        let grid = f64::from(position_grid(step));
        let p = (best / grid).round() * grid;
        if p < lo || p > hi {
            continue;
        }
        let path = vec![p; frames];
        let start = Start::Constant { p: wrap(p / grid), step };
        let bits = tube.start.bits(&start);
        let objective = bits + tube.price(&path);
        if chosen.as_ref().is_none_or(|(least, _)| objective < *least) {
            chosen = Some((objective, Fitted { start, segments: Vec::new(), path, bits, start_bits: bits }));
        }
    }
    chosen.map(|(_, fitted)| fitted)
}

/// One or two frames: a start says it all.
fn short(tube: &Tube, step: u8) -> Option<Fitted> {
    let (pg, vg) = (f64::from(position_grid(step)), f64::from(velocity_grid(step)));
    let p = near(tube.x[0], pg);
    let v = near(tube.x[tube.x.len() - 1] - p, vg);
    let path: Vec<f64> = (0..tube.x.len()).map(|f| p + f as f64 * v).collect();
    let inside = path.iter().enumerate().all(|(f, p)| (tube.lo[f]..=tube.hi[f]).contains(p));
    let (p, v) = (wrap(p / pg), wrap(v / vg));
    let start = Start::Moving { p, v, step };
    let bits = tube.start.bits(&start);
    inside.then_some(Fitted { start, segments: Vec::new(), path, bits, start_bits: bits })
}

/// A first position and velocity in the step's grids, of which they are multiples.
pub(super) fn in_grids(p: f64, v: f64, step: u8) -> (i32, i32) {
    (wrap(p / f64::from(position_grid(step))), wrap(v / f64::from(velocity_grid(step))))
}

fn near(x: f64, grid: f64) -> f64 {
    (x / grid).round() * grid
}

/// Rounds down; much quicker than the library's where the processor's own is not assumed.
#[inline]
fn floor(x: f64) -> i64 {
    let whole = x as i64;
    whole - i64::from(whole as f64 > x)
}

/// The decoder's integer: wrapped to 32 bits.
pub(super) fn wrap(x: f64) -> i32 {
    x as i64 as i32
}

impl<'t> Search<'t> {
    fn new(tube: &'t Tube, step: u8, effort: Effort) -> Self {
        let frames = tube.x.len();
        let of = |first| std::array::from_fn(|i| f64::from(number_step(first | i as u8, step)));
        let beam = Beam::new(frames, effort.beam, LONGEST).looking_ahead();
        Search {
            tube,
            price: SegmentPrice::new(tube),
            step,
            steps: Steps { w: of(0), k: of(segment::SLOPE) },
            costs: Costs::get(),
            effort,
            beam,
        }
    }

    fn run(&mut self) -> Option<Fitted> {
        self.begin();
        let tube = self.tube;
        let frames = tube.x.len();
        let usual = self.effort;
        let wider = Effort { beam: WIDER * usual.beam, margin: WIDER as f64 * usual.margin, ..usual };
        let (mut frame, mut wide_until) = (1, 0);
        // The last frame that nothing passed, and how often it was met.
        let (mut barrier, mut met) = (0, 0);
        loop {
            if self.beam.is_done() && frame > barrier {
                (barrier, met) = (frame, 0);
            }
            if self.beam.is_done() {
                frame = self.again(barrier, *BACK.get(met)?);
                wide_until = barrier + LONGEST;
                met += 1;
            }
            if frame >= frames - 1 {
                break;
            }
            self.work_at(frame, if frame < wide_until { wider } else { usual });
            frame += 1;
        }
        let (fitted, cost) = self.beam.backtrack(self.step)?;
        let bits = cost - self.tube.price(&fitted.path);
        Some(Fitted { bits, start_bits: self.tube.start.bits(&fitted.start), ..fitted })
    }

    /// Goes back from a frame that nothing passed. Returns where to go on.
    fn again(&mut self, barrier: usize, back: usize) -> usize {
        // A segment has LONGEST frames at most. Each way that was kept therefore has a hypothesis in a stretch of that length.
        let first = barrier.saturating_sub(back + LONGEST).max(1);
        self.beam.again(first, LONGEST);
        if first == 1 {
            self.begin();
        }
        first
    }

    /// Extends the best hypotheses of a frame.
    fn work_at(&mut self, frame: usize, effort: Effort) {
        self.effort = effort;
        if !effort.all_alike {
            self.beam.keep_best(KEPT * effort.beam);
        }
        let apart = effort.all_alike;
        let (position_cells, velocity_cells) =
            (4.0 / f64::from(step_size(self.step)), 1.0 / (0.03 * f64::from(step_size(self.step))));
        let cell = |at: &Hypothesis<f64>| (!apart).then(|| (floor(at.p * position_cells), floor(at.v * velocity_cells)));
        let limit = self.beam.limit(frame, effort.margin);
        self.price.begin(frame);
        let chosen = self.beam.choose(frame, limit, effort.beam, cell);
        let (start, end) = (chosen.start, chosen.end);
        for first in chosen.step_by(LANES) {
            self.extend::<false>(first..end.min(first + LANES));
        }
        // Behind a start, whose frame is the first, there is no acceleration to carry on.
        if frame > 1 {
            let end = end.min(start.saturating_add(effort.slopes));
            for first in (start..end).step_by(LANES) {
                self.extend::<true>(first..end.min(first + LANES));
            }
        }
    }

    /// Starts near the target, each with its velocity.
    fn begin(&mut self) {
        let tube = self.tube;
        let (pg, vg) = (f64::from(position_grid(self.step)), f64::from(velocity_grid(self.step)));
        let middle = (tube.x[0] / pg).round();
        for p in (-3..=3).map(|offset| (middle + f64::from(offset)) * pg) {
            if p < tube.lo[0] || p > tube.hi[0] {
                continue;
            }
            let toward = ((tube.x[1] - p) / vg).round();
            for v in (-6..=6).map(|offset| (toward + f64::from(offset)) * vg) {
                let next = p + v;
                if next < tube.lo[1] || next > tube.hi[1] {
                    continue;
                }
                let bits = self.tube.start.bits(&Start::Moving { p: wrap(p / pg), v: wrap(v / vg), step: self.step });
                let cost = bits + tube.price_at(0, p) + tube.price_at(1, next);
                self.beam.insert(Hypothesis::start(cost, p, v));
            }
        }
    }
}

/// Hypotheses that a frame keeps for each that is extended: a fifth of the time is saved against keeping all, at the same size.
const KEPT: usize = 3;
