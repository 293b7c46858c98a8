//! Interpolators: keys in seconds, and what runs between them.

use super::lexer::Words;
use super::world::World;
use crate::import::grid;
use anyhow::{Result, bail};

/// A track's keys.
#[derive(Clone, Debug, PartialEq)]
pub struct InterpolatorKeys {
    /// Seconds, ascending; of two equal ones the later counts from there on.
    pub times: Vec<f64>,
    values: Vec<f64>,
    width: usize,
}

/// Numbers that a key of this interpolator has; `None` for other nodes, and for interpolators that move no joint.
pub fn width(kind: &str) -> Option<usize> {
    match kind {
        "PositionInterpolator" => Some(3),
        "OrientationInterpolator" => Some(4),
        "ScalarInterpolator" => Some(1),
        _ => None,
    }
}

impl InterpolatorKeys {
    /// Of the interpolator `node`, in a cycle of `seconds`; `None` if it has no keys.
    pub fn read(world: &World, node: usize, seconds: f64, words: &Words) -> Result<Option<InterpolatorKeys>> {
        let Some(width) = width(world.kind(node)) else { return Ok(None) };
        let (Some(keys), Some(values)) = (world.field(node, "key"), world.field(node, "keyValue")) else { return Ok(None) };
        let count = keys.numbers.len();
        if count == 0 || values.numbers.is_empty() {
            return Ok(None);
        }
        if values.numbers.len() != width * count {
            let found = values.numbers.len();
            let message = format!("{count} keys of `{}` have {found} numbers; expected {width} each", world.name(node));
            bail!(words.error_at(values.line, message));
        }
        if let Some(at) = (1..count).find(|&at| keys.numbers[at] < keys.numbers[at - 1]) {
            let (key, before) = (keys.numbers[at], keys.numbers[at - 1]);
            bail!(words.error_at(keys.line, format!("key {at} of `{}` is {key}, after {before}", world.name(node))));
        }
        let times = keys.numbers.iter().map(|key| key * seconds).collect();
        let values = if width == 4 { quaternions(&values.numbers) } else { values.numbers.clone() };
        Ok(Some(InterpolatorKeys { times, values, width }))
    }

    /// How many numbers it holds.
    pub fn numbers(&self) -> usize {
        self.times.len() + self.values.len()
    }

    /// The value at a time. Before the first key and after the last it is theirs; rotations are quaternions.
    pub fn at(&self, time: f64) -> Vec<f64> {
        let key = self.times.partition_point(|&key| key <= time);
        let value = |key: usize| &self.values[key * self.width..][..self.width];
        if key == 0 || key == self.times.len() {
            return value(key.saturating_sub(1)).to_vec();
        }
        let (from, to) = (self.times[key - 1], self.times[key]);
        let (a, b, t) = (value(key - 1), value(key), (time - from) / (to - from));
        let (near, far) = if self.width == 4 { arc(a, b, t) } else { (1.0 - t, t) };
        a.iter().zip(b).map(|(a, b)| near * a + far * b).collect()
    }
}

/// The commonest distance of keys, in seconds, as it was before the keys were rounded to the four digits of most exporters.
///
/// Most keys are multiples of it; of those, the one that rounding tells the most by gives it.
pub fn distance(tracks: &[&[f64]], cycle: f64) -> Option<f64> {
    let mut distance = grid::common(tracks)? / cycle;
    let mut unknown = f64::MAX;
    let longest = tracks.iter().max_by_key(|times| times.len())?;
    for key in longest.iter().map(|time| time / cycle).filter(|&key| key > 0.0) {
        let number = (key / distance).round();
        let rounded = 10f64.powf(key.log10().floor() - 3.0) / 2.0 / number;
        if number > 0.0 && (key / distance - number).abs() < 0.1 && rounded < unknown {
            (distance, unknown) = (key / number, rounded);
        }
    }
    Some(distance * cycle)
}

/// Axes and angles as quaternions x, y, z, w; an axis of no length turns nothing.
fn quaternions(numbers: &[f64]) -> Vec<f64> {
    numbers.chunks(4).flat_map(|turn| quaternion([turn[0], turn[1], turn[2], turn[3]])).collect()
}

/// x, y, z, w of an axis of any length and an angle in radians.
pub fn quaternion([x, y, z, angle]: [f64; 4]) -> [f64; 4] {
    let length = (x * x + y * y + z * z).sqrt();
    if length == 0.0 {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let (s, c) = (angle / 2.0).sin_cos();
    [x / length * s, y / length * s, z / length * s, c]
}

/// Weights of two quaternions for the way along the shorter arc between them.
fn arc(a: &[f64], b: &[f64], t: f64) -> (f64, f64) {
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let angle = dot.abs().min(1.0).acos();
    let sign = if dot < 0.0 { -1.0 } else { 1.0 };
    // So near to each other a chord is as good, and the sine tells nothing.
    if angle < 1e-6 {
        return (1.0 - t, sign * t);
    }
    (((1.0 - t) * angle).sin() / angle.sin(), sign * (t * angle).sin() / angle.sin())
}
