//! Finds the cheapest segments of all four types for one channel in a narrow tube, by a beam search (`beam.rs`).
//!
//! Where a curve is known exactly, its acceleration and slope are both known: WK segments restart them, K and CARRY segments
//! carry them on. The tube bounds positions (METHOD 2.3 (b)) or accelerations ((a)).

mod known;
mod numbers;

pub use known::known;
pub use numbers::Constraint;

use super::beam::{self, Beam};
use super::cost::Costs;
use super::search::{Fitted, Tube};
use super::segment_price::LONGEST;
use crate::encode::segment::Segment;
use numbers::{LARGEST, Range, Room, Sums};
use pantin::codec::layout::{LENGTHS, START_MODE, segment_type};
use pantin::codec::segment::{Context, SLOPE, step as number_step};

type Hypothesis = beam::Hypothesis<Cost>;

#[derive(Clone, Copy, Default)]
struct Cost {
    bits: f64,
    /// Of the errors so far.
    price: f64,
    /// Bits, price, and about what the error of the velocity will cost.
    rank: f64,
}

impl beam::Cost for Cost {
    fn rank(&self) -> f64 {
        self.rank
    }

    fn total(&self) -> f64 {
        self.bits + self.price
    }
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
/// What the tube leaves of the number of a W or a K segment, and whether it leaves CARRY.
struct Ranges {
    w: Range,
    k: Range,
    carry: Range,
}

impl Ranges {
    fn cut(&mut self, room: &Room, carried: f64, slope: f64) {
        let (w, k) = room.weights;
        self.w.cut(room.lo, room.hi, w);
        self.k.cut(room.lo - w * carried, room.hi - w * carried, k);
        let carry = w * carried + k * slope;
        self.carry.cut(room.lo - carry, room.hi - carry, 0.0);
    }
}

struct Chains<'t> {
    tube: &'t Tube,
    constraint: Constraint,
    step: u8,
    costs: &'static Costs,
    /// The target's velocity at each frame: the difference from the one before.
    velocities: Vec<f64>,
    beam: Beam<Cost>,
}

/// The cheapest chain found with this step; the tube has at least 3 frames and a price at every one. `starts` lists a raw
/// position and velocity each, with their bits.
pub fn chain(tube: &Tube, constraint: Constraint, starts: &[(f64, f64, f64)], step: u8, width: usize) -> Option<Fitted> {
    let frames = tube.x.len();
    let velocities = velocities(tube, constraint, starts);
    let mut chains = Chains { tube, constraint, step, costs: Costs::get(), velocities, beam: Beam::new(frames, width, LONGEST) };
    for &(p, v, bits) in starts {
        chains.begin(p, v, bits);
    }
    for frame in 1..frames - 1 {
        let half = chains.half_width(frame);
        let limit = chains.beam.least(frame) + MARGIN;
        for id in chains.beam.choose(frame, limit, width, |at| Some(cell(constraint, half, at))) {
            let hypothesis = chains.beam.extended(id);
            chains.extend(id, &hypothesis);
        }
    }
    let (fitted, cost) = chains.beam.backtrack(step)?;
    Some(Fitted { bits: cost.bits, ..fitted })
}

/// Hypotheses in one cell are as good as equal.
fn cell(constraint: Constraint, half_width: f64, at: &Hypothesis) -> [i64; 3] {
    let part = |x: f64, part: f64| (x / (part * half_width)).floor() as i64;
    match constraint {
        Constraint::Positions => [part(at.p, CELL[0]), part(at.v, CELL[1]), part(at.w, CELL[2])],
        Constraint::Accelerations => [0, 0, part(at.w, CELL[1])],
    }
}

/// The target's velocities; those of accelerations begin as the first start does.
fn velocities(tube: &Tube, constraint: Constraint, starts: &[(f64, f64, f64)]) -> Vec<f64> {
    let mut v = starts.first().map_or(0.0, |start| start.1);
    let of = |t: usize| match constraint {
        Constraint::Positions if t == 0 => 0.0,
        Constraint::Positions => tube.x[t] - tube.x[t - 1],
        Constraint::Accelerations if t < 2 => v,
        Constraint::Accelerations => {
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

    fn begin(&mut self, p: f64, v: f64, bits: f64) {
        let bits = bits + OPENING_BITS;
        let price = match self.constraint {
            Constraint::Positions => (0..2).map(|f| self.tube.a[f] * (p + f as f64 * v - self.tube.x[f]).powi(2)).sum(),
            Constraint::Accelerations => 0.0,
        };
        self.push(Hypothesis::start(Cost { bits, price, rank: 0.0 }, p, v));
    }

    fn push(&mut self, mut state: Hypothesis) {
        let t = state.frame as usize;
        let error = (state.v - self.velocities[t]).abs() / self.half_width(t);
        let (bits, ahead) = self.constraint.velocity_bits();
        state.cost.rank = state.cost.bits + state.cost.price;
        state.cost.rank += bits * (1.0 + ahead * error).log2();
        self.beam.offer(state, MARGIN);
    }

    fn room(&self, from: &Hypothesis, m: usize) -> Room {
        let at = from.frame as usize + m;
        let base = match self.constraint {
            Constraint::Positions => from.p + m as f64 * from.v,
            Constraint::Accelerations => 0.0,
        };
        let tube = self.tube;
        Room { lo: tube.lo[at] - base, hi: tube.hi[at] - base, x: tube.x[at] - base, weights: self.constraint.weights(m) }
    }

    /// Adds all segments that may follow the hypothesis `from`, whose index is `id`.
    fn extend(&mut self, id: usize, from: &Hypothesis) {
        let start = from.frame as usize;
        let rest = self.tube.x.len() - 1 - start;
        let mut ranges = Ranges { w: Range::ALL, k: Range::ALL, carry: Range::ALL };
        let mut sums = Sums::default();
        let mut room = Vec::new();
        let mut misses = 0;
        for index in 0..LENGTHS.len() as u8 {
            let length = usize::from(LENGTHS[usize::from(index)]).min(rest);
            while room.len() < length {
                let next = self.room(from, room.len() + 1);
                ranges.cut(&next, from.w, from.k);
                sums.add(&next, self.tube.a[start + room.len() + 1]);
                room.push(next);
            }
            self.single(id, from, index, &sums, &ranges, length);
            if length > 1 && misses < MISSES {
                misses = if self.both(id, from, index, &sums, &room) { 0 } else { misses + 1 };
            }
            if length == rest || (ranges.w.is_empty() && ranges.k.is_empty() && ranges.carry.is_empty() && misses == MISSES) {
                break;
            }
        }
    }

    /// W, and after a first segment K and CARRY.
    fn single(&mut self, id: usize, from: &Hypothesis, index: u8, sums: &Sums, ranges: &Ranges, length: usize) {
        for q in ranges.w.choices(self.unit(false, index), sums.best_w(0.0), from.w) {
            self.segment(id, from, segment_type::W << 4 | index, sums, length, (q, 0));
        }
        if from.mode == START_MODE {
            return;
        }
        for q in ranges.k.choices(self.unit(true, index), sums.best_k(from.w), from.k) {
            self.segment(id, from, segment_type::K << 4 | index, sums, length, (0, q));
        }
        if !ranges.carry.is_empty() {
            self.segment(id, from, segment_type::CARRY << 4 | index, sums, length, (0, 0));
        }
    }

    /// WK: slopes near the one that fits best, and for each the accelerations that stay in the tube. Whether there are any.
    fn both(&mut self, id: usize, from: &Hypothesis, index: u8, sums: &Sums, room: &[Room]) -> bool {
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
                self.segment(id, from, segment_type::WK << 4 | index, sums, room.len(), (qw, qk as i32));
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

    #[allow(clippy::too_many_arguments)]
    fn segment(&mut self, id: usize, from: &Hypothesis, mode: u8, sums: &Sums, length: usize, (qw, qk): (i32, i32)) {
        if mode == START_MODE {
            return;
        }
        let kind = mode >> 4;
        let mut bits = from.cost.bits + self.costs.mode(from.mode, mode);
        let carries = kind == segment_type::CARRY;
        let (mut w, mut k, mut prev_sign) = (from.w, if carries { from.k } else { 0.0 }, from.prev_sign);
        let length_index = mode & 15;
        if kind == segment_type::W || kind == segment_type::WK {
            let unit = self.unit(false, mode);
            let context = Context::new(length_index, wrap(from.w), from.prev_sign, unit as u32);
            bits += self.number_bits(context, qw);
            prev_sign = context.sign;
            w = f64::from(qw) * unit;
        }
        if kind == segment_type::K || kind == segment_type::WK {
            let unit = self.unit(true, mode);
            bits += self.number_bits(Context::new(length_index | SLOPE, wrap(from.k), 0, unit as u32), qk);
            k = f64::from(qk) * unit;
        }
        let n = length as f64;
        let (w_moves, k_moves) = Constraint::Positions.weights(length);
        let price = from.cost.price + sums.price(w, k);
        self.push(Hypothesis {
            cost: Cost { bits, price, rank: 0.0 },
            p: from.p + n * from.v + w_moves * w + k_moves * k,
            v: from.v + n * w + 0.5 * n * (n - 1.0) * k,
            w: w + n * k,
            k,
            frame: from.frame + length as u32,
            from: id as u32,
            prev_sign,
            mode,
            segment: Segment { mode, w: qw, k: qk },
        });
    }
}
