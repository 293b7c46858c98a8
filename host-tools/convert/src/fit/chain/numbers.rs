//! The numbers of one segment: what the tube leaves of w and k, and what they cost.

/// What a tube bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constraint {
    /// Positions at every frame.
    Positions,
    /// Second differences at frames 2 and later, `p(n) + p(n-2) - 2 p(n-1)`.
    Accelerations,
}

impl Constraint {
    /// By how much one of w and one of k change what is bounded `m` frames after a segment's start.
    pub(super) fn weights(self, m: usize) -> (f64, f64) {
        let m = m as f64;
        match self {
            Constraint::Positions => (0.5 * m * (m + 1.0), m * (m * m - 1.0) / 6.0),
            Constraint::Accelerations => (1.0, m - 1.0),
        }
    }

    /// An error of the velocity of e half widths ranks a hypothesis lower by a log2(1 + b e) bits, for these a and b: where positions
    /// are bounded, it costs as much later; where accelerations are, positions drift less for a few per cent more bits.
    pub(super) fn velocity_bits(self) -> (f64, f64) {
        match self {
            Constraint::Positions => (2.0, 20.0),
            Constraint::Accelerations => (6.0, 1.0),
        }
    }
}

/// No number of a segment is larger.
pub(super) const LARGEST: f64 = 1e9;

/// Least and greatest value of a number.
#[derive(Clone, Copy)]
pub(super) struct Range {
    least: f64,
    most: f64,
}

impl Range {
    pub(super) const ALL: Range = Range { least: f64::MIN, most: f64::MAX };

    /// Leaves those g for which `lo <= c g <= hi`.
    pub(super) fn cut(&mut self, lo: f64, hi: f64, c: f64) {
        if c > 0.0 {
            self.least = self.least.max(lo / c);
            self.most = self.most.min(hi / c);
        } else if lo > 0.0 || hi < 0.0 {
            self.most = f64::NEG_INFINITY;
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.least > self.most
    }

    /// Multiples of `unit` worth a try: all of a few, else near `best`, nearest to 0, and near `carried`.
    pub(super) fn choices(&self, unit: f64, best: f64, carried: f64) -> Vec<i32> {
        let least = (self.least / unit).ceil().max(-LARGEST);
        let most = (self.most / unit).floor().min(LARGEST);
        if least > most {
            return Vec::new();
        }
        if most - least < 5.0 {
            return (least as i32..=most as i32).collect();
        }
        let near = |x: f64| (x / unit).round().clamp(least, most) as i32;
        let best = near(best);
        let mut list = vec![best, best - 1, best + 1, near(0.0), near(carried)];
        list.retain(|&q| (least..=most).contains(&f64::from(q)));
        list.sort_unstable();
        list.dedup();
        list
    }
}

/// What is left of the tube, frame by frame after a segment's start, once velocity alone has gone on.
#[derive(Clone, Copy)]
pub(super) struct Room {
    pub(super) lo: f64,
    pub(super) hi: f64,
    pub(super) x: f64,
    pub(super) weights: (f64, f64),
}

/// The price of the frames so far is `xx - 2 (wx w + kx k) + ww w^2 + 2 wk w k + kk k^2`.
#[derive(Clone, Copy, Default)]
pub(super) struct Sums {
    xx: f64,
    wx: f64,
    kx: f64,
    ww: f64,
    wk: f64,
    kk: f64,
}

impl Sums {
    pub(super) fn add(&mut self, room: &Room, a: f64) {
        let (w, k) = room.weights;
        self.xx += a * room.x * room.x;
        self.wx += a * w * room.x;
        self.kx += a * k * room.x;
        self.ww += a * w * w;
        self.wk += a * w * k;
        self.kk += a * k * k;
    }

    pub(super) fn price(&self, w: f64, k: f64) -> f64 {
        self.xx - 2.0 * (self.wx * w + self.kx * k) + w * (self.ww * w + 2.0 * self.wk * k) + self.kk * k * k
    }

    pub(super) fn best_w(&self, k: f64) -> f64 {
        (self.wx - self.wk * k) / self.ww
    }

    pub(super) fn best_k(&self, w: f64) -> f64 {
        if self.kk > 0.0 { (self.kx - self.wk * w) / self.kk } else { 0.0 }
    }

    /// The slope of the best w and k together.
    pub(super) fn slope(&self) -> f64 {
        let det = self.ww * self.kk - self.wk * self.wk;
        if det > 0.0 { (self.ww * self.kx - self.wk * self.wx) / det } else { 0.0 }
    }
}
