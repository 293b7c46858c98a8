//! A clip as per-frame motion again, by the device's own decoder.

use crate::encode::rig;
use crate::fit::raw;
use crate::fk::{Matrix, from_exponential};
use crate::motion::{Kind, Motion};
use anyhow::Result;
use pantin::{ChannelState, Clip, Player};
use std::f64::consts::PI;

/// Plays `clip` from its first to its last frame. Angles run on past half a turn; joints that the clip codes as exponential
/// maps come back as the Euler angles that the rig has.
pub fn expand(clip: &Clip<'_>) -> Result<Motion> {
    let motion_rig = rig::decode(&clip.rig());
    let scales = raw::scales(&motion_rig, clip.length_exponent());
    let frames = clip.frames() as usize;
    let mut values: Vec<Vec<f64>> = vec![Vec::with_capacity(frames); motion_rig.channels()];
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; motion_rig.channels()];
    let mut player = Player::new(*clip, &mut states, &mut pose)?;
    for frame in 0..frames {
        for ((out, raw), scale) in values.iter_mut().zip(player.pose()).zip(&scales) {
            out.push(f64::from(*raw) * scale);
        }
        if frame + 1 < frames {
            player.step();
        }
    }
    let first = motion_rig.first_channels();
    for (index, joint) in motion_rig.joints.iter().enumerate() {
        if clip.is_exponential(index) {
            back_to_euler(&joint.kinds, first[index], &mut values);
        }
    }
    for ((_, kind), values) in motion_rig.channel_kinds().iter().zip(&mut values) {
        if kind.is_rotation() {
            unwrap(values);
        }
    }
    let keys = vec![None; values.len()];
    let frame_time = f64::from(clip.frame_time_ns()) * 1e-9;
    Ok(Motion { rig: motion_rig, frame_time, frames, values, keys, looped: clip.looped() })
}

/// Replaces the exponential map in a joint's three rotation channels by its Euler angles.
fn back_to_euler(kinds: &[Kind], first: usize, values: &mut [Vec<f64>]) {
    let slots: Vec<(usize, usize)> = kinds
        .iter()
        .enumerate()
        .filter(|(_, kind)| kind.is_rotation())
        .map(|(i, kind)| (first + i, kind.axis().unwrap_or(0)))
        .collect();
    let &[(s0, a0), (s1, a1), (s2, a2)] = &slots[..] else { return };
    let mut before = [0.0; 3];
    for frame in 0..values[s0].len() {
        let vector = [values[s0][frame], values[s1][frame], values[s2][frame]].map(f64::to_radians);
        before = euler_near(&from_exponential(vector), [a0, a1, a2], before);
        for (slot, angle) in [s0, s1, s2].into_iter().zip(before) {
            values[slot][frame] = angle;
        }
    }
}

/// The Euler angles, in degrees, about three different axes in order, that give `m`: of all that do, the nearest to `before`.
fn euler_near(m: &Matrix, [i, j, k]: [usize; 3], before: [f64; 3]) -> [f64; 3] {
    // In the order x, y, z or a cyclic one, m[i][k] is the sine of the second angle; in the others, all angles are negated.
    let sign = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
    let cosine = m[k][k].hypot(m[j][k]);
    let second = m[i][k].atan2(cosine);
    // Where the cosine vanishes (gimbal lock) any first angle will do, and the third follows from it.
    let first = if cosine > 1e-9 { (-m[j][k]).atan2(m[k][k]) } else { sign * before[0].to_radians() };
    let (s, c) = first.sin_cos();
    let third = (c * m[j][i] + s * m[k][i]).atan2(c * m[j][j] + s * m[k][j]);
    let candidates = [[first, second, third], [first + PI, PI - second, third + PI]];
    let close = candidates.map(|angles| std::array::from_fn(|n| nearest((sign * angles[n]).to_degrees(), before[n])));
    let far = |angles: &[f64; 3]| (0..3).map(|n| (angles[n] - before[n]).powi(2)).sum::<f64>();
    if far(&close[0]) <= far(&close[1]) { close[0] } else { close[1] }
}

/// `angle` by whole turns as near to `before` as can be.
fn nearest(angle: f64, before: f64) -> f64 {
    angle - 360.0 * ((angle - before) / 360.0).round()
}

fn unwrap(values: &mut [f64]) {
    for frame in 1..values.len() {
        values[frame] = nearest(values[frame], values[frame - 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::{about, product};

    #[test]
    fn euler_angles_come_back_in_every_order() {
        let angles = [[10.0, 20.0, 30.0], [-170.0, 80.0, 95.0], [40.0, 90.0, 10.0], [-40.0, -90.0, 10.0], [0.0, 89.9999999, 5.0]];
        for axes in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            for euler in angles {
                let turn = |angles: [f64; 3]| {
                    let turns = [0, 1, 2].map(|n| about(axes[n], f64::to_radians(angles[n])));
                    product(&product(&turns[0], &turns[1]), &turns[2])
                };
                let m = turn(euler);
                let back = turn(euler_near(&m, axes, [0.0; 3]));
                let off = (0..9).map(|n| (m[n / 3][n % 3] - back[n / 3][n % 3]).abs()).fold(0.0, f64::max);
                assert!(off < 1e-9, "{axes:?} {euler:?}: off by {off}");
                let near = euler_near(&m, axes, euler);
                assert!((0..3).all(|n| (near[n] - euler[n]).abs() < 1e-4), "{axes:?} {euler:?}: {near:?}");
            }
        }
    }
}
