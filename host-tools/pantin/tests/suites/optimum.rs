//! The search against brute force: on tubes of 12 frames, every segmentation into W and K segments with every number that matters.

use crate::noise::Noise;
use pantin::codec::layout::{LENGTHS, START_MODE, segment_type};
use pantin_convert::Level;
use pantin_convert::encode::clip::{Start, position_grid, velocity_grid};
use pantin_convert::encode::entropy::{Alphabet, Sink, cost};
use pantin_convert::encode::segment::{Running, Segment};
use pantin_convert::fit::search::{Effort, Fitted, SEGMENT_BITS, Tube, search};
use pantin_convert::pose_bound::PoseBound;

const FRAMES: usize = 12;
const STEP: u8 = 40;
/// Largest number that is tried. Were a larger one best, the search would be found cheaper.
const LARGEST: i32 = 40;
const CASES: u64 = 60;
/// The search holds costs as f32.
const ROUNDING: f64 = 1e-3;

/// Counts bits instead of writing them.
#[derive(Default)]
struct Bits(f64);

impl Sink for Bits {
    fn symbol(&mut self, alphabet: Alphabet, symbol: u32) {
        self.0 += cost(alphabet.table(), symbol);
    }

    fn bits(&mut self, _: u32, count: u32) {
        self.0 += f64::from(count);
    }
}

/// A curve whose acceleration wanders, and a tube around it about as wide as a channel step; errors are free or cost up to a bit.
fn tube(case: u64, frames: usize) -> Tube {
    let mut noise = Noise(case.wrapping_mul(977) + 1);
    let size = f64::from(pantin::codec::step_size(STEP));
    let (mut p, mut v, mut w) = (20.0 * noise.signed(), 2.0 * noise.signed(), 0.5 * noise.signed());
    let mut x = Vec::new();
    for _ in 0..frames {
        x.push(p * size);
        p += v;
        v += w;
        w = 0.8 * w + 0.4 * noise.signed();
    }
    let half = size * (0.55 + 0.25 * noise.signed());
    let price = [0.0, 0.1, 0.3, 1.0][case as usize % 4];
    let lo = x.iter().map(|x| x - half).collect();
    let hi = x.iter().map(|x| x + half).collect();
    Tube {
        x,
        lo,
        hi,
        a: vec![price / (half * half); frames],
        b: vec![0.0; frames],
        bend: f64::INFINITY,
        start: Default::default(),
    }
}

/// All codes from a state on; a branch ends where it costs more than the best so far.
struct Brute<'t> {
    tube: &'t Tube,
    best: f64,
}

impl Brute<'_> {
    fn inside(&self, frame: usize, p: i32) -> bool {
        (self.tube.lo[frame]..=self.tube.hi[frame]).contains(&f64::from(p))
    }

    fn price(&self, frame: usize, p: i32) -> f64 {
        self.tube.a[frame] * (f64::from(p) - self.tube.x[frame]).powi(2)
    }

    fn all(&mut self) {
        let (pg, vg) = (position_grid(STEP), velocity_grid(STEP));
        let at = |x: f64, grid: i32| (x / f64::from(grid)).round() as i32;
        for p in (-8..=8).map(|i| (at(self.tube.x[0], pg) + i) * pg) {
            for v in (-16..=16).map(|i| (at(self.tube.x[1] - f64::from(p), vg) + i) * vg) {
                if !self.inside(0, p) || !self.inside(1, p + v) {
                    continue;
                }
                // Status and step cost what the search takes for them.
                let mut bits = Bits(4.5);
                bits.magnitude(Alphabet::Position, p / pg);
                bits.magnitude(Alphabet::Velocity, v / vg);
                let running = Running { v, w: 0, k: 0, turn: 0, mode: START_MODE, step: STEP };
                self.on(running, p, 0, bits.0 + self.price(0, p) + self.price(1, p + v));
            }
        }
    }

    /// Plays on from `frame`, at which a segment is read; `cost` has the price of the frame after it in it.
    fn on(&mut self, running: Running, p: i32, frame: usize, cost: f64) {
        if cost >= self.best {
            return;
        }
        if frame + 2 >= FRAMES {
            self.best = cost;
            return;
        }
        let rest = FRAMES - 2 - frame;
        for index in 0..LENGTHS.len() as u8 {
            for kind in [segment_type::W, segment_type::K] {
                for q in -LARGEST..=LARGEST {
                    let (w, k) = if kind == segment_type::W { (q, 0) } else { (0, q) };
                    self.segment(running, p, frame, cost, Segment { mode: kind << 4 | index, w, k });
                }
            }
            if usize::from(LENGTHS[usize::from(index)]) >= rest {
                return;
            }
        }
    }

    fn segment(&mut self, mut running: Running, mut p: i32, frame: usize, mut cost: f64, segment: Segment) {
        if running.mode == START_MODE && segment.kind() == segment_type::K {
            return;
        }
        let mut bits = Bits::default();
        running.put_mode(segment.mode, &mut bits);
        running.start(segment, Some(&mut bits));
        cost += bits.0 + SEGMENT_BITS;
        let end = (frame + segment.length()).min(FRAMES - 2);
        for now in frame..end {
            p += running.v;
            running.run(1);
            let next = p + running.v;
            if !self.inside(now + 2, next) {
                return;
            }
            cost += self.price(now + 2, next);
        }
        self.on(running, p, end, cost);
    }
}

fn objective(found: &Fitted, tube: &Tube) -> f64 {
    found.bits + tube.price(&found.path)
}

#[test]
fn a_wide_search_finds_the_optimum() {
    let wide = Effort { beam: 1 << 20, margin: 24.0, slopes: usize::MAX, all_alike: true };
    let mut moving = 0;
    for case in 0..CASES {
        let tube = tube(case, FRAMES);
        let found = search(&tube, STEP, wide).unwrap();
        // Brute force knows no constants.
        if !matches!(found.start, Start::Moving { .. }) {
            continue;
        }
        moving += 1;
        let mut brute = Brute { tube: &tube, best: f64::MAX };
        brute.all();
        let cost = objective(&found, &tube);
        assert!((cost - brute.best).abs() <= ROUNDING, "case {case}: {cost} bits, brute force {}", brute.best);
    }
    assert!(moving * 10 >= CASES * 9, "{moving} of {CASES} move");
}

#[test]
fn default_comes_near_best() {
    let [default, best] = [Level::DEFAULT, Level::BEST].map(|level| level.plan(PoseBound::places(1.0)).effort);
    for frames in [FRAMES, 120] {
        let (mut differ, mut default_bits, mut best_bits) = (0, 0.0, 0.0);
        for case in 0..CASES {
            let tube = tube(case, frames);
            let [d, b] = [default, best].map(|effort| objective(&search(&tube, STEP, effort).unwrap(), &tube));
            differ += u64::from((d - b).abs() > ROUNDING);
            default_bits += d;
            best_bits += b;
        }
        let more = 100.0 * (default_bits / best_bits - 1.0);
        println!("{frames} frames: default differs from best in {differ} of {CASES}, {more:.3} % more bits");
        assert!(more < 2.0);
    }
}
