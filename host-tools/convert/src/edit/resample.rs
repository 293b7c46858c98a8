//! Resampling: a motion is taken at another frame rate.

use super::curve;
use crate::error::{Error, Setting, require};
use crate::euler::{self, nearest};
use crate::events;
use crate::fk::{Matrix, local, product};
use crate::keys::sample_pieces;
use crate::memory::Memory;
use crate::motion::{Keys, Kind, Motion};
use anyhow::{Context, Result};
use pantin::codec::layout::MAX_FRAMES;

/// Rates closer than this, as a part, are the same.
const SAME_RATE: f64 = 1e-4;
/// A file's rate may be rounded by this part of it.
const ROUNDED: f64 = 1e-5;
/// A joint whose angles move farther than this many times its own turn is near where its angles are not told apart.
const STRAY: f64 = 1.5;
/// From one frame to the next, angles that jump farther than this, in degrees, may have changed to the other triple for the same pose.
const JUMP: f64 = 20.0;

/// Takes `motion` at `fps` frames a second from its first frame on.
///
/// Known curves stay what they are in time; frames have Catmull-Rom cubics through them, which meet every source frame. A loop keeps whole
/// frames: it lasts up to half of a frame longer or shorter.
pub fn resample(motion: &Motion, fps: f64, memory: Memory) -> Result<Motion> {
    let ratio = fps * motion.frame_time;
    if (ratio - 1.0).abs() < SAME_RATE {
        return Ok(motion.clone());
    }
    let (steps, factor) = if motion.looped {
        let frames = (motion.frames as f64 * ratio).round().max(1.0);
        (frames - 1.0, frames / motion.frames as f64)
    } else {
        let whole = (1.0 / ratio).round();
        let factor = if whole >= 1.0 && (ratio * whole - 1.0).abs() < SAME_RATE { 1.0 / whole } else { snapped(ratio) };
        // The last frame of a file that says `0.0333333` stays the last one.
        let steps = (motion.frames - 1) as f64 * factor;
        ((steps + (ROUNDED * steps).clamp(1e-9, 0.01)).floor(), factor)
    };
    let too_many =
        || Error::value(Setting::FrameRate, fps, format!("it gives more than {MAX_FRAMES} frames, too many for a clip"));
    require!(steps < f64::from(MAX_FRAMES), too_many());
    if steps as usize >= motion.frames {
        memory.check(steps as usize + 1, motion.values.len()).with_context(|| format!("at {fps} frames a second"))?;
    }
    let times: Vec<f64> = (0..=steps as usize).map(|frame| frame as f64 / factor).collect();
    let kinds = motion.rig.channel_kinds();
    let sampled = |(channel, values): (usize, &Vec<f64>)| {
        let round = round(motion, channel, kinds[channel].1);
        times.iter().map(|&t| between(values, t, round)).collect()
    };
    let mut values: Vec<Vec<f64>> = motion.values.iter().enumerate().map(sampled).collect();
    between_triples(motion, &times, &mut values);
    let mut keys = vec![None; values.len()];
    for (channel, known) in motion.keys.iter().enumerate() {
        if let Some(pieces) = known.as_ref().and_then(|keys| curve::pieces(keys, &motion.values[channel])) {
            let moved = curve::moved(&pieces, 0.0, factor);
            values[channel] = sample_pieces(&moved, times.len());
            keys[channel] = Some(Keys::Pieces(moved));
        }
    }
    for (channel, (_, kind)) in kinds.into_iter().enumerate() {
        // Known curves are what they are; between frames a cubic may pass the scale that the frames keep.
        if kind == Kind::Scalar && keys[channel].is_none() {
            let full = motion.rig.scalars[channel - motion.rig.joint_channels()].full_scale;
            let most = motion.values[channel].iter().fold(full, |most, value| most.max(value.abs()));
            values[channel].iter_mut().for_each(|value| *value = value.clamp(-most, most));
        }
    }
    let events = events::resample(&motion.events, factor, times.len() - 1);
    Ok(Motion {
        rig: motion.rig.clone(),
        frame_time: 1.0 / fps,
        frames: times.len(),
        values,
        keys,
        looped: motion.looped,
        events,
        origin: motion.origin,
    })
}

/// Twice as many frames are twice as many, though the file's `0.033333` says a little less.
fn snapped(ratio: f64) -> f64 {
    if (ratio / ratio.round().max(1.0) - 1.0).abs() < SAME_RATE { ratio.round() } else { ratio }
}

/// The source frame at or before `t`, and how far it is from there to the next.
fn place(t: f64) -> (usize, f64) {
    let frame = (t + 1e-9).floor();
    (frame as usize, (t - frame).max(0.0))
}

/// The value at a frame, which may be outside of the motion; `round` is what a loop adds each time round, and nothing where there is no loop.
fn value_at(values: &[f64], frame: isize, round: Option<f64>) -> f64 {
    let frames = values.len() as isize;
    match round {
        Some(round) => values[frame.rem_euclid(frames) as usize] + round * frame.div_euclid(frames) as f64,
        None => values[frame.clamp(0, frames - 1) as usize],
    }
}

/// The Catmull-Rom cubic through four frames, `s` after the second.
fn cubic([a, b, c, d]: [f64; 4], s: f64) -> f64 {
    b + s / 2.0 * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)))
}

/// The cubic through the frames at `t`.
fn between(values: &[f64], t: f64, round: Option<f64>) -> f64 {
    let (frame, s) = place(t);
    let frame = frame as isize;
    if s < 1e-9 {
        return value_at(values, frame, round);
    }
    cubic([-1, 0, 1, 2].map(|step| value_at(values, frame + step, round)), s)
}

/// By how much a channel of a loop advances in each cycle: positions by the distance travelled, angles by whole turns.
fn round(motion: &Motion, channel: usize, kind: Kind) -> Option<f64> {
    let values = &motion.values[channel];
    let last = values.len() - 1;
    let way = 2.0 * values[last] - values[last.saturating_sub(1)] - values[0];
    let whole = (way / 360.0).round() * 360.0;
    motion.looped.then_some(if kind.is_position() {
        way
    } else if kind.is_rotation() {
        whole
    } else {
        0.0
    })
}

/// The triple of angles about three different axes that turns as `angles` do and is nearest to `near`: they themselves, or the other one for the
/// same pose, each but for whole turns.
fn aligned(angles: [f64; 3], near: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = angles;
    let both = [angles, [a + 180.0, 180.0 - b, c + 180.0]].map(|triple| std::array::from_fn(|n| nearest(triple[n], near[n])));
    let far = |triple: &[f64; 3]| (0..3).map(|n| (triple[n] - near[n]).abs()).fold(0.0, f64::max);
    if far(&both[1]) < far(&both[0]) { both[1] } else { both[0] }
}

/// Frames whose angles jump may have changed to the other triple for the same pose: cubics go through the triples that belong together, and where
/// these jump too, the joint's own turn runs by the shorter way.
fn between_triples(motion: &Motion, times: &[f64], values: &mut [Vec<f64>]) {
    let firsts = motion.rig.first_channels();
    let kinds = motion.rig.channel_kinds();
    for (joint, first) in motion.rig.joints.iter().zip(firsts) {
        let slots: Vec<(usize, usize)> = (0..joint.kinds.len())
            .filter(|&slot| joint.kinds[slot].is_rotation())
            .filter_map(|slot| Some((first + slot, joint.kinds[slot].axis()?)))
            .collect();
        let &[(s0, a0), (s1, a1), (s2, a2)] = &slots[..] else { continue };
        if (1 << a0 | 1 << a1 | 1 << a2) != 7 {
            continue;
        }
        // A known curve is one of angles: its joint's others belong to these angles, and not to another triple for the same pose.
        if [s0, s1, s2].iter().any(|&slot| motion.keys[slot].is_some()) {
            continue;
        }
        let turned = |frame: usize| local(joint, |slot| motion.values[first + slot][frame]).0;
        let rounds = [s0, s1, s2].map(|slot| round(motion, slot, kinds[slot].1));
        let angles =
            |frame: isize| -> [f64; 3] { std::array::from_fn(|n| value_at(&motion.values[[s0, s1, s2][n]], frame, rounds[n])) };
        let farthest = |from: &[f64; 3], to: &[f64; 3]| (0..3).map(|n| (to[n] - from[n]).abs()).fold(0.0, f64::max);
        // Whether angles that belong together jump though the joint turns by far less.
        let strays = |from: isize, [before, after]: [&[f64; 3]; 2]| {
            let far = farthest(before, after);
            far > JUMP && {
                let within = |frame: isize| match motion.looped {
                    true => frame.rem_euclid(motion.frames as isize) as usize,
                    false => frame.clamp(0, motion.frames as isize - 1) as usize,
                };
                far > STRAY * angle_between(&turned(within(from)), &turned(within(from + 1)))
            }
        };
        for (index, &t) in times.iter().enumerate() {
            let (frame, s) = place(t);
            if s < 1e-9 {
                continue;
            }
            let [a, b, c, d] = [-1, 0, 1, 2].map(|step| angles(frame as isize + step));
            if [(&a, &b), (&b, &c), (&c, &d)].iter().all(|(from, to)| farthest(from, to) <= JUMP) {
                continue;
            }
            let (mut before, to) = (aligned(a, b), aligned(c, b));
            let mut after = aligned(d, to);
            let at = frame as isize;
            let found = if strays(at, [&b, &to]) {
                let next = if frame + 1 < motion.frames { frame + 1 } else { 0 };
                let way = part_way(&turned(frame), &turned(next), s);
                let found = euler::near(&way, [a0, a1, a2], b);
                std::array::from_fn(|n| nearest(found[n], b[n]))
            } else {
                // Beside a jump that is none of triples, a slope over it says nothing.
                if strays(at - 1, [&before, &b]) {
                    before = std::array::from_fn(|n| 2.0 * b[n] - to[n]);
                }
                if strays(at + 1, [&to, &after]) {
                    after = std::array::from_fn(|n| 2.0 * to[n] - b[n]);
                }
                std::array::from_fn(|n| cubic([before[n], b[n], to[n], after[n]], s))
            };
            for (slot, angle) in [s0, s1, s2].into_iter().zip::<[f64; 3]>(found) {
                values[slot][index] = angle;
            }
        }
    }
}

/// The angle of the turn from one rotation to another, in degrees.
fn angle_between(from: &Matrix, to: &Matrix) -> f64 {
    let trace: f64 = (0..3).map(|row| (0..3).map(|column| from[row][column] * to[row][column]).sum::<f64>()).sum();
    ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees()
}

/// The turn that is the part `s` of the shortest way from `from` to `to`.
fn part_way(from: &Matrix, to: &Matrix, s: f64) -> Matrix {
    let back: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| from[column][row]));
    let way = crate::fit::figure::exponential_near(&product(&back, to), [0.0; 3]);
    product(from, &crate::fk::from_exponential(way.map(|x| (x * s).to_radians())))
}
