//! A clip as per-frame motion again, by the device's own decoder.

use crate::encode::rig;
use crate::euler;
use crate::fit::raw;
use crate::fk::from_exponential;
use crate::motion::{Kind, Motion};
use anyhow::Result;
use pantin::{ChannelState, Clip, Player};

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
        for ((out, raw), scale) in values.iter_mut().zip(player.pose().values).zip(&scales) {
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
        before = euler::near(&from_exponential(vector), [a0, a1, a2], before);
        for (slot, angle) in [s0, s1, s2].into_iter().zip(before) {
            values[slot][frame] = angle;
        }
    }
}

fn unwrap(values: &mut [f64]) {
    for frame in 1..values.len() {
        values[frame] = euler::nearest(values[frame], values[frame - 1]);
    }
}
