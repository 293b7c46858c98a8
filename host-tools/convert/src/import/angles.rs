//! Euler angles for a joint's rotations: the order that keeps farthest from gimbal lock, and no angle that stays 0.

use crate::euler;
use crate::fk::Matrix;
use crate::motion::Kind;

/// The orders, the usual one first: of equally good ones it is taken.
const ORDERS: [[usize; 3]; 6] = [[2, 0, 1], [1, 0, 2], [2, 1, 0], [0, 1, 2], [1, 2, 0], [0, 2, 1]];
/// Angles smaller than this, in degrees, are 0: the step of f32 near 1 turns a quaternion by as much.
const NOTHING: f64 = 1e-5;

/// Channels of `turns`, a rotation a frame: kinds and angles in degrees that run on past half a turn.
pub fn channels(turns: &[Matrix]) -> Vec<(Kind, Vec<f64>)> {
    // The sine of the second angle of order i, j, k is m[i][k] but for its sign.
    let sine = |order: &[usize; 3]| turns.iter().map(|m| m[order[0]][order[2]].abs()).fold(0.0, f64::max);
    // Rounding must not choose between orders that are equally good.
    let rank = |order: &[usize; 3]| (sine(order) * 1e4).round();
    let order = ORDERS.into_iter().min_by(|a, b| rank(a).total_cmp(&rank(b))).unwrap_or(ORDERS[0]);
    let mut before = [0.0; 3];
    let mut angles: [Vec<f64>; 3] = Default::default();
    for turn in turns {
        before = euler::near(turn, order, before);
        (0..3).for_each(|n| angles[n].push(before[n]));
    }
    let kinds = order.map(|axis| [Kind::Xrotation, Kind::Yrotation, Kind::Zrotation][axis]);
    let moving = |(_, values): &(Kind, Vec<f64>)| values.iter().any(|angle| angle.abs() > NOTHING);
    kinds.into_iter().zip(angles).filter(moving).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::{about, product};

    #[test]
    fn a_hinge_has_one_channel_and_runs_on() {
        for axis in 0..3 {
            let turns: Vec<Matrix> = (0..50).map(|frame| about(axis, f64::to_radians(20.0 * f64::from(frame)))).collect();
            let channels = channels(&turns);
            assert_eq!(channels.len(), 1);
            assert_eq!(channels[0].0.axis(), Some(axis));
            assert!((channels[0].1[49] - 980.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_order_keeps_from_gimbal_lock() {
        // A quarter turn about each axis in the middle of two others' small ones.
        for axis in 0..3 {
            let turn = |frame: i32| {
                let quarter = about(axis, f64::to_radians(80.0 + f64::from(frame)));
                product(&product(&about((axis + 1) % 3, 0.01 * f64::from(frame)), &quarter), &about((axis + 2) % 3, 0.1))
            };
            let channels = channels(&(0..20).map(turn).collect::<Vec<_>>());
            for (kind, values) in channels {
                let fastest = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
                assert!(fastest < 5.0, "{kind:?} runs by {fastest} degrees a frame");
            }
        }
    }
}
