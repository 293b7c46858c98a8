//! Extends the hypotheses of one frame by W and K segments of all lengths, several hypotheses side by side.

use super::beam::Hypothesis;
use super::search::{SEGMENT_BITS, Search, wrap};
use super::segment_price::{self, LANES, LONGEST, Lanes, Quadratics};
use crate::encode::segment::Segment;
use pantin::codec::layout::{LENGTHS, segment_type};
use pantin::codec::segment::{self, Context};
use std::ops::Range;

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

/// Numbers of segments are looked for within this size.
const LARGEST: f64 = 1e9;

/// Rounds a number whose size is below 2^51, by two instructions: beside 1.5 * 2^52 a double has no bits for fractions.
#[inline(always)]
fn whole(x: f64) -> f64 {
    const NO_FRACTIONS: f64 = 1.5 * (1u64 << 52) as f64;
    (x + NO_FRACTIONS) - NO_FRACTIONS
}

/// Rounds down a number whose size is below 2^51.
#[inline(always)]
fn floor(x: f64) -> f64 {
    let whole = whole(x);
    whole - if whole > x { 1.0 } else { 0.0 }
}

#[inline(always)]
fn within(x: f64, least: f64, most: f64) -> f64 {
    lesser(greater(x, least), most)
}

/// Up to [`LANES`] hypotheses of a frame. Lanes without one have no room in their [`Reach`].
struct Group {
    count: usize,
    from: [Hypothesis<f64>; LANES],
    cost: Lanes,
    p: Lanes,
    v: Lanes,
    w: Lanes,
}

impl Group {
    fn of(search: &Search<'_>, ids: Range<usize>) -> Group {
        let count = ids.len();
        let from: [Hypothesis<f64>; LANES] = std::array::from_fn(|lane| search.beam.extended(ids.start + lane.min(count - 1)));
        let of = |number: fn(&Hypothesis<f64>) -> f64| std::array::from_fn(|lane| number(&from[lane]));
        Group { count, cost: of(|from| from.cost), p: of(|from| from.p), v: of(|from| from.v), w: of(|from| from.w), from }
    }
}

/// What the tube leaves of the number of each hypothesis' segment.
struct Reach {
    least: Lanes,
    most: Lanes,
}

impl Reach {
    fn new<const SLOPE: bool>(group: &Group, bend: f64) -> Reach {
        let widest = if SLOPE { f64::MAX } else { bend };
        let mut reach = Reach { least: [-widest; LANES], most: [widest; LANES] };
        for lane in 0..LANES {
            if lane >= group.count || (SLOPE && group.w[lane].abs() > bend) {
                reach.close(lane);
            }
        }
        reach
    }

    fn close(&mut self, lane: usize) {
        (self.least[lane], self.most[lane]) = (f64::MAX, f64::MIN);
    }

    #[inline(always)]
    fn is_closed(&self) -> bool {
        (0..LANES).all(|lane| self.least[lane] > self.most[lane])
    }

    /// Leaves what keeps each hypothesis within the tube at more frames.
    #[inline(always)]
    fn narrow<const SLOPE: bool>(&mut self, group: &Group, lo: &[f64], hi: &[f64], weights: &[Weight]) {
        for ((&lo, &hi), weight) in lo.iter().zip(hi).zip(weights) {
            for lane in 0..LANES {
                let base = group.p[lane] + weight.n * group.v[lane];
                let base = if SLOPE { base + weight.c2 * group.w[lane] } else { base };
                self.least[lane] = greater(self.least[lane], (lo - base) * weight.inverse);
                self.most[lane] = lesser(self.most[lane], (hi - base) * weight.inverse);
            }
        }
    }

    /// A slope does not move the first frame: only hypotheses that are within the tube there have slopes.
    fn first_of_slope(&mut self, group: &Group, lo: f64, hi: f64) {
        for lane in 0..LANES {
            let base = group.p[lane] + group.v[lane] + group.w[lane];
            if base < lo || base > hi {
                self.close(lane);
            }
        }
    }

    /// Leaves slopes whose second difference stays within `bend`: at each frame it is the carried acceleration, and n - 1 slopes.
    fn bend(&mut self, group: &Group, bend: f64, weights: &[Weight]) {
        for weight in weights {
            for lane in 0..LANES {
                self.least[lane] = greater(self.least[lane], (-bend - group.w[lane]) / (weight.n - 1.0));
                self.most[lane] = lesser(self.most[lane], (bend - group.w[lane]) / (weight.n - 1.0));
            }
        }
    }
}

/// The numbers, in multiples of a mode's step, that each hypothesis may take for a segment, and the best of them by the price of errors alone.
struct Numbers {
    least: Lanes,
    most: Lanes,
    best: Lanes,
    /// What the segment costs at least.
    cost: Lanes,
}

impl Numbers {
    #[inline(always)]
    fn of(reach: &Reach, price: &Quadratics, mode_cost: &Lanes, unit: f64, least_number: f64) -> Numbers {
        let inverse = 1.0 / unit;
        let ideal = if price.s2 > 0.0 { -inverse / price.s2 } else { 0.0 };
        let mut numbers = Numbers { least: [0.0; LANES], most: [0.0; LANES], best: [0.0; LANES], cost: [0.0; LANES] };
        for (lane, mode_cost) in mode_cost.iter().enumerate() {
            // With the first frame alone, a slope is free within what an integer holds.
            let least = -floor(within(-reach.least[lane] * inverse, -LARGEST, LARGEST));
            let most = floor(within(reach.most[lane] * inverse, -LARGEST, LARGEST));
            let best = within(whole(within(price.s1[lane] * ideal, -LARGEST, LARGEST)), least, most);
            let g = best * unit;
            (numbers.least[lane], numbers.most[lane], numbers.best[lane]) = (least, most, best);
            numbers.cost[lane] = mode_cost + least_number + price.s0[lane] + g * (2.0 * price.s1[lane] + g * price.s2);
        }
        numbers
    }
}

/// One kind of segment that some hypotheses may end with.
struct Ending {
    /// Index of its length.
    index: usize,
    /// Its frames, fewer than the length's at the clip's end.
    frames: usize,
    mode: u8,
    /// The step of its number.
    unit: f64,
    /// The greatest rank where it ends.
    limit: f64,
}

impl Search<'_> {
    /// Adds all segments of type K, or W, that may follow the hypotheses of these indices, which all stand at one frame.
    pub(super) fn extend<const SLOPE: bool>(&mut self, ids: Range<usize>) {
        let group = Group::of(self, ids.clone());
        let tube = self.tube;
        let start = group.from[0].frame as usize;
        let rest = tube.x.len() - 1 - start;
        let mut reach = Reach::new::<SLOPE>(&group, tube.bend);
        let mut passed = 0;
        for (index, &length) in LENGTHS.iter().enumerate() {
            let end = usize::from(length).min(rest);
            if end == passed {
                return;
            }
            let frames = start + passed + 1..start + end + 1;
            let (lo, hi) = (&tube.lo[frames.clone()], &tube.hi[frames]);
            if SLOPE && end == 1 {
                reach.first_of_slope(&group, lo[0], hi[0]);
            } else {
                let weights = &WEIGHTS[usize::from(SLOPE)][passed + 1..=end];
                reach.narrow::<SLOPE>(&group, lo, hi, weights);
                if SLOPE && tube.bend < f64::INFINITY {
                    reach.bend(&group, tube.bend, weights);
                }
            }
            if reach.is_closed() {
                return;
            }
            passed = end;
            self.end::<SLOPE>(ids.start, &group, index, end, &reach);
        }
    }

    /// Adds the segments of length `index` that end after `frames`.
    #[inline(always)]
    fn end<const SLOPE: bool>(&mut self, first: usize, group: &Group, index: usize, frames: usize, reach: &Reach) {
        let kind = if SLOPE { segment_type::K } else { segment_type::W };
        let mode = kind << 4 | index as u8;
        let unit = if SLOPE { self.steps.k[index] } else { self.steps.w[index] };
        let frame = group.from[0].frame as usize + frames;
        let ending = Ending { index, frames, mode, unit, limit: self.beam.limit(frame, self.effort.margin) };
        let bits = |lane: usize| self.costs.mode(group.from[lane].mode, mode) + SEGMENT_BITS;
        let mode_cost: Lanes = std::array::from_fn(|lane| group.cost[lane] + bits(lane));
        if mode_cost.iter().all(|&cost| cost > ending.limit) {
            return;
        }
        let price = self.price.of::<SLOPE>(index, [&group.p, &group.v, &group.w]);
        let numbers = Numbers::of(reach, &price, &mode_cost, unit, self.costs.least_number(SLOPE, index));
        for (lane, mode_cost) in mode_cost.into_iter().enumerate() {
            let possible = numbers.least[lane] <= numbers.most[lane] && mode_cost <= ending.limit;
            if possible && numbers.cost[lane] <= ending.limit {
                let range = [numbers.least[lane] as i32, numbers.most[lane] as i32, numbers.best[lane] as i32];
                let price = [mode_cost + price.s0[lane], price.s1[lane], price.s2];
                self.offer::<SLOPE>((first + lane, &group.from[lane]), &ending, range, price);
            }
        }
    }

    /// Offers one hypothesis' segments, whose numbers are in the range `least..=most`; `best` has the lowest price.
    #[inline(always)]
    fn offer<const SLOPE: bool>(
        &mut self,
        (id, from): (usize, &Hypothesis<f64>),
        ending: &Ending,
        [least, most, best]: [i32; 3],
        [s0, s1, s2]: [f64; 3],
    ) {
        let &Ending { index, frames, mode, unit, limit } = ending;
        let now = wrap(if SLOPE { from.k } else { from.w });
        let which = index as u8 | if SLOPE { segment::SLOPE } else { 0 };
        let context = Context::new(which, now, if SLOPE { 0 } else { from.prev_sign }, unit as u32);
        let prev_sign = if SLOPE { from.prev_sign } else { context.sign };
        let carried = if SLOPE { 0 } else { whole(within(from.w / unit, f64::from(least), f64::from(most))) as i32 };
        let Weight { n, c2, c, .. } = WEIGHTS[usize::from(SLOPE)][frames];
        let base = from.p + n * from.v;
        let base = if SLOPE { base + c2 * from.w } else { base };
        for q in candidates(least, most, best, carried, s2 <= 0.0) {
            let number = if context.flip != 0 { -q } else { q };
            let g = f64::from(q) * unit;
            let cost = self.costs.number(context.index, number) + s0 + g * (2.0 * s1 + g * s2);
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
                frame: from.frame + frames as u32,
                from: id as u32,
                prev_sign,
                mode,
                segment: coded,
            };
            self.beam.offer(reached, self.effort.margin);
        }
    }
}

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

/// The least cost of a number for a segment of each length, whatever number came before.
pub(super) fn least_of_contexts(slope: bool, index: usize, least: &[f32]) -> f32 {
    const UNIT: u32 = 4;
    let which = index as u8 | if slope { segment::SLOPE } else { 0 };
    let sizes = [0, 1, 2, 3].map(|size| size * UNIT as i32);
    let numbers = sizes.into_iter().flat_map(|size| [-size, size]);
    let contexts = numbers.flat_map(|now| [-1, 0, 1].map(|prev_sign| Context::new(which, now, prev_sign, UNIT)));
    contexts.map(|context| least[usize::from(context.index)]).fold(f32::MAX, f32::min)
}
