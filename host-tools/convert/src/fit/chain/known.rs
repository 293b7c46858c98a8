//! Codes a curve whose second difference is linear between known frames, its keys: one slope a key, and where it begins one acceleration.
//!
//! What a slope's rounding leaves of position, velocity and acceleration is made up for by later slopes: a hypothesis is ranked by the
//! error that the best real slopes would still leave, whose squares are a quadratic form of its state's error (a linear-quadratic
//! regulator, solved from the last key to the first).

use super::super::beam::Beam;
use super::super::cost::Costs;
use super::super::search::{Fitted, Tube};
use super::{Cost, Hypothesis, OPENING_BITS, wrap};
use crate::encode::segment::Segment;
use pantin::codec::layout::{LENGTHS, segment_type};
use pantin::codec::segment::{Context, SLOPE, step as number_step};

/// Hypotheses that are extended at a key.
const WIDTH: usize = 240;
/// Bits by which one may be behind the best.
const MARGIN: f64 = 40.0;
/// Numbers on either side of the best that are tried.
const AROUND: i32 = 3;
/// What an error as large as the bound over the frames to the next key costs, in bits.
const ERROR_BITS: f64 = 6.0;
/// Hypotheses nearer to each other than these parts of the bound are one: in p, and in what v and w move p by until the next key.
const CELL: f64 = 0.1;

type Vector = [f64; 4];

/// Frames from one key to the next, and what errors cost there.
struct Span {
    /// Where it begins: the frame that a segment read there first moves is the next one.
    frame: usize,
    /// Lengths of its segments, the one with the numbers first.
    parts: Vec<u8>,
    /// Frames.
    length: usize,
    /// The target's slope.
    slope: f64,
    /// The squares of all errors from here on, in bounds, for the error of (p, v, w, slope).
    form: [Vector; 4],
}

/// How the error of (p, v, w, slope) goes on for `m` frames.
fn carried(m: usize) -> [Vector; 3] {
    let n = m as f64;
    [[1.0, n, n * (n + 1.0) / 2.0, n * (n * n - 1.0) / 6.0], [0.0, 1.0, n, n * (n - 1.0) / 2.0], [0.0, 0.0, 1.0, n]]
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Span {
    /// The best slope's error for an error of (p, v, w), and the squares of all errors that it leaves.
    fn best(&self, error: [f64; 3]) -> (f64, f64) {
        let [p, v, w] = error;
        let known = [p, v, w, 0.0];
        let cross = dot(&self.form[3], &known);
        let slope = if self.form[3][3] > 0.0 { -cross / self.form[3][3] } else { 0.0 };
        let whole = [p, v, w, slope];
        (slope, self.form.iter().zip(&whole).map(|(row, x)| x * dot(row, &whole)).sum())
    }
}

/// The lengths whose sum is `frames`, as few as possible and the longest first.
fn parts(mut frames: usize) -> Vec<u8> {
    let mut parts = Vec::new();
    while frames > 0 {
        let index = LENGTHS.iter().rposition(|&length| usize::from(length) <= frames).unwrap_or(0);
        parts.push(index as u8);
        frames -= usize::from(LENGTHS[index]);
    }
    parts
}

fn spans(tube: &Tube, keys: &[usize], bound: f64) -> Vec<Span> {
    let last = tube.x.len() - 1;
    let bend = |t: usize| tube.x[t + 1] + tube.x[t - 1] - 2.0 * tube.x[t];
    let mut frames: Vec<usize> = keys.iter().copied().filter(|&key| key > 1 && key < last).collect();
    frames.insert(0, 1);
    frames.push(last);
    let of = |pair: &[usize]| {
        let (from, to) = (pair[0], pair[1]);
        let end = to.min(last - 1);
        let slope = if end > from { (bend(end) - bend(from)) / (end - from) as f64 } else { 0.0 };
        // What is read past the end costs nothing.
        let mut parts = parts(to - from);
        if to == last {
            let whole = LENGTHS.iter().position(|&length| usize::from(length) >= to - from);
            parts = whole.map_or(parts, |index| vec![index as u8]);
        }
        Span { frame: from, parts, length: to - from, slope, form: [[0.0; 4]; 4] }
    };
    let mut spans: Vec<Span> = frames.windows(2).filter(|pair| pair[0] < pair[1]).map(of).collect();
    // From the last key to the first: the squares of the errors until the next key, and what they leave for later.
    let mut later: Option<[Vector; 4]> = None;
    for span in spans.iter_mut().rev() {
        let mut form = [[0.0; 4]; 4];
        let mut add = |a: &Vector, b: &Vector, weight: f64| {
            (0..4).for_each(|i| (0..4).for_each(|j| form[i][j] += weight * a[i] * b[j]));
        };
        for m in 1..=span.length {
            let [p, ..] = carried(m);
            add(&p, &p, 1.0 / (bound * bound));
        }
        if let Some(later) = &later {
            let rows = carried(span.length);
            // The best slope there is for the errors that arrive.
            let best = |i: usize| if later[3][3] > 0.0 { later[3][i] / later[3][3] } else { 0.0 };
            for i in 0..3 {
                for j in 0..3 {
                    add(&rows[i], &rows[j], later[i][j] - best(i) * later[3][j]);
                }
            }
        }
        span.form = form;
        later = Some(form);
    }
    spans
}

struct Known<'t> {
    tube: &'t Tube,
    step: u8,
    costs: &'static Costs,
    beam: Beam<Cost>,
}

/// The cheapest code found with this step; the tube has at least 3 frames. `starts` as for [`super::chain`].
pub fn known(tube: &Tube, keys: &[usize], starts: &[(f64, f64, f64)], step: u8) -> Option<Fitted> {
    let bound = 0.5 * (tube.hi[0] - tube.lo[0]);
    let spans = spans(tube, keys, bound);
    let mut known = Known { tube, step, costs: Costs::get(), beam: Beam::new(tube.x.len(), WIDTH, tube.x.len()) };
    for &(p, v, bits) in starts {
        let bits = bits + OPENING_BITS;
        let start = Hypothesis::start(Cost { bits, price: 0.0, rank: bits }, p, v);
        known.beam.insert(start);
    }
    for (place, span) in spans.iter().enumerate() {
        let next = spans.get(place + 1);
        let least = known.beam.least(span.frame);
        let limit = if place == 0 { f64::MAX } else { least + MARGIN };
        let length = span.length as f64;
        let cell = |at: &Hypothesis| {
            let part = |x: f64| (x / (CELL * bound)).floor() as i64;
            Some([part(at.p), part(at.v * length), part(at.w * length * length)])
        };
        let width = if place == 0 { usize::MAX } else { WIDTH };
        for id in known.beam.choose(span.frame, limit, width, cell) {
            known.extend(id, span, next);
        }
    }
    let (fitted, cost) = known.beam.backtrack(step)?;
    Some(Fitted { bits: cost.bits, ..fitted })
}

impl Known<'_> {
    fn error(&self, at: &Hypothesis) -> [f64; 3] {
        let x = &self.tube.x;
        let t = at.frame as usize;
        let bend = x.get(t + 1).map_or(at.w, |next| next + x[t - 1] - 2.0 * x[t]);
        [at.p - x[t], at.v - (x[t] - x[t - 1]), at.w - bend]
    }

    fn unit(&self, which: u8) -> f64 {
        f64::from(number_step(which, self.step))
    }

    fn extend(&mut self, id: usize, span: &Span, next: Option<&Span>) {
        let from = self.beam.extended(id);
        let index = span.parts[0];
        let (w_unit, k_unit) = (self.unit(index), self.unit(index | SLOPE));
        let first = from.from == u32::MAX;
        let near = |x: f64, unit: f64| {
            let best = (x / unit).round();
            (-AROUND..=AROUND).map(move |offset| best as i32 + offset)
        };
        if first {
            let [p, v, w] = self.error(&from);
            let bend = from.w - w;
            for w in near(bend, w_unit) {
                let slope = span.slope + span.best([p, v, f64::from(w) * w_unit - bend]).0;
                for k in near(slope, k_unit) {
                    self.segment(id, &from, span, next, (w, k), true);
                }
            }
        } else {
            let slope = span.slope + span.best(self.error(&from)).0;
            for k in near(slope, k_unit) {
                self.segment(id, &from, span, next, (0, k), false);
            }
        }
    }

    fn number_bits(&self, context: Context, number: i32) -> f64 {
        self.costs.number(context.index, if context.flip != 0 { -number } else { number })
    }

    fn segment(&mut self, id: usize, from: &Hypothesis, span: &Span, next: Option<&Span>, (qw, qk): (i32, i32), both: bool) {
        let index = span.parts[0];
        let (mut w, mut prev_sign) = (from.w, from.prev_sign);
        let mode = index | if both { segment_type::WK } else { segment_type::K } << 4;
        let mut bits = from.cost.bits + self.costs.mode(from.mode, mode);
        if both {
            let unit = self.unit(index);
            let context = Context::new(index, wrap(from.w), from.prev_sign, unit as u32);
            bits += self.number_bits(context, qw);
            prev_sign = context.sign;
            w = f64::from(qw) * unit;
        }
        let unit = self.unit(index | SLOPE);
        bits += self.number_bits(Context::new(index | SLOPE, wrap(from.k), 0, unit as u32), qk);
        let k = f64::from(qk) * unit;
        let at = |m: usize| {
            let [p, v, ww] = carried(m).map(|row| dot(&row, &[from.p, from.v, w, k]));
            (p, v, ww)
        };
        let inside = |m: usize| {
            let frame = from.frame as usize + m;
            (self.tube.lo[frame]..=self.tube.hi[frame]).contains(&at(m).0)
        };
        if !(1..=span.length).all(inside) {
            return;
        }
        let (mut before, mut done, mut mode, mut segment) = (id, 0, mode, Segment { mode, w: qw, k: qk });
        for (place, &part) in span.parts.iter().enumerate() {
            if place > 0 {
                let (p, v, w) = at(done);
                let frame = from.frame + done as u32;
                let cost = Cost { bits, price: 0.0, rank: bits };
                before = self.beam.keep(Hypothesis { cost, p, v, w, k, frame, from: before as u32, prev_sign, mode, segment });
                let carry = part | segment_type::CARRY << 4;
                bits += self.costs.mode(mode, carry);
                (mode, segment) = (carry, Segment { mode: carry, w: 0, k: 0 });
            }
            done = (done + usize::from(LENGTHS[usize::from(part)])).min(span.length);
        }
        let (p, v, w) = at(span.length);
        let frame = from.frame + span.length as u32;
        let mut reached = Hypothesis {
            cost: Cost { bits, price: 0.0, rank: bits },
            p,
            v,
            w,
            k,
            frame,
            from: before as u32,
            prev_sign,
            mode,
            segment,
        };
        if let Some(next) = next {
            let (_, squares) = next.best(self.error(&reached));
            reached.cost.rank += ERROR_BITS * squares / next.length as f64;
        }
        self.beam.offer(reached, MARGIN);
    }
}
