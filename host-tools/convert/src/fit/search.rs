//! Finds the cheapest W and K segments of one channel within a tube, by a beam search (`beam.rs`).

use super::beam::{Beam, Hypothesis};
use super::cost::Costs;
use super::segment_price::{self, LONGEST, Quadratic, SegmentPrice};
use super::start_cost::StartCosts;
use crate::encode::clip::{Start, position_grid, velocity_grid};
use crate::encode::segment::Segment;
use pantin::codec::layout::{LENGTHS, MAX_STEP, START_MODE, segment_type};
use pantin::codec::segment::{self, Context, step as number_step};
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
    /// Whether slopes are tried.
    pub slopes: bool,
    /// Whether hypotheses at nearly the same position and velocity are all kept (slow); otherwise the best of them is.
    pub all_alike: bool,
}

/// By how much one unit of v, of w and of a new number moves p after n frames, and the inverse of the last: for W, then for K.
#[derive(Clone, Copy)]
struct Weight {
    n: f64,
    c2: f64,
    c: f64,
    inverse: f64,
}

const WEIGHTS: [[Weight; LONGEST + 1]; 2] = [weights(false), weights(true)];

const fn weights(slope: bool) -> [Weight; LONGEST + 1] {
    let mut out = [Weight { n: 0.0, c2: 0.0, c: 0.0, inverse: 0.0 }; LONGEST + 1];
    let mut m = 1;
    while m <= LONGEST {
        let [_, n, c2, c3] = segment_price::WEIGHTS[m];
        let c = if slope { c3 } else { c2 };
        out[m] = Weight { n, c2, c, inverse: 1.0 / c };
        m += 1;
    }
    out
}

/// The greater of two numbers, neither of which is undefined: one instruction, unlike [`f64::max`].
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The lesser of two numbers, neither of which is undefined.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// What it is worth to spare a player the reading of a segment: 1 % more bytes for 7 % fewer segments, measured on eight clips.
pub const SEGMENT_BITS: f64 = 2.0;

/// Both steps of a mode's length for one channel.
struct Steps {
    w: [f64; 16],
    k: [f64; 16],
}

/// The channel's own numbers during one search.
struct Search<'t> {
    tube: &'t Tube,
    /// What frames behind the present one cost.
    price: SegmentPrice<'t>,
    step: u8,
    steps: Steps,
    costs: &'static Costs,
    effort: Effort,
    beam: Beam<f64>,
}

/// The cheapest code of a channel with this step, if any is found.
pub fn search(tube: &Tube, step: u8, effort: Effort) -> Option<Fitted> {
    let resting = constant(tube, step);
    if tube.x.len() < 3 {
        return resting.or_else(|| short(tube, step));
    }
    // Where every hypothesis that was kept has come to an end, others may not have.
    let wider = Effort { beam: WIDER * effort.beam, margin: WIDER as f64 * effort.margin, ..effort };
    let moving = Search::new(tube, step, effort).run().or_else(|| Search::new(tube, step, wider).run());
    match (resting, moving) {
        (Some(rest), Some(moving)) => {
            let better = rest.bits + tube.price(&rest.path) <= moving.bits + tube.price(&moving.path);
            Some(if better { rest } else { moving })
        }
        (rest, moving) => rest.or(moving),
    }
}

/// By how much wider a second search is than one that found nothing.
const WIDER: usize = 4;
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
fn wrap(x: f64) -> i32 {
    x as i64 as i32
}

impl<'t> Search<'t> {
    fn new(tube: &'t Tube, step: u8, effort: Effort) -> Self {
        let frames = tube.x.len();
        let of = |first| std::array::from_fn(|i| f64::from(number_step(first | i as u8, step)));
        let beam = Beam::new(frames, effort.beam);
        Search {
            tube,
            price: SegmentPrice::new(tube),
            step,
            steps: Steps { w: of(0), k: of(segment::SLOPE) },
            costs: Costs::get(),
            effort,
            beam: if effort.all_alike { beam } else { beam.keeping(KEPT * effort.beam) },
        }
    }

    fn run(mut self) -> Option<Fitted> {
        self.begin();
        let tube = self.tube;
        let frames = tube.x.len();
        let (position_cells, velocity_cells) =
            (4.0 / f64::from(step_size(self.step)), 1.0 / (0.03 * f64::from(step_size(self.step))));
        let apart = self.effort.all_alike;
        let cell = |at: &Hypothesis<f64>| (!apart).then(|| (floor(at.p * position_cells), floor(at.v * velocity_cells)));
        for frame in 1..frames - 1 {
            let least = &self.beam.least;
            let horizon = least[frame..frames.min(frame + 100)].iter().copied().fold(f64::MAX, f64::min);
            let limit = (horizon + self.effort.margin).max(least[frame]);
            self.price.begin(frame);
            for id in self.beam.choose(frame, limit, self.effort.beam, cell) {
                let hypothesis = self.beam.extended(id);
                self.extend::<false>(id, &hypothesis);
                if self.effort.slopes && hypothesis.mode != START_MODE {
                    self.extend::<true>(id, &hypothesis);
                }
            }
        }
        let (fitted, cost) = self.beam.backtrack(self.step)?;
        let bits = cost - self.tube.price(&fitted.path);
        Some(Fitted { bits, start_bits: self.tube.start.bits(&fitted.start), ..fitted })
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

    /// Adds all segments of type K, or W, that may follow the hypothesis `from`, whose index is `id`.
    fn extend<const SLOPE: bool>(&mut self, id: usize, from: &Hypothesis<f64>) {
        let tube = self.tube;
        let start = from.frame as usize;
        let rest = tube.x.len() - 1 - start;
        if SLOPE && from.w.abs() > tube.bend {
            return;
        }
        let mut reach =
            if SLOPE { Reach { least: f64::MIN, most: f64::MAX } } else { Reach { least: -tube.bend, most: tube.bend } };
        let mut passed = 0;
        for (index, &length) in LENGTHS.iter().enumerate() {
            let end = usize::from(length).min(rest);
            if end == passed {
                return;
            }
            let frames = start + passed + 1..start + end + 1;
            let (lo, hi) = (&tube.lo[frames.clone()], &tube.hi[frames]);
            let weights = &WEIGHTS[usize::from(SLOPE)][passed + 1..=end];
            if SLOPE && end == 1 {
                // A slope does not move the first frame.
                let base = from.p + from.v + from.w;
                if base < lo[0] || base > hi[0] {
                    return;
                }
            } else {
                reach.narrow::<SLOPE>(from, lo, hi, weights);
                if SLOPE && tube.bend < f64::INFINITY {
                    reach.bend(from.w, tube.bend, weights);
                }
            }
            if reach.least > reach.most {
                return;
            }
            passed = end;
            self.end::<SLOPE>(id, from, index, end, &reach);
        }
    }

    /// Adds the segments of length `index` that end after `frames`.
    #[inline(always)]
    fn end<const SLOPE: bool>(&mut self, id: usize, from: &Hypothesis<f64>, index: usize, frames: usize, reach: &Reach) {
        let kind = if SLOPE { segment_type::K } else { segment_type::W };
        let mode = kind << 4 | index as u8;
        let frame = from.frame as usize + frames;
        let mode_cost = from.cost + self.costs.mode(from.mode, mode) + SEGMENT_BITS;
        let limit = self.beam.limit(frame, self.effort.margin);
        if mode_cost > limit {
            return;
        }
        let unit = if SLOPE { self.steps.k[index] } else { self.steps.w[index] };
        // With the first frame alone, a slope is free within what an integer holds.
        let (ql, qh) = (-floor(lesser(-reach.least / unit, 1e9)), floor(lesser(reach.most / unit, 1e9)));
        if ql > qh {
            return;
        }
        let Quadratic { s0, s1, s2 } = self.price.of::<SLOPE>(index, from.p, from.v, from.w);
        let ideal = if s2 > 0.0 { -s1 / s2 } else { 0.0 };
        let now = wrap(if SLOPE { from.k } else { from.w });
        let which = index as u8 | if SLOPE { segment::SLOPE } else { 0 };
        let context = Context::new(which, now, if SLOPE { 0 } else { from.prev_sign }, unit as u32);
        if mode_cost + s0 + ideal * s1 + self.costs.least_number(context.index) > limit {
            return;
        }
        let prev_sign = if SLOPE { from.prev_sign } else { context.sign };
        let (ql, qh) = (ql as i32, qh as i32);
        let nearest = |x: f64| (floor(x.clamp(-1e9, 1e9) + 0.5) as i32).clamp(ql, qh);
        let best = if s2 > 0.0 { nearest(ideal / unit) } else { 0.clamp(ql, qh) };
        let carried = if SLOPE { 0 } else { nearest(from.w / unit) };
        let Weight { n, c2, c, .. } = WEIGHTS[usize::from(SLOPE)][frames];
        let base = from.p + n * from.v;
        let base = if SLOPE { base + c2 * from.w } else { base };
        for q in candidates(ql, qh, best, carried, s2 <= 0.0) {
            let number = if context.flip != 0 { -q } else { q };
            let g = f64::from(q) * unit;
            let cost = mode_cost + self.costs.number(context.index, number) + s0 + g * (2.0 * s1 + g * s2);
            if cost > limit {
                continue;
            }
            let coded = Segment { mode, w: if SLOPE { 0 } else { q }, k: if SLOPE { q } else { 0 } };
            let (w, k) = if SLOPE { (from.w, g) } else { (g, 0.0) };
            let reached = Hypothesis {
                cost,
                p: base + c * g,
                v: from.v + n * w + 0.5 * n * (n - 1.0) * k,
                w: w + n * k,
                k,
                frame: frame as u32,
                from: id as u32,
                prev_sign,
                mode,
                segment: coded,
            };
            self.beam.offer(reached, self.effort.margin);
        }
    }
}

/// What the tube leaves of a segment's number.
struct Reach {
    least: f64,
    most: f64,
}

/// Frames that are looked at together.
const LANES: usize = 4;

impl Reach {
    /// Leaves what keeps the hypothesis `from` within the tube at more frames.
    #[inline(always)]
    fn narrow<const SLOPE: bool>(&mut self, from: &Hypothesis<f64>, lo: &[f64], hi: &[f64], weights: &[Weight]) {
        let bounds = |lo: f64, hi: f64, weight: &Weight| {
            let base = from.p + weight.n * from.v;
            let base = if SLOPE { base + weight.c2 * from.w } else { base };
            ((lo - base) * weight.inverse, (hi - base) * weight.inverse)
        };
        if weights.len() < LANES {
            for ((&lo, &hi), weight) in lo.iter().zip(hi).zip(weights) {
                let (from, to) = bounds(lo, hi, weight);
                self.least = greater(self.least, from);
                self.most = lesser(self.most, to);
            }
            return;
        }
        let (los, his, all) = (lo.chunks_exact(LANES), hi.chunks_exact(LANES), weights.chunks_exact(LANES));
        let rest = los.remainder().iter().zip(his.remainder()).zip(all.remainder());
        let (mut least, mut most) = ([self.least; LANES], [self.most; LANES]);
        for ((lo, hi), weights) in los.zip(his).zip(all) {
            for lane in 0..LANES {
                let (from, to) = bounds(lo[lane], hi[lane], &weights[lane]);
                least[lane] = greater(least[lane], from);
                most[lane] = lesser(most[lane], to);
            }
        }
        for ((&lo, &hi), weight) in rest {
            let (from, to) = bounds(lo, hi, weight);
            least[0] = greater(least[0], from);
            most[0] = lesser(most[0], to);
        }
        self.least = least.into_iter().reduce(greater).unwrap_or(self.least);
        self.most = most.into_iter().reduce(lesser).unwrap_or(self.most);
    }

    /// Leaves slopes whose second difference stays within `bend`: at each frame it is the carried acceleration `w`, and n - 1 slopes.
    fn bend(&mut self, w: f64, bend: f64, weights: &[Weight]) {
        for weight in weights {
            self.least = greater(self.least, (-bend - w) / (weight.n - 1.0));
            self.most = lesser(self.most, (bend - w) / (weight.n - 1.0));
        }
    }
}

/// Hypotheses that a frame keeps for each that is extended: a fifth of the time is saved against keeping all, at the same size.
const KEPT: usize = 3;

/// So many numbers are all tried.
const ALL_OF: usize = 9;

/// Which of the numbers `least..=most` are tried: all of a few, else those that price and statistics favour.
fn candidates(least: i32, most: i32, best: i32, carried: i32, free: bool) -> impl Iterator<Item = i32> {
    let mut list = [0; ALL_OF];
    let mut len = 0;
    let mut put = |q: i32| {
        if (least..=most).contains(&q) && !list[..len].contains(&q) {
            list[len] = q;
            len += 1;
        }
    };
    if most - least < ALL_OF as i32 {
        (least..=most).for_each(&mut put);
    } else {
        [best, best - 1, best + 1, 0.clamp(least, most), carried, (best / 2).clamp(least, most)].into_iter().for_each(&mut put);
        if free {
            // No error has a price: numbers near 0 differ in bits alone.
            [best - 2, best + 2].into_iter().for_each(&mut put);
        }
    }
    list.into_iter().take(len)
}
