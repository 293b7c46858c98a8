//! The core of both searches for a channel's segments: hypotheses frame by frame, of which the best are extended.
//!
//! A hypothesis at frame t stands where a segment starts that first changes the position at t + 1 (the player reads it at
//! t - 1). All of its numbers are the decoder's integers, held in f64, which is exact below 2^53; positions are not wrapped.

use super::search::{Fitted, in_grids};
use crate::encode::clip::Start;
use crate::encode::segment::Segment;
use pantin::codec::layout::START_MODE;
use std::ops::Range;

/// What a hypothesis has cost so far.
pub trait Cost: Copy {
    /// Ranks hypotheses at one frame: less is better.
    fn rank(&self) -> f64;
    /// Ranks whole codes at the last frame.
    fn total(&self) -> f64;
}

impl Cost for f64 {
    #[inline(always)]
    fn rank(&self) -> f64 {
        *self
    }

    #[inline(always)]
    fn total(&self) -> f64 {
        *self
    }
}

/// A place from which segments extend.
#[derive(Clone, Copy)]
pub struct Hypothesis<C> {
    pub cost: C,
    /// Position.
    pub p: f64,
    /// The difference from the frame before.
    pub v: f64,
    /// The second difference of the next frame, if the acceleration carries on.
    pub w: f64,
    /// Slope.
    pub k: f64,
    pub frame: u32,
    /// Index of the extended hypothesis before it.
    pub from: u32,
    /// The decoder's `prev_sign`.
    pub prev_sign: i8,
    pub mode: u8,
    /// The segment that leads here.
    pub segment: Segment,
}

impl<C> Hypothesis<C> {
    /// The hypothesis that a start leads to: position `p` at frame 0 and `p + v` at frame 1.
    pub fn start(cost: C, p: f64, v: f64) -> Self {
        let segment = Segment { mode: START_MODE, w: 0, k: 0 };
        Hypothesis { cost, p: p + v, v, w: 0.0, k: 0.0, frame: 1, from: u32::MAX, prev_sign: 0, mode: START_MODE, segment }
    }
}

/// Hypotheses of a frame are sorted this many times the beam's width at a time.
const SORTED: usize = 3;

/// From this many extended hypotheses on, those that nothing comes from any more are dropped: 10 minutes would take 80 MB.
const FORGET_AT: usize = 1 << 16;

/// The hypotheses of one search.
pub struct Beam<C> {
    /// Hypotheses by the frame they stand at. A frame that is done lends its place to a later one, as in the other lists by frame.
    heap: Vec<Vec<Hypothesis<C>>>,
    /// The frame whose hypotheses are next to be chosen from; those before are done.
    now: usize,
    last_frame: usize,
    /// Memory of frames that are done.
    spare: Vec<Vec<Hypothesis<C>>>,
    /// Those that were extended, to backtrack by.
    extended: Vec<Hypothesis<C>>,
    /// How many of them there may be before some are dropped.
    forget_at: usize,
    /// Least rank seen at each frame.
    least: Vec<f64>,
    /// Least rank seen at each frame or at a later one, where such hypotheses are compared.
    ahead: Option<Vec<f64>>,
    /// Hypotheses that a frame keeps once it has twice as many, the best ones; without it, all.
    kept: Option<usize>,
    /// The rank from which on each frame takes no more.
    full: Vec<f64>,
    ranked: Vec<(f64, usize)>,
}

impl<C: Cost> Beam<C> {
    /// No hypotheses yet, for a channel of this many frames. About `width` are extended at each, by at most `reach` frames.
    pub fn new(frames: usize, width: usize, reach: usize) -> Self {
        let extended = Vec::with_capacity((frames * width).min(FORGET_AT));
        // Lists of all frames of a long take would fall out of the cache.
        let places = frames.min(reach + 1).next_power_of_two();
        let ranks = || vec![f64::MAX; places];
        Beam {
            heap: vec![Vec::new(); places],
            now: 0,
            last_frame: frames - 1,
            spare: Vec::new(),
            extended,
            forget_at: FORGET_AT,
            least: ranks(),
            ahead: None,
            kept: None,
            full: ranks(),
            ranked: Vec::new(),
        }
    }

    /// The same, where a hypothesis is also compared with the best of all later frames. That one has more frames behind it, so a hypothesis that
    /// costs more will hardly lead to the best code.
    pub fn looking_ahead(self) -> Self {
        Beam { ahead: Some(self.least.clone()), ..self }
    }

    /// From now on, a frame keeps no more than the `kept` best hypotheses while others keep coming.
    pub fn keep_best(&mut self, kept: usize) {
        self.kept = Some(kept);
    }

    /// Whether no hypothesis waits: none reaches the last frame.
    pub fn is_done(&self) -> bool {
        self.heap.iter().all(Vec::is_empty)
    }

    /// Goes back: what was extended at the `count` frames from `first` on waits again, and nothing else.
    pub fn again(&mut self, first: usize, count: usize) {
        for ranks in [&mut self.least, &mut self.full].into_iter().chain(&mut self.ahead) {
            ranks.fill(f64::MAX);
        }
        self.heap.iter_mut().for_each(Vec::clear);
        self.now = first;
        for index in 0..self.extended.len() {
            let hypothesis = self.extended[index];
            if (first..first + count).contains(&(hypothesis.frame as usize)) {
                self.seen(hypothesis.frame as usize, hypothesis.cost.rank());
                self.insert(hypothesis);
            }
        }
    }

    /// Where the lists have a frame.
    #[inline]
    fn place(&self, frame: usize) -> usize {
        frame & (self.least.len() - 1)
    }

    /// Least rank seen at a frame that is not done.
    pub fn least(&self, frame: usize) -> f64 {
        self.least[self.place(frame)]
    }

    /// The greatest rank that [`Beam::offer`] takes at a frame.
    #[inline]
    pub fn limit(&self, frame: usize, margin: f64) -> f64 {
        let place = self.place(frame);
        let least = self.least[place];
        let limit = self.ahead.as_ref().map_or(least + margin, |ahead| (ahead[place] + margin).max(least));
        limit.min(self.full[place])
    }

    /// Notes a rank at a frame.
    #[inline]
    fn seen(&mut self, frame: usize, rank: f64) {
        let (place, places) = (self.place(frame), self.least.len() - 1);
        self.least[place] = self.least[place].min(rank);
        if let Some(ahead) = &mut self.ahead {
            for before in (self.now..=frame).rev() {
                let least = &mut ahead[before & places];
                if *least <= rank {
                    break;
                }
                *least = rank;
            }
        }
    }

    /// Adds a hypothesis, whatever it costs and without an effect on [`Beam::least`].
    #[inline]
    pub fn insert(&mut self, hypothesis: Hypothesis<C>) {
        let place = self.place(hypothesis.frame as usize);
        let here = &mut self.heap[place];
        if here.capacity() == 0
            && let Some(spare) = self.spare.pop()
        {
            *here = spare;
        }
        here.push(hypothesis);
    }

    /// Adds a hypothesis if it is within `margin` of the best at its frame.
    #[inline]
    pub fn offer(&mut self, hypothesis: Hypothesis<C>, margin: f64) {
        let (frame, rank) = (hypothesis.frame as usize, hypothesis.cost.rank());
        if rank <= self.limit(frame, margin) {
            self.seen(frame, rank);
            self.insert(hypothesis);
            let place = self.place(frame);
            let here = &mut self.heap[place];
            if let Some(kept) = self.kept.filter(|kept| here.len() >= 2 * kept) {
                let (_, last, _) = here.select_nth_unstable_by(kept - 1, |a, b| a.cost.rank().total_cmp(&b.cost.rank()));
                self.full[place] = last.cost.rank();
                here.truncate(kept);
            }
        }
    }

    /// Chooses up to `width` hypotheses of a frame to extend: the best within `limit`, and of those in one cell the best; those
    /// without a cell are all kept apart. Returns their indices for [`Beam::extended`], which hold until the next choice.
    pub fn choose<K: PartialEq>(
        &mut self,
        frame: usize,
        limit: f64,
        width: usize,
        cell: impl Fn(&Hypothesis<C>) -> Option<K>,
    ) -> Range<usize> {
        if self.extended.len() >= self.forget_at {
            self.forget();
        }
        let place = self.place(frame);
        let mut here = std::mem::take(&mut self.heap[place]);
        self.now = frame + 1;
        (self.least[place], self.full[place]) = (f64::MAX, f64::MAX);
        self.ahead.iter_mut().for_each(|ahead| ahead[place] = f64::MAX);
        let within = here.iter().enumerate().filter(|(_, hypothesis)| hypothesis.cost.rank() <= limit);
        self.ranked.clear();
        self.ranked.extend(within.map(|(index, hypothesis)| (hypothesis.cost.rank(), index)));
        let first = self.extended.len();
        let mut cells = Vec::with_capacity(width.min(here.len()));
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        let mut sorted = 0;
        for at in 0..self.ranked.len() {
            if self.extended.len() - first >= width {
                break;
            }
            if at == sorted {
                // As many as are likely needed: most are never looked at.
                let rest = &mut self.ranked[at..];
                sorted += rest.len().min(SORTED.saturating_mul(width));
                if sorted - at < rest.len() {
                    rest.select_nth_unstable_by(sorted - at, order);
                }
                self.ranked[at..sorted].sort_unstable_by(order);
            }
            let (_, index) = self.ranked[at];
            let cell = cell(&here[index]);
            if cell.is_none() || !cells.contains(&cell) {
                cells.push(cell);
                self.extended.push(here[index]);
            }
        }
        here.clear();
        self.spare.push(here);
        first..self.extended.len()
    }

    /// Drops the extended hypotheses that lead to none of those which wait.
    fn forget(&mut self) {
        let mut lives = vec![false; self.extended.len()];
        let mark = |lives: &mut [bool], from: u32| lives.get_mut(from as usize).into_iter().for_each(|live| *live = true);
        self.heap.iter().flatten().for_each(|hypothesis| mark(&mut lives, hypothesis.from));
        for index in (0..self.extended.len()).rev() {
            if lives[index] {
                mark(&mut lives, self.extended[index].from);
            }
        }
        let mut kept = 0;
        let place = |&live: &bool| {
            kept += u32::from(live);
            kept - u32::from(live)
        };
        let places: Vec<u32> = lives.iter().map(place).collect();
        let mut lives = lives.into_iter();
        self.extended.retain(|_| lives.next() == Some(true));
        let waiting = self.heap.iter_mut().flatten();
        for hypothesis in self.extended.iter_mut().chain(waiting) {
            if let Some(&place) = places.get(hypothesis.from as usize) {
                hypothesis.from = place;
            }
        }
        self.forget_at = FORGET_AT.max(2 * self.extended.len());
    }

    /// Keeps a hypothesis on the way to another, without a choice; its index for [`Beam::extended`].
    pub fn keep(&mut self, hypothesis: Hypothesis<C>) -> usize {
        self.extended.push(hypothesis);
        self.extended.len() - 1
    }

    /// A hypothesis that was chosen.
    pub fn extended(&self, index: usize) -> Hypothesis<C> {
        self.extended[index]
    }

    /// The code that ends cheapest at the last frame, and what it costs; `None` if no hypothesis reaches that frame. Its bits are
    /// for the caller to fill in.
    pub fn backtrack(&self, step: u8) -> Option<(Fitted, C)> {
        let end = self.heap[self.place(self.last_frame)].iter().min_by(|a, b| a.cost.total().total_cmp(&b.cost.total()))?;
        let mut chain = vec![*end];
        while let Some(before) = self.extended.get(chain[chain.len() - 1].from as usize) {
            chain.push(*before);
        }
        chain.reverse();
        let first = chain[0];
        let mut path = vec![first.p - first.v, first.p];
        for pair in chain.windows(2) {
            let (from, to) = (&pair[0], &pair[1]);
            let frames = to.frame - from.frame;
            let w = to.w - f64::from(frames) * to.k;
            path.extend((1..=frames).map(|m| {
                let n = f64::from(m);
                from.p + n * from.v + 0.5 * n * (n + 1.0) * w + n * (n * n - 1.0) / 6.0 * to.k
            }));
        }
        let (p, v) = in_grids(path[0], first.v, step);
        let segments = chain[1..].iter().map(|hypothesis| hypothesis.segment).collect();
        Some((Fitted { start: Start::Moving { p, v, step }, segments, path, bits: 0.0, start_bits: 0.0 }, end.cost))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAMES: u32 = 400;

    /// The cheapest of random chains, where hypotheses are dropped from `forget_at` on; and how many were held at the end.
    fn cheapest(forget_at: usize) -> (Vec<f64>, Vec<Segment>, usize) {
        let mut beam: Beam<f64> = Beam { forget_at, ..Beam::new(FRAMES as usize, 3, 9) };
        beam.insert(Hypothesis::start(0.0, 0.0, 0.0));
        let mut random = 1u32;
        for frame in 1..FRAMES - 1 {
            for id in beam.choose(frame as usize, f64::MAX, 3, |_| None::<u8>) {
                let from = beam.extended(id);
                for _ in 0..3 {
                    random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let (length, w) = (1 + (random >> 28) % 9, f64::from((random >> 20) & 15) - 7.0);
                    let n = f64::from(length.min(FRAMES - 1 - from.frame));
                    let segment = Segment { mode: (random >> 8) as u8 & 15, w: w as i32, k: 0 };
                    let (p, v) = (from.p + n * from.v + 0.5 * n * (n + 1.0) * w, from.v + n * w);
                    let (frame, cost) = (from.frame + n as u32, from.cost + n * f64::from((random >> 12) & 255));
                    beam.offer(Hypothesis { cost, p, v, w, k: 0.0, frame, from: id as u32, segment, ..from }, 1e4);
                }
            }
            beam.forget_at = forget_at;
        }
        let held = beam.extended.len();
        let (fitted, _) = beam.backtrack(0).unwrap();
        (fitted.path, fitted.segments, held)
    }

    #[test]
    fn what_is_dropped_leads_nowhere() {
        let (all, some) = (cheapest(usize::MAX), cheapest(64));
        assert!(all.2 > 1000 && some.2 < 300, "{} and {} held", all.2, some.2);
        assert_eq!((all.0, all.1), (some.0, some.1));
    }

    #[test]
    fn going_back_lets_wait_what_was_extended_there() {
        let mut beam = Beam::new(400, 3, 9);
        beam.insert(Hypothesis::start(0.0, 0.0, 0.0));
        for frame in 1..200 {
            for id in beam.choose(frame, f64::MAX, 3, |_| None::<u8>) {
                let from = beam.extended(id);
                for length in [2, 5] {
                    beam.offer(Hypothesis { cost: from.cost + 1.0, frame: from.frame + length, from: id as u32, ..from }, 1e4);
                }
            }
        }
        let extended: Vec<u32> = (0..beam.extended.len()).map(|index| beam.extended(index).frame).collect();
        let expected = |frame: u32| extended.iter().filter(|&&extended| extended == frame).count();
        beam.again(100, 9);
        let waiting = |frame: u32| beam.heap[beam.place(frame as usize)].iter().filter(|waits| waits.frame == frame).count();
        assert!((100..109).all(|frame| waiting(frame) == expected(frame) && expected(frame) > 0));
        assert_eq!(beam.heap.iter().map(Vec::len).sum::<usize>(), (100..109).map(expected).sum::<usize>());
        assert!((100..109).all(|frame| beam.least(frame) < f64::MAX) && beam.least(109) == f64::MAX);
        for frame in 100..109 {
            assert!(!beam.is_done());
            beam.choose(frame, f64::MAX, 3, |_| None::<u8>);
        }
        assert!(beam.is_done());
    }
}
