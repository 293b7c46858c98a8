//! The price of a segment's frames, for every hypothesis that may begin at one frame: sums over the frames that do not depend on the hypothesis.

use super::search::Tube;
use pantin::codec::layout::LENGTHS;

/// Frames of the longest segment.
pub const LONGEST: usize = LENGTHS[15] as usize;

/// How p moves after n frames, for one unit each of p, v, w and k: 1, n, C(n + 1, 2), C(n + 1, 3).
pub const WEIGHTS: [[f64; 4]; LONGEST + 1] = weights();

const fn weights() -> [[f64; 4]; LONGEST + 1] {
    let mut out = [[0.0; 4]; LONGEST + 1];
    let mut m = 0;
    while m <= LONGEST {
        let n = m as f64;
        let c2 = n * (n + 1.0) * 0.5;
        out[m] = [1.0, n, c2, c2 * (n - 1.0) / 3.0];
        m += 1;
    }
    out
}

/// The price of frames at `p + n v + c2 w + c3 k`, as a quadratic form: positions are relative to that of the target at the first frame, where
/// sums of squares stay exact enough.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// The sums of a times two weights each: pp, pv, pw, pk, vv, vw, vk, ww, wk, kk.
    squares: [f64; 10],
    /// The sums of b - a x times a weight each.
    lines: [f64; 4],
    constant: f64,
}

/// The sums from one frame on, to the end of each length that was asked for.
pub struct SegmentPrice<'t> {
    tube: &'t Tube,
    start: usize,
    origin: f64,
    by_length: [Sums; LENGTHS.len()],
    /// Lengths that have their sums, and the frames of the longest of them.
    summed: usize,
    passed: usize,
}

/// Hypotheses that are priced side by side.
pub const LANES: usize = 4;

/// One number of each hypothesis.
pub type Lanes = [f64; LANES];

/// What a segment costs each hypothesis for a number g, its w or k: s0 + 2 g s1 + g^2 s2.
#[derive(Clone, Copy)]
pub struct Quadratics {
    pub s0: Lanes,
    pub s1: Lanes,
    pub s2: f64,
}

impl<'t> SegmentPrice<'t> {
    /// Prices of the tube's frames behind its first one.
    pub fn new(tube: &'t Tube) -> Self {
        SegmentPrice { tube, start: 0, origin: 0.0, by_length: Default::default(), summed: 0, passed: 0 }
    }

    /// Goes to the frames behind `start`.
    pub fn begin(&mut self, start: usize) {
        (self.start, self.origin, self.summed, self.passed) = (start, self.tube.x[start], 0, 0);
    }

    /// Sums on to the end of a length: where the tube is narrow, few lengths are asked for.
    fn sum_to(&mut self, index: usize) {
        let rest = self.tube.x.len() - 1 - self.start;
        while self.summed <= index {
            let end = usize::from(LENGTHS[self.summed]).min(rest);
            let mut sums = if self.summed == 0 { Sums::default() } else { self.by_length[self.summed - 1] };
            let frames = self.start + self.passed + 1..self.start + end + 1;
            let tube = self.tube.x[frames.clone()].iter().zip(&self.tube.a[frames.clone()]).zip(&self.tube.b[frames]);
            for (((&x, &a), &b), weight) in tube.zip(&WEIGHTS[self.passed + 1..=end]) {
                let x = x - self.origin;
                let [_, v, w, k] = *weight;
                let (av, aw, ak) = (a * v, a * w, a * k);
                let line = b - a * x;
                let squares = [a, av, aw, ak, av * v, av * w, av * k, aw * w, aw * k, ak * k];
                sums.squares.iter_mut().zip(squares).for_each(|(sum, square)| *sum += square);
                sums.lines.iter_mut().zip(weight).for_each(|(sum, weight)| *sum += line * weight);
                sums.constant += x * (a * x - 2.0 * b);
            }
            self.by_length[self.summed] = sums;
            (self.summed, self.passed) = (self.summed + 1, end);
        }
    }

    /// The price of segments of this length that begin at positions p and velocities v: with a new w, or with a new k while w carries on.
    #[inline(always)]
    pub fn of<const SLOPE: bool>(&mut self, index: usize, [p, v, w]: [&Lanes; 3]) -> Quadratics {
        self.sum_to(index);
        let Sums { squares: [pp, pv, pw, pk, vv, vw, vk, ww, wk, kk], lines: [lp, lv, lw, lk], constant } = self.by_length[index];
        let (mut s0, mut s1) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let (p, v, w) = (p[lane] - self.origin, v[lane], w[lane]);
            let carried = p * (pp * p + 2.0 * (pv * v + lp)) + v * (vv * v + 2.0 * lv) + constant;
            if SLOPE {
                s0[lane] = carried + w * (ww * w + 2.0 * (pw * p + vw * v + lw));
                s1[lane] = pk * p + vk * v + wk * w + lk;
            } else {
                s0[lane] = carried;
                s1[lane] = pw * p + vw * v + lw;
            }
        }
        Quadratics { s0, s1, s2: if SLOPE { kk } else { ww } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_price_a_segment_as_its_frames_do() {
        let wave = |scale: f64, speed: f64| (0..150).map(|t| scale * (1.1 + (speed * f64::from(t)).sin())).collect::<Vec<f64>>();
        let tube = Tube { x: wave(1e9, 0.1), a: wave(1e-13, 0.7), b: wave(1e-6, 0.3), ..Tube::default() };
        let mut price = SegmentPrice::new(&tube);
        for start in [0, 40, 120] {
            price.begin(start);
            let (p, v, w) = (tube.x[start] + 3e5, 4e7, -2e5);
            let lanes = [&[0.0, p, 0.0, 0.0], &[0.0, v, 0.0, 0.0], &[0.0, w, 0.0, 0.0]];
            for (index, &length) in LENGTHS.iter().enumerate() {
                for (slope, g) in [(false, 3e5), (true, -1e4)] {
                    let (of, w, k) =
                        if slope { (price.of::<true>(index, lanes), w, g) } else { (price.of::<false>(index, lanes), g, 0.0) };
                    let mut sum = 0.0;
                    let frames = usize::from(length).min(149 - start);
                    for (frame, [_, n, c2, c3]) in (start + 1..).zip(&WEIGHTS[1..=frames]) {
                        let e = p + n * v + c2 * w + c3 * k - tube.x[frame];
                        sum += e * (tube.a[frame] * e + 2.0 * tube.b[frame]);
                    }
                    let priced = of.s0[1] + g * (2.0 * of.s1[1] + g * of.s2);
                    assert!((priced - sum).abs() <= 1e-9 * (1.0 + sum.abs()), "{start}, {length} frames: {priced}, not {sum}");
                }
            }
        }
    }
}
