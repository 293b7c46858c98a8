//! Curves through key values, sampled at every frame.
//!
//! Every segment is a cubic `p + c s + w s^2 / 2 + k s^3 / 6`, s frames after its first key. The splines solve for the
//! second derivative (`Natural`) or second difference (`Discrete`) w at the keys: both are linear in a segment, so the curve
//! is known by w at its two ends, and one equation a key, that both sides meet smoothly, gives all w (docs/METHOD.md 2.1, 2.3).

use crate::motion::{Interpolation, Keys, Piece};

impl Piece {
    /// Value `s` frames after its start.
    pub fn at(&self, s: f64) -> f64 {
        self.p + s * (self.c + s * (self.w / 2.0 + s * self.k / 6.0))
    }

    /// The cubic of two keys, each a time in frames, a value and a slope a frame there; the second is later than the first.
    pub fn hermite(from: [f64; 3], to: [f64; 3]) -> Piece {
        let length = to[0] - from[0];
        let span = Span { p: from[1], length, slope: (to[1] - from[1]) / length };
        Piece { start: from[0], ..span.hermite(from[2], to[2]) }
    }
}

/// By how much a piece may begin after a frame and still hold there: what rounding a time to f32 takes, in frames.
fn late(frame: f64) -> f64 {
    1e-5 + 2e-7 * frame
}

/// Values of frames `0..frames` of the curve that `pieces` make, starts ascending; before the first it stays at its start.
pub fn sample_pieces(pieces: &[Piece], frames: usize) -> Vec<f64> {
    let mut next = 0;
    let value = |frame: usize| {
        let time = frame as f64;
        while pieces.get(next).is_some_and(|piece| piece.start <= time + late(time)) {
            next += 1;
        }
        match next {
            0 => pieces.first().map_or(0.0, |piece| piece.p),
            _ => pieces[next - 1].at(time - pieces[next - 1].start),
        }
    };
    (0..frames).map(value).collect()
}

/// Values of frames `0..frames` of the curve through `keys`: frame and value, frames strictly ascending from 0, at least one.
///
/// In a `cycle` the last key is where the first comes round again: the curve arrives as it leaves there, a difference
/// of the two values (the distance of a walk cycle) being added in each cycle. Otherwise splines end without curvature.
/// Frames after the last key keep its value.
pub fn sample(keys: &[(usize, f64)], interpolation: Interpolation, frames: usize, cycle: bool) -> Vec<f64> {
    let cubics = cubics(keys, interpolation, cycle);
    let mut segment = 0;
    let value = |frame: usize| {
        while segment + 1 < keys.len() && keys[segment + 1].0 <= frame {
            segment += 1;
        }
        cubics.get(segment).map_or(keys[segment].1, |cubic| cubic.at((frame - keys[segment].0) as f64))
    };
    (0..frames).map(value).collect()
}

/// Keys up to the last frame that is there, with one on it.
pub(crate) fn within(mut keys: Vec<(usize, f64)>, interpolation: Interpolation, pieces: Vec<Piece>, values: &[f64]) -> Keys {
    let last = values.len() - 1;
    keys.retain(|&(frame, _)| frame < last);
    keys.push((last, values[last]));
    Keys::OnFrames { interpolation, keys, pieces }
}

/// The cubics of that curve, one between two keys.
pub fn cubics(keys: &[(usize, f64)], interpolation: Interpolation, cycle: bool) -> Vec<Piece> {
    let spans: Vec<Span> = keys.windows(2).map(|pair| Span::new(pair[0], pair[1])).collect();
    if spans.is_empty() {
        return Vec::new();
    }
    let mut cubics: Vec<Piece> = match interpolation {
        Interpolation::Linear => spans.iter().map(|span| Piece { p: span.p, c: span.slope, ..Piece::default() }).collect(),
        Interpolation::CatmullRom => {
            let tangents = tangents(&spans, cycle);
            spans.iter().zip(tangents.windows(2)).map(|(span, ends)| span.hermite(ends[0], ends[1])).collect()
        }
        Interpolation::Natural => splines(&spans, cycle, 0.0),
        Interpolation::Discrete => splines(&spans, cycle, 1.0),
    };
    cubics.iter_mut().zip(keys).for_each(|(cubic, key)| cubic.start = key.0 as f64);
    cubics
}

/// Between two keys: the first one's value, the length in frames, and the slope of the chord.
struct Span {
    p: f64,
    length: f64,
    slope: f64,
}

impl Span {
    fn new(from: (usize, f64), to: (usize, f64)) -> Span {
        let length = (to.0 - from.0) as f64;
        Span { p: from.1, length, slope: (to.1 - from.1) / length }
    }

    fn hermite(&self, from: f64, to: f64) -> Piece {
        let w = 2.0 * (3.0 * self.slope - 2.0 * from - to) / self.length;
        let k = 6.0 * (from + to - 2.0 * self.slope) / (self.length * self.length);
        Piece { p: self.p, c: from, w, k, ..Piece::default() }
    }

    fn spline(&self, from: f64, to: f64) -> Piece {
        let k = (to - from) / self.length;
        let c = self.slope - self.length * (from / 2.0 + self.length * k / 6.0);
        Piece { p: self.p, c, w: from, k, ..Piece::default() }
    }
}

/// Slope at each key: of the chord from the key before to the key after.
fn tangents(spans: &[Span], cycle: bool) -> Vec<f64> {
    let last = spans.len() - 1;
    let between = |a: &Span, b: &Span| (a.slope * a.length + b.slope * b.length) / (a.length + b.length);
    (0..=spans.len())
        .map(|key| match key {
            _ if cycle && (key == 0 || key > last) => between(&spans[last], &spans[0]),
            0 => spans[0].slope,
            _ if key > last => spans[last].slope,
            _ => between(&spans[key - 1], &spans[key]),
        })
        .collect()
}

/// Sweeps after which w has settled: the equations weigh a key at least twice as much as its neighbours together, so each
/// sweep at least halves what is missing, and 64 halvings leave nothing that a double holds.
const SWEEPS: usize = 64;

/// `grid` is 0 for the derivative in time and 1 for differences on the frames.
///
/// With L and R the lengths before and after a key, the equation there is, in w of the key before, of it, and after it,
/// `(L - grid/L)/6, (L + R)/3 + grid (1/L + 1/R)/6, (R - grid/R)/6`, with the difference of the chords' slopes on the right.
fn splines(spans: &[Span], cycle: bool, grid: f64) -> Vec<Piece> {
    let count = spans.len();
    let mut w = vec![0.0; count + 1];
    let reach = |length: f64| (length - grid / length) / 6.0;
    let hold = |length: f64| length / 3.0 + grid / length / 6.0;
    for _ in 0..SWEEPS {
        for key in usize::from(!cycle)..count {
            let before = if key == 0 { count - 1 } else { key - 1 };
            let (left, right) = (&spans[before], &spans[key]);
            let pull = reach(left.length) * w[before] + reach(right.length) * w[key + 1];
            w[key] = (right.slope - left.slope - pull) / (hold(left.length) + hold(right.length));
            if key == 0 {
                w[count] = w[0];
            }
        }
    }
    spans.iter().zip(w.windows(2)).map(|(span, ends)| span.spline(ends[0], ends[1])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use Interpolation::*;

    const KEYS: [(usize, f64); 5] = [(0, 3.0), (7, -20.0), (8, -21.5), (30, 44.0), (40, 3.0)];
    const FRAMES: usize = 41;

    fn second(values: &[f64], frame: usize) -> f64 {
        values[frame + 1] - 2.0 * values[frame] + values[frame - 1]
    }

    /// The curve twice round and a frame, each time `drift` higher.
    fn twice(keys: &[(usize, f64)], interpolation: Interpolation) -> Vec<f64> {
        let period = keys[keys.len() - 1].0;
        let drift = keys[keys.len() - 1].1 - keys[0].1;
        let once = sample(keys, interpolation, period, true);
        (0..=2 * period).map(|frame| once[frame % period] + drift * (frame / period) as f64).collect()
    }

    #[test]
    fn pieces_begin_between_frames_and_join_by_value_and_slope() {
        let keys = [[0.25, 2.0, 1.0], [3.5, -1.0, 0.5], [6.0, 4.0, -2.0]];
        let mut pieces: Vec<Piece> = keys.windows(2).map(|pair| Piece::hermite(pair[0], pair[1])).collect();
        let second = pieces[1];
        assert!((pieces[0].at(3.25) - second.p).abs() < 1e-12 && (second.c - 0.5).abs() < 1e-12);
        pieces.push(Piece { start: 6.0, p: 4.0, ..Piece::default() });
        let values = sample_pieces(&pieces, 9);
        assert_eq!(values[0], 2.0, "before the first piece the curve stays");
        assert!((values[4] - second.at(0.5)).abs() < 1e-15);
        assert_eq!(values[6..], [4.0; 3]);
    }

    #[test]
    fn every_curve_meets_its_keys() {
        for interpolation in [Linear, CatmullRom, Natural, Discrete] {
            for cycle in [false, true] {
                let values = sample(&KEYS, interpolation, FRAMES, cycle);
                for (frame, value) in KEYS {
                    assert!((values[frame] - value).abs() < 1e-12, "{interpolation:?} at {frame}: {}", values[frame]);
                }
            }
        }
    }

    #[test]
    fn a_straight_line_stays_straight_and_a_single_key_stays() {
        for interpolation in [Linear, CatmullRom, Natural, Discrete] {
            for cycle in [false, true] {
                let values = sample(&[(0, 1.0), (3, 2.5), (10, 6.0)], interpolation, 11, cycle);
                let off = |frame: usize| (values[frame] - 1.0 - 0.5 * frame as f64).abs();
                assert!((0..11).all(|frame| off(frame) < 1e-13), "{interpolation:?}: {values:?}");
                assert_eq!(sample(&[(0, 4.5)], interpolation, 3, cycle), [4.5; 3]);
                assert_eq!(sample(&[(0, 4.5), (2, 4.5)], interpolation, 2, cycle), [4.5; 2]);
            }
        }
    }

    /// Second difference at `frame` if its acceleration is the line between those of the keys around it.
    fn on_the_line(values: &[f64], from: usize, to: usize, frame: usize) -> f64 {
        let (a, b) = (second(values, from), second(values, to));
        a + (b - a) * (frame - from) as f64 / (to - from) as f64
    }

    #[test]
    fn the_discrete_spline_has_a_piecewise_linear_second_difference() {
        let values = sample(&KEYS, Discrete, FRAMES, false);
        for pair in [(7, 8), (8, 30)] {
            for frame in pair.0..=pair.1 {
                assert!((second(&values, frame) - on_the_line(&values, pair.0, pair.1, frame)).abs() < 1e-12);
            }
        }
        // It starts and ends without acceleration.
        for frame in 1..=7 {
            assert!((second(&values, frame) - second(&values, 7) * frame as f64 / 7.0).abs() < 1e-12);
        }
        for frame in 30..40 {
            assert!((second(&values, frame) - second(&values, 30) * (40 - frame) as f64 / 10.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_discrete_cycle_has_it_over_the_seam_too() {
        for last in [3.0, 103.0] {
            let mut keys = KEYS;
            keys[4].1 = last;
            let values = twice(&keys, Discrete);
            for (from, to) in [(7, 8), (8, 30), (30, 40), (40, 47), (47, 48), (48, 70)] {
                for frame in from..=to {
                    assert!((second(&values, frame) - on_the_line(&values, from, to, frame)).abs() < 1e-11, "{frame}");
                }
            }
        }
    }

    /// Slope and curvature on both sides of a key.
    fn ends(cubics: &[Piece], keys: &[(usize, f64)], segment: usize) -> [(f64, f64); 2] {
        let length = (keys[segment + 1].0 - keys[segment].0) as f64;
        let before = &cubics[segment];
        let after = &cubics[(segment + 1) % cubics.len()];
        let slope = before.c + length * (before.w + length * before.k / 2.0);
        [(slope, before.w + length * before.k), (after.c, after.w)]
    }

    #[test]
    fn catmull_rom_joins_slopes_and_natural_joins_curvature() {
        for (interpolation, cycle) in [(CatmullRom, false), (CatmullRom, true), (Natural, false), (Natural, true)] {
            let cubics = cubics(&KEYS, interpolation, cycle);
            for segment in 0..if cycle { 4 } else { 3 } {
                let [before, after] = ends(&cubics, &KEYS, segment);
                assert!((before.0 - after.0).abs() < 1e-12, "{interpolation:?} {segment}");
                assert!(interpolation == CatmullRom || (before.1 - after.1).abs() < 1e-12, "{segment}");
            }
        }
        let natural = cubics(&KEYS, Natural, false);
        assert_eq!(natural[0].w, 0.0);
        assert!(ends(&natural, &KEYS, 3)[0].1.abs() < 1e-12);
    }
}
