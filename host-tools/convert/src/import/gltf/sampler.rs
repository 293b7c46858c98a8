//! One animated property: keys in time, and what lies between them.

use super::accessor::numbers;
use super::file::File;
use crate::motion::Piece;
use anyhow::{Result, ensure};
use gltf::json::animation::{Animation, Interpolation};
use gltf::json::validation::Checked;

/// The keys of one sampler.
#[derive(Clone, Debug)]
pub struct SamplerKeys {
    /// Seconds, strictly ascending, at least one.
    pub times: Vec<f64>,
    interpolation: Interpolation,
    /// Numbers of one value.
    pub components: usize,
    /// A value a key; for CUBICSPLINE, in tangent, value and out tangent.
    values: Vec<f64>,
}

impl SamplerKeys {
    /// The sampler `sampler` of animation `number`: vectors of 3 or 4 numbers, or, for 1, as many weights as there are.
    pub fn read(file: &File, number: usize, animation: &Animation, sampler: usize, components: usize) -> Result<SamplerKeys> {
        let at = format!("animations[{number}].samplers[{sampler}]");
        let error = |message: String| file.error(&at, message);
        let Some(entry) = animation.samplers.get(sampler) else { return Err(error("no such sampler".into())) };
        let Checked::Valid(interpolation) = entry.interpolation else { return Err(error("unknown interpolation".into())) };
        let times = numbers(file, entry.input.value(), 1)?;
        let values = numbers(file, entry.output.value(), components)?;
        if times.is_empty() {
            return Err(error("no keys; expected one at least".into()));
        }
        if let Some(at) = (1..times.len()).find(|&key| times[key] <= times[key - 1]) {
            return Err(error(format!("key {at} is at {} s; expected later than {} s", times[at], times[at - 1])));
        }
        let parts = times.len() * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let components = if components == 1 { values.len() / parts } else { components };
        if values.is_empty() || values.len() != parts * components {
            let keys = times.len();
            return Err(error(format!("{} output numbers do not make {interpolation:?} values for {keys} keys", values.len())));
        }
        Ok(SamplerKeys { times, interpolation, components, values })
    }

    /// Whether the track jumps from key to key.
    pub fn steps(&self) -> bool {
        self.interpolation == Interpolation::Step
    }

    /// Whether the track is made of cubics.
    pub fn is_cubic(&self) -> bool {
        self.interpolation == Interpolation::CubicSpline
    }

    fn key(&self, key: usize) -> &[f64] {
        let place = if self.interpolation == Interpolation::CubicSpline { 3 * key + 1 } else { key };
        &self.values[place * self.components..(place + 1) * self.components]
    }

    fn slope(&self, key: usize, component: usize, after: bool) -> f64 {
        self.values[(3 * key + if after { 2 } else { 0 }) * self.components + component]
    }

    /// Component `component` as a curve over frames of `frame_time` seconds, the first at `first` seconds.
    pub fn pieces(&self, component: usize, first: f64, frame_time: f64) -> Vec<Piece> {
        let frame = |key: usize| (self.times[key] - first) / frame_time;
        let value = |key: usize| self.key(key)[component];
        let between = |key: usize| {
            let (from, to) = ([frame(key), value(key)], [frame(key + 1), value(key + 1)]);
            match self.interpolation {
                Interpolation::Step => Piece { start: from[0], p: from[1], ..Piece::default() },
                Interpolation::Linear => {
                    Piece { start: from[0], p: from[1], c: (to[1] - from[1]) / (to[0] - from[0]), ..Piece::default() }
                }
                Interpolation::CubicSpline => {
                    let slopes = [self.slope(key, component, true), self.slope(key + 1, component, false)];
                    let [out, into] = slopes.map(|slope| slope * frame_time);
                    Piece::hermite([from[0], from[1], out], [to[0], to[1], into])
                }
            }
        };
        let last = self.times.len() - 1;
        let end = Piece { start: frame(last), p: value(last), ..Piece::default() };
        (0..last).map(between).chain([end]).collect()
    }

    /// Rotations x, y, z, w of length 1 at `frames` frames.
    pub fn rotations(&self, first: f64, frame_time: f64, frames: usize) -> Result<Vec<[f64; 4]>> {
        ensure!(self.components == 4, "a rotation has 4 components");
        if self.interpolation != Interpolation::Linear {
            let curves: Vec<Vec<f64>> =
                (0..4).map(|i| crate::keys::sample_pieces(&self.pieces(i, first, frame_time), frames)).collect();
            return Ok((0..frames).map(|frame| unit(std::array::from_fn(|i| curves[i][frame]))).collect());
        }
        let ends: Vec<[f64; 4]> = (0..self.times.len()).map(|key| unit(std::array::from_fn(|i| self.key(key)[i]))).collect();
        let mut key = 0;
        let at = |frame: usize| {
            let time = first + frame as f64 * frame_time;
            while key + 1 < ends.len() && self.times[key + 1] <= time {
                key += 1;
            }
            match ends.get(key + 1) {
                Some(&to) => {
                    let part = (time - self.times[key]) / (self.times[key + 1] - self.times[key]);
                    slerp(ends[key], to, part.max(0.0))
                }
                None => ends[key],
            }
        };
        Ok((0..frames).map(at).collect())
    }
}

/// A quaternion of length 1; of length 0, no turn.
pub fn unit(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 1e-12 { q.map(|x| x / length) } else { [0.0, 0.0, 0.0, 1.0] }
}

/// The shorter way round, as glTF has it.
fn slerp(a: [f64; 4], b: [f64; 4], part: f64) -> [f64; 4] {
    let dot: f64 = (0..4).map(|i| a[i] * b[i]).sum();
    let b = if dot < 0.0 { b.map(|x| -x) } else { b };
    let across: f64 = (0..4).map(|i| (b[i] - a[i] * dot.abs()).powi(2)).sum::<f64>().sqrt();
    let angle = across.atan2(dot.abs());
    if angle < 1e-9 {
        return unit(std::array::from_fn(|i| a[i] + (b[i] - a[i]) * part));
    }
    let (near, far) = (((1.0 - part) * angle).sin() / angle.sin(), (part * angle).sin() / angle.sin());
    unit(std::array::from_fn(|i| a[i] * near + b[i] * far))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(interpolation: Interpolation, times: &[f64], components: usize, values: &[f64]) -> SamplerKeys {
        SamplerKeys { times: times.to_vec(), interpolation, components, values: values.to_vec() }
    }

    #[test]
    fn slerp_turns_evenly_and_the_shorter_way() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let track = track(Interpolation::Linear, &[0.0, 1.0], 4, &[0.0, 0.0, 0.0, 1.0, -half, 0.0, 0.0, -half]);
        for (frame, q) in track.rotations(0.0, 0.1, 13).unwrap().into_iter().enumerate() {
            let (s, c) = (9.0 * frame.min(10) as f64 / 2.0).to_radians().sin_cos();
            assert!((q[0].abs() - s).abs() < 1e-12 && (q[3].abs() - c).abs() < 1e-12, "{frame}: {q:?}");
        }
    }

    #[test]
    fn a_cubic_spline_is_the_polynomial_that_gltf_gives() {
        // Value and tangents of t^3 - t + 2 at 1 and 3 s.
        let track = track(Interpolation::CubicSpline, &[1.0, 3.0], 1, &[9.0, 2.0, 2.0, 26.0, 26.0, 9.0]);
        let values = crate::keys::sample_pieces(&track.pieces(0, 1.0, 0.25), 10);
        for (frame, value) in values.iter().enumerate() {
            let t = (1.0 + 0.25 * frame as f64).min(3.0);
            assert!((value - (t * t * t - t + 2.0)).abs() < 1e-12, "{t}: {value}");
        }
    }

    #[test]
    fn steps_hold_until_the_next_key() {
        let track = track(Interpolation::Step, &[0.0, 0.30000001, 0.45], 1, &[1.0, 2.0, 3.0]);
        let values = crate::keys::sample_pieces(&track.pieces(0, 0.0, 0.1), 6);
        assert_eq!(values, [1.0, 1.0, 1.0, 2.0, 2.0, 3.0]);
    }
}
