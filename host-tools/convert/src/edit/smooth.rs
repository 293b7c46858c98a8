//! A motion without what is faster than a frequency: jitter of a capture.
//!
//! Each channel is averaged over the frames around, weighted by a Gaussian. What has the given frequency keeps 0.707 of its size (-3 dB), twice the frequency a
//! quarter, half of it 0.92; nothing is delayed. Rotations are averaged as quaternions. Before its first frame and after its last, a motion
//! goes on as a mirror image of itself; a loop goes on round its seam.

use super::rotation::{local, turns_freely, write};
use crate::fk::{from_quaternion, quaternion};
use crate::motion::Motion;

/// Weights smaller than this part of the greatest are left out.
const LEAST: f64 = 1e-6;

/// Smooths all channels of joints; scalars stay.
pub fn smooth(motion: &Motion, hertz: f64) -> Motion {
    let weights = weights(hertz * motion.frame_time, motion.frames);
    let firsts = motion.rig.first_channels();
    let mut out = motion.clone();
    for (index, (joint, &first)) in motion.rig.joints.iter().zip(&firsts).enumerate() {
        let free = turns_freely(joint);
        for (slot, kind) in joint.kinds.iter().enumerate() {
            if kind.is_position() || !free {
                // The way of a loop does not come back to where it began.
                let round = motion.looped && !kind.is_position();
                out.values[first + slot] = averaged(&motion.values[first + slot], &weights, round);
            }
        }
        if free {
            let turns: Vec<[f64; 4]> = (0..motion.frames).map(|frame| quaternion(&local(motion, index, first, frame))).collect();
            for frame in 0..motion.frames {
                let [x, y, z, w] = mean(&turns, frame, &weights, motion.looped);
                write(joint, first, &mut out.values, frame, &from_quaternion([w, x, y, z]));
            }
        }
        out.keys[first..first + joint.kinds.len()].fill(None);
    }
    out
}

/// Weights of the frame itself and of those farther and farther away, for a frequency in cycles a frame.
fn weights(frequency: f64, frames: usize) -> Vec<f64> {
    // exp(-2 (pi f sigma)^2) = 1 / sqrt(2).
    let sigma = std::f64::consts::LN_2.sqrt() / (2.0 * std::f64::consts::PI * frequency);
    (0..frames).map(|away| (-0.5 * (away as f64 / sigma).powi(2)).exp()).take_while(|weight| *weight > LEAST).collect()
}

/// A channel's averages. Beyond an end it goes on as its own image, turned about the end: a steady change stays steady.
fn averaged(values: &[f64], weights: &[f64], round: bool) -> Vec<f64> {
    let last = values.len() - 1;
    let at = |frame: isize| {
        if round {
            return values[frame.rem_euclid(values.len() as isize) as usize];
        }
        match usize::try_from(frame) {
            Err(_) => 2.0 * values[0] - values[frame.unsigned_abs().min(last)],
            Ok(frame) if frame > last => 2.0 * values[last] - values[(2 * last).saturating_sub(frame)],
            Ok(frame) => values[frame],
        }
    };
    let one = |frame: isize| {
        let mut sum = (weights[0] * at(frame), weights[0]);
        for (away, weight) in (1..).zip(&weights[1..]) {
            sum = (sum.0 + weight * (at(frame - away) + at(frame + away)), sum.1 + 2.0 * weight);
        }
        sum.0 / sum.1
    };
    (0..values.len() as isize).map(one).collect()
}

/// The mean of the rotations around a frame, of any length. A rotation's two quaternions count as the one nearer to the frame's own.
fn mean(turns: &[[f64; 4]], frame: usize, weights: &[f64], round: bool) -> [f64; 4] {
    let (own, count) = (turns[frame], turns.len() as isize);
    let mut sum = own.map(|x| x * weights[0]);
    for (away, weight) in (1..).zip(&weights[1..]) {
        for other in [frame as isize - away, frame as isize + away] {
            // An end is held: a rotation has no image beyond it that would not turn too far.
            let other = if round { other.rem_euclid(count) } else { other.clamp(0, count - 1) };
            let turn = turns[other as usize];
            let along: f64 = (0..4).map(|n| turn[n] * own[n]).sum();
            (0..4).for_each(|n| sum[n] += weight * if along < 0.0 { -turn[n] } else { turn[n] });
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frequency_keeps_what_the_filter_states() {
        for (part, kept) in [(0.5, 0.917), (1.0, 0.707), (2.0, 0.25)] {
            let frequency = 0.02 * part;
            let wave: Vec<f64> = (0..500).map(|frame| (std::f64::consts::TAU * frequency * frame as f64).sin()).collect();
            let after = averaged(&wave, &weights(0.02, 500), false);
            let greatest = after[100..400].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!((greatest - kept).abs() < 0.005, "{part}: {greatest}");
        }
    }

    #[test]
    fn a_steady_change_stays_to_the_ends_and_a_loop_goes_round() {
        let ramp: Vec<f64> = (0..40).map(f64::from).collect();
        let same = averaged(&ramp, &weights(0.05, 40), false);
        assert!(ramp.iter().zip(&same).all(|(a, b)| (a - b).abs() < 1e-9));
        let wave: Vec<f64> = (0..40).map(|frame| (std::f64::consts::TAU * f64::from(frame) / 40.0).cos()).collect();
        let round = averaged(&wave, &weights(0.1, 40), true);
        let kept = round[0] / wave[0];
        assert!(wave.iter().zip(&round).all(|(a, b)| (a * kept - b).abs() < 1e-9));
    }
}
