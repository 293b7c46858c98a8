//! Motions of scalars alone: a rig without joints, and rows put on an even grid of frames.

use crate::memory::Memory;
use crate::motion::{Motion, Rig, Scalar};
use anyhow::{Result, ensure};
use pantin::codec::layout::MAX_CHANNELS;

/// Rows are put no farther on a grid: [`check_size`] refuses it long before.
const FARTHEST: usize = 1 << 30;
/// No full scale is smaller: of channels that never leave 0, nor of such as a clip's raw values could not tell from it.
pub const LEAST_SCALE: f64 = 1e-6;

/// A motion of `names`, each with its full scale by the rule of its format and its value at every frame. A channel that goes beyond its
/// full scale gets a larger one: nothing is clipped.
pub fn motion(names: Vec<String>, scales: &[f64], values: Vec<Vec<f64>>, frame_time: f64) -> Motion {
    let scalar = |((name, &scale), values): ((String, &f64), &Vec<f64>)| Scalar { name, full_scale: peak(values).max(scale) };
    let scalars = names.into_iter().zip(scales).zip(&values).map(scalar).collect();
    let rig = Rig { joints: Vec::new(), scalars, cm_per_unit: 1.0, ..Rig::default() };
    let frames = values.first().map_or(0, Vec::len);
    Motion::sampled(rig, frame_time, frames, values)
}

/// The greatest value, whatever its sign, but no less than any full scale may be.
pub fn peak(values: &[f64]) -> f64 {
    values.iter().fold(LEAST_SCALE, |peak, value| peak.max(value.abs()))
}

/// Refuses what neither a rig nor the memory holds.
pub fn check_size(channels: usize, frames: usize, memory: Memory) -> Result<()> {
    ensure!(channels > 0, "no channels; expected at least one column of values");
    ensure!(channels <= MAX_CHANNELS, "{channels} channels; a clip holds at most {MAX_CHANNELS}");
    memory.check(frames, channels)
}

/// Where rows at nearly even times, some of them missing, stand on a grid of frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Frame of each row, from 0. Rows too near to the one above have its frame.
    pub frames: Vec<usize>,
    /// Time from a frame to the next, in the unit of the times.
    pub period: f64,
}

impl Grid {
    /// Frames of rows at `times`, which never fall: the usual step from row to row is one frame, any other the nearest whole number of them.
    /// `None` without two different times.
    pub fn of(times: &[f64]) -> Option<Grid> {
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|&step| step > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        let usual = *steps.get(steps.len().saturating_sub(1) / 2)?;
        let (mut frame, mut last) = (0usize, times[0]);
        let mut place = |&time: &f64| {
            let steps = ((time - last) / usual).round();
            if steps > 0.0 {
                frame = frame.saturating_add(steps as usize).min(FARTHEST);
                last = time;
            }
            frame
        };
        let frames: Vec<usize> = times.iter().map(&mut place).collect();
        let period = (last - times[0]) / frame as f64;
        Some(Grid { frames, period })
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.last().map_or(0, |last| last + 1)
    }

    /// Frames that no row has, and rows that have another's.
    pub fn gaps(&self) -> (usize, usize) {
        let shared = self.frames.windows(2).filter(|pair| pair[0] == pair[1]).count();
        (self.len() - (self.frames.len() - shared), shared)
    }

    /// Index of the first row before which frames are missing.
    pub fn first_gap(&self) -> Option<usize> {
        self.frames.windows(2).position(|pair| pair[1] > pair[0] + 1).map(|row| row + 1)
    }

    /// A value a frame from one a row: straight lines over frames that no row has. Of rows at one frame the first counts.
    pub fn fill(&self, values: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = Vec::with_capacity(self.len());
        for (&frame, &value) in self.frames.iter().zip(values) {
            let Some(&before) = out.last() else {
                out.push(value);
                continue;
            };
            let first = out.len();
            let steps = frame + 1 - first;
            out.extend(
                (1..=steps)
                    .map(|step| if step == steps { value } else { before + (value - before) * step as f64 / steps as f64 }),
            );
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_frames_are_filled_and_jitter_is_none() {
        let grid = Grid::of(&[0.0, 0.11, 0.2, 0.5, 0.5001, 0.59]).unwrap();
        assert_eq!(grid.frames, [0, 1, 2, 5, 5, 6]);
        assert_eq!((grid.len(), grid.gaps(), grid.first_gap()), (7, (2, 1), Some(3)));
        assert_eq!(grid.fill(&[1.0, 2.0, 3.0, 6.0, 99.0, 7.0]), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let far = Grid::of(&[0.0, 1e-300, 2e-300, 1e9]).unwrap();
        assert!(check_size(1, far.len(), Memory::default()).is_err());
        assert!(Grid::of(&[3.0, 3.0]).is_none() && Grid::of(&[3.0]).is_none());
    }

    #[test]
    fn a_slow_clock_adds_no_frame() {
        let times: Vec<f64> = (0..2000).map(|row| f64::from(row) * 1.0016).collect();
        let grid = Grid::of(&times).unwrap();
        assert_eq!((grid.len(), grid.gaps()), (2000, (0, 0)));
        assert!((grid.period - 1.0016).abs() < 1e-9);
    }

    #[test]
    fn a_full_scale_holds_its_data() {
        let motion =
            motion(vec!["a".into(), "b".into(), "c".into()], &[1.0, 1.0, 0.0], vec![vec![-1.5], vec![0.5], vec![0.0]], 0.1);
        let scales: Vec<f64> = motion.rig.scalars.iter().map(|scalar| scalar.full_scale).collect();
        assert_eq!(scales, [1.5, 1.0, LEAST_SCALE]);
        assert!(
            [(0, 1), (2000, 1), (61, usize::MAX)].iter().all(|&(channels, frames)| check_size(
                channels,
                frames,
                Memory::default()
            )
            .is_err())
        );
    }
}
