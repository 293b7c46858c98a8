//! One channel in a narrow tube: the cheapest chain of segments of all four types, by a beam search in the decoder's integers.
//!
//! Where a curve is known exactly, its acceleration and slope are both known: WK segments restart them, K and NONE segments
//! carry them on. The tube holds positions (METHOD 2.3 (b)) or accelerations ((a)). As in [`super::search`], a hypothesis at frame
//! t stands where a segment starts that first changes the position at t + 1; v is the difference from frame t - 1, and w the
//! second difference that t + 1 has if the acceleration carries on. Numbers are the decoder's integers, held in f64.

mod numbers;

pub use numbers::Held;

use super::cost::Costs;
use super::search::{Fitted, Tube, in_grids};
use crate::encode::clip::Start;
use crate::encode::segment::Segment;
use numbers::{LARGEST, Range, Room, Sums};
use pantin::codec::layout::{LENGTHS, START_MODE, segment_type};
use pantin::codec::segment::{Context, SLOPE, step as number_step};
use std::collections::HashSet;

/// A place from which segments go on.
#[derive(Clone, Copy)]
struct Hypothesis {
    bits: f64,
    /// Bits, the price of the errors so far, and what the error of the velocity will cost, about.
    rank: f64,
    price: f64,
    p: f64,
    v: f64,
    w: f64,
    k: f64,
    frame: u32,
    from: u32,
    turn: i8,
    mode: u8,
    segment: Segment,
}

/// Bits by which a hypothesis may be behind the best at its frame.
const MARGIN: f64 = 24.0;
/// Hypotheses nearer to each other than these parts of the tube's half width are one: in p, v and w.
const CELL: [f64; 3] = [0.25, 0.03, 0.01];
/// Slopes on either side of the best that a WK segment tries.
const SLOPES: i32 = 1;
/// Lengths in a row that WK may fail at before longer ones are given up.
const MISSES: u32 = 2;
/// What a channel's status and step cost, about.
const OPENING_BITS: f64 = 4.5;
/// What the tube leaves of the number of a W or a K segment, and whether it leaves NONE.
struct Ranges {
    w: Range,
    k: Range,
    none: Range,
}

impl Ranges {
    fn cut(&mut self, room: &Room, carried: f64) {
        let (w, k) = room.weights;
        self.w.cut(room.lo, room.hi, w);
        self.k.cut(room.lo - w * carried, room.hi - w * carried, k);
        self.none.cut(room.lo - w * carried, room.hi - w * carried, 0.0);
    }
}

struct Chains<'t> {
    tube: &'t Tube,
    held: Held,
    step: u8,
    costs: &'static Costs,
    /// The target's velocity at each frame: the difference from the one before.
    velocities: Vec<f64>,
    heap: Vec<Vec<Hypothesis>>,
    /// Least rank at each frame.
    least: Vec<f64>,
    gone_on: Vec<Hypothesis>,
}

/// The cheapest chain found with this step; the tube has at least 3 frames and a price at every one. `starts` lists a raw
/// position and velocity each, with their bits.
pub fn chain(tube: &Tube, held: Held, starts: &[(f64, f64, f64)], step: u8, beam: usize) -> Option<Fitted> {
    let frames = tube.x.len();
    let costs = Costs::get();
    let heap = vec![Vec::new(); frames];
    let velocities = velocities(tube, held, starts);
    let mut chains = Chains { tube, held, step, costs, velocities, heap, least: vec![f64::MAX; frames], gone_on: Vec::new() };
    for &(p, v, bits) in starts {
        chains.begin(p, v, bits);
    }
    for frame in 1..frames - 1 {
        let mut here = std::mem::take(&mut chains.heap[frame]);
        here.sort_unstable_by(|a, b| a.rank.total_cmp(&b.rank));
        let mut cells = HashSet::new();
        let limit = chains.least[frame] + MARGIN;
        for hypothesis in here.into_iter().take_while(|hypothesis| hypothesis.rank <= limit) {
            if cells.insert(chains.cell(&hypothesis)) {
                chains.gone_on.push(hypothesis);
                chains.go_on(&hypothesis);
                if cells.len() >= beam {
                    break;
                }
            }
        }
    }
    chains.way_back()
}

/// The target's velocities; those of accelerations begin as the first start does.
fn velocities(tube: &Tube, held: Held, starts: &[(f64, f64, f64)]) -> Vec<f64> {
    let mut v = starts.first().map_or(0.0, |start| start.1);
    let of = |t: usize| match held {
        Held::Positions if t == 0 => 0.0,
        Held::Positions => tube.x[t] - tube.x[t - 1],
        Held::Accelerations if t < 2 => v,
        Held::Accelerations => {
            v += tube.x[t];
            v
        }
    };
    (0..tube.x.len()).map(of).collect()
}

fn wrap(x: f64) -> i32 {
    x as i64 as i32
}

impl Chains<'_> {
    fn half_width(&self, frame: usize) -> f64 {
        0.5 * (self.tube.hi[frame] - self.tube.lo[frame])
    }

    fn cell(&self, state: &Hypothesis) -> [i64; 3] {
        let half = self.half_width(state.frame as usize);
        let part = |x: f64, part: f64| (x / (part * half)).floor() as i64;
        match self.held {
            Held::Positions => [part(state.p, CELL[0]), part(state.v, CELL[1]), part(state.w, CELL[2])],
            Held::Accelerations => [0, 0, part(state.w, CELL[1])],
        }
    }

    fn begin(&mut self, p: f64, v: f64, bits: f64) {
        let bits = bits + OPENING_BITS;
        let segment = Segment { mode: START_MODE, w: 0, k: 0 };
        let price = match self.held {
            Held::Positions => (0..2).map(|f| self.tube.a[f] * (p + f as f64 * v - self.tube.x[f]).powi(2)).sum(),
            Held::Accelerations => 0.0,
        };
        let (w, k, rank, frame, from, turn, mode) = (0.0, 0.0, 0.0, 1, u32::MAX, 0, START_MODE);
        self.push(Hypothesis { bits, rank, price, p: p + v, v, w, k, frame, from, turn, mode, segment });
    }

    fn push(&mut self, mut state: Hypothesis) {
        let t = state.frame as usize;
        state.rank = state.bits + state.price;
        let error = (state.v - self.velocities[t]).abs() / self.half_width(t);
        let (bits, ahead) = self.held.velocity_bits();
        state.rank += bits * (1.0 + ahead * error).log2();
        if state.rank <= self.least[t] + MARGIN {
            self.least[t] = self.least[t].min(state.rank);
            self.heap[t].push(state);
        }
    }

    fn room(&self, from: &Hypothesis, m: usize) -> Room {
        let at = from.frame as usize + m;
        let base = match self.held {
            Held::Positions => from.p + m as f64 * from.v,
            Held::Accelerations => 0.0,
        };
        let tube = self.tube;
        Room { lo: tube.lo[at] - base, hi: tube.hi[at] - base, x: tube.x[at] - base, weights: self.held.weights(m) }
    }

    /// All segments that may follow.
    fn go_on(&mut self, from: &Hypothesis) {
        let start = from.frame as usize;
        let rest = self.tube.x.len() - 1 - start;
        let mut ranges = Ranges { w: Range::ALL, k: Range::ALL, none: Range::ALL };
        let mut sums = Sums::default();
        let mut room = Vec::new();
        let mut misses = 0;
        for index in 0..LENGTHS.len() as u8 {
            let length = usize::from(LENGTHS[usize::from(index)]).min(rest);
            while room.len() < length {
                let next = self.room(from, room.len() + 1);
                ranges.cut(&next, from.w);
                sums.add(&next, self.tube.a[start + room.len() + 1]);
                room.push(next);
            }
            self.single(from, index, &sums, &ranges, length);
            if length > 1 && misses < MISSES {
                misses = if self.both(from, index, &sums, &room) { 0 } else { misses + 1 };
            }
            if length == rest || (ranges.w.is_empty() && ranges.k.is_empty() && misses == MISSES) {
                break;
            }
        }
    }

    /// W, and after a first segment K and NONE.
    fn single(&mut self, from: &Hypothesis, index: u8, sums: &Sums, ranges: &Ranges, length: usize) {
        for q in ranges.w.choices(self.unit(false, index), sums.best_w(0.0), from.w) {
            self.segment(from, segment_type::W << 4 | index, sums, length, (q, 0));
        }
        if from.mode == START_MODE {
            return;
        }
        for q in ranges.k.choices(self.unit(true, index), sums.best_k(from.w), from.k) {
            self.segment(from, segment_type::K << 4 | index, sums, length, (0, q));
        }
        if !ranges.none.is_empty() {
            self.segment(from, segment_type::NONE << 4 | index, sums, length, (0, 0));
        }
    }

    /// WK: slopes near the one that fits best, and for each the accelerations that stay in the tube. Whether there are any.
    fn both(&mut self, from: &Hypothesis, index: u8, sums: &Sums, room: &[Room]) -> bool {
        let (w_unit, k_unit) = (self.unit(false, index), self.unit(true, index));
        let near = (sums.slope() / k_unit).round();
        let mut found = false;
        for qk in (-SLOPES..=SLOPES).map(|offset| near + f64::from(offset)).filter(|qk| qk.abs() < LARGEST) {
            let slope = qk * k_unit;
            let mut range = Range::ALL;
            for room in room {
                let (w, k) = room.weights;
                range.cut(room.lo - k * slope, room.hi - k * slope, w);
            }
            for qw in range.choices(w_unit, sums.best_w(slope), from.w) {
                found = true;
                self.segment(from, segment_type::WK << 4 | index, sums, room.len(), (qw, qk as i32));
            }
        }
        found
    }

    fn unit(&self, slope: bool, mode: u8) -> f64 {
        f64::from(number_step(mode & 15 | if slope { SLOPE } else { 0 }, self.step))
    }

    fn number_bits(&self, context: Context, number: i32) -> f64 {
        self.costs.number(context.index, if context.flip != 0 { -number } else { number })
    }

    fn segment(&mut self, from: &Hypothesis, mode: u8, sums: &Sums, length: usize, (qw, qk): (i32, i32)) {
        if mode == START_MODE {
            return;
        }
        let kind = mode >> 4;
        let mut bits = from.bits + self.costs.mode(from.mode, mode);
        let (mut w, mut k, mut turn) = (from.w, 0.0, from.turn);
        let length_index = mode & 15;
        if kind == segment_type::W || kind == segment_type::WK {
            let unit = self.unit(false, mode);
            let context = Context::new(length_index, wrap(from.w), from.turn, unit as u32);
            bits += self.number_bits(context, qw);
            turn = context.sign;
            w = f64::from(qw) * unit;
        }
        if kind == segment_type::K || kind == segment_type::WK {
            let unit = self.unit(true, mode);
            bits += self.number_bits(Context::new(length_index | SLOPE, wrap(from.k), 0, unit as u32), qk);
            k = f64::from(qk) * unit;
        }
        let n = length as f64;
        let (w_moves, k_moves) = Held::Positions.weights(length);
        self.push(Hypothesis {
            bits,
            rank: 0.0,
            price: from.price + sums.price(w, k),
            p: from.p + n * from.v + w_moves * w + k_moves * k,
            v: from.v + n * w + 0.5 * n * (n - 1.0) * k,
            w: w + n * k,
            k,
            frame: from.frame + length as u32,
            from: self.gone_on.len() as u32 - 1,
            turn,
            mode,
            segment: Segment { mode, w: qw, k: qk },
        });
    }

    fn way_back(self) -> Option<Fitted> {
        let cost = |h: &Hypothesis| h.bits + h.price;
        let end = self.heap[self.tube.x.len() - 1].iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
        let mut chain = vec![*end];
        while let Some(before) = self.gone_on.get(chain[chain.len() - 1].from as usize) {
            chain.push(*before);
        }
        chain.reverse();
        let first = chain[0];
        let mut path = vec![first.p - first.v, first.p];
        for pair in chain.windows(2) {
            let (from, to) = (&pair[0], &pair[1]);
            let n = (to.frame - from.frame) as usize;
            let w = to.w - n as f64 * to.k;
            path.extend((1..=n).map(|m| {
                let (w_moves, k_moves) = Held::Positions.weights(m);
                from.p + m as f64 * from.v + w_moves * w + k_moves * to.k
            }));
        }
        let (p, v) = in_grids(path[0], first.v, self.step);
        let start = Start::Moving { p, v, step: self.step };
        Some(Fitted { start, segments: chain[1..].iter().map(|h| h.segment).collect(), path, bits: end.bits })
    }
}
