//! What predicts a channel's keys: the key before, the channel half a cycle before, or an earlier channel.

use super::coder::Coder;
use super::grid::Grid;
use pantin::codec::keys::{MAX_LENGTH, context};

/// A channel that was coded.
#[derive(Clone, Debug)]
pub struct Coded {
    pub grid: usize,
    pub class: usize,
    pub values: Vec<i32>,
}

/// What predicts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    Before,
    Half {
        exact: bool,
    },
    /// How many channels with keys back, and how many frames later.
    Leader {
        back: u32,
        shift: u32,
    },
}

/// How keys are predicted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Predictor {
    pub source: Source,
    pub sign: i32,
}

/// A channel that is coded.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    pub grid: &'a Grid,
    pub class: usize,
    pub values: &'a [i32],
    /// The value at rest in thousandths.
    pub rest: i32,
    pub closed: bool,
}

/// A quotient, rounded to the nearest; halves away from zero.
pub fn divided(value: i32, by: i32) -> i32 {
    let size = (i64::from(value).abs() + i64::from(by / 2)) / i64::from(by);
    (if value < 0 { -size } else { size }) as i32
}

/// The value that a leader has at its own key of a frame; `None` if it has none there.
fn led(leader: &Coded, grid: &Grid, frame: u32, end: u32, looped: bool) -> Option<i32> {
    let (frame, drift) =
        if looped && frame >= end { (frame - end, leader.values[grid.last()] - leader.values[0]) } else { (frame, 0) };
    grid.times.binary_search(&frame).ok().map(|key| leader.values[key] + drift)
}

/// All channels with keys before the one that is coded.
#[derive(Clone, Copy)]
pub struct Earlier<'a> {
    pub coded: &'a [Coded],
    pub grids: &'a [Grid],
    pub looped: bool,
}

impl Earlier<'_> {
    /// For each key its prediction by anything but the key before, in the channel's quanta; `None` if a leader lacks a key.
    fn predictions(&self, task: &Task<'_>, predictor: &Predictor, unit: i32) -> Option<Vec<Option<i32>>> {
        let Task { grid, values, .. } = *task;
        let (last, end) = (grid.last(), grid.times[grid.last()]);
        let of = |key: usize| match predictor.source {
            Source::Before => Some(None),
            Source::Half { .. } if key >= last / 2 && key < last => {
                Some(Some(predictor.sign * divided(values[key - last / 2], unit)))
            }
            Source::Half { .. } => Some(None),
            Source::Leader { back, shift } => {
                let leader = &self.coded[self.coded.len() - back as usize];
                let led = led(leader, &self.grids[leader.grid], grid.times[key] + shift, end, self.looped)?;
                Some(Some(predictor.sign * divided(led, unit)))
            }
        };
        let known = last + usize::from(!task.closed);
        (0..known).map(of).collect()
    }

    /// The residuals, and whether each is against another prediction than the key before; `None` if the predictor cannot be.
    fn residuals(&self, task: &Task<'_>, predictor: &Predictor, unit: i32) -> Option<Vec<(i32, bool)>> {
        let predictions = self.predictions(task, predictor, unit)?;
        let mut before = divided(task.rest, unit);
        let mut offset = 0;
        let mut residuals = Vec::with_capacity(predictions.len());
        for (key, prediction) in predictions.into_iter().enumerate() {
            let value = task.values[key] / unit;
            let residual = value - prediction.map_or(before, |predicted| predicted + offset);
            if key == 0 && prediction.is_some() {
                offset = residual;
            }
            residuals.push((residual, prediction.is_some()));
            before = value;
        }
        let exact = predictor.source == Source::Half { exact: true };
        let fits = residuals.iter().all(|&(residual, other)| {
            residual.unsigned_abs().checked_ilog2().is_none_or(|log| log < MAX_LENGTH) && !(exact && other && residual != 0)
        });
        fits.then_some(residuals)
    }

    /// Codes how the keys are predicted, and their residuals. False, with nothing coded, if that cannot be.
    pub fn put(&self, coder: &mut Coder, task: &Task<'_>, predictor: &Predictor, unit: i32, distance: &mut u32) -> bool {
        let Some(residuals) = self.residuals(task, predictor, unit) else { return false };
        self.put_predictor(coder, task, predictor, distance);
        let exact = predictor.source == Source::Half { exact: true };
        let mut before = [None; 2];
        for (residual, other) in residuals {
            if !(exact && other) {
                let length = &mut before[usize::from(other)];
                *length = Some(coder.residual(other, *length, residual));
            }
        }
        true
    }

    fn put_predictor(&self, coder: &mut Coder, task: &Task<'_>, predictor: &Predictor, distance: &mut u32) {
        let half = matches!(predictor.source, Source::Half { .. });
        if task.grid.half {
            coder.bit(context::BY_HALF, half);
        }
        if !half {
            let leader = matches!(predictor.source, Source::Leader { .. });
            if !self.coded.is_empty() {
                coder.bit(context::BY_LEADER + task.class, leader);
            }
            if !leader {
                return;
            }
        }
        if let Source::Leader { back, .. } = predictor.source {
            coder.bit(context::SAME_DISTANCE, back == *distance);
            if back != *distance {
                coder.gamma(context::DISTANCE, back - 1);
                *distance = back;
            }
        }
        coder.bit(context::SIGN + usize::from(!half), predictor.sign < 0);
        match predictor.source {
            Source::Half { exact } => coder.bit(context::EXACT, exact),
            Source::Leader { shift, .. } if self.looped && task.grid.times[task.grid.last()].is_multiple_of(2) => {
                coder.bit(context::SHIFT, shift != 0);
            }
            _ => {}
        }
    }

    /// What can predict a channel, the key before first.
    pub fn candidates(&self, task: &Task<'_>) -> Vec<Predictor> {
        let mut out = vec![Predictor { source: Source::Before, sign: 1 }];
        if task.grid.half {
            let sources = [true, false].map(|exact| Source::Half { exact });
            out.extend(sources.into_iter().flat_map(|source| [1, -1].map(|sign| Predictor { source, sign })));
        }
        let end = task.grid.times[task.grid.last()];
        let shifts = if self.looped && end.is_multiple_of(2) { vec![0, end / 2] } else { vec![0] };
        for (back, coded) in (1..=MOST_BACK).zip(self.coded.iter().rev()) {
            if coded.class == task.class {
                let sources = shifts.iter().map(|&shift| Source::Leader { back, shift });
                out.extend(sources.flat_map(|source| [1, -1].map(|sign| Predictor { source, sign })));
            }
        }
        out
    }
}

/// Channels with keys that are tried as leaders.
const MOST_BACK: u32 = 256;
