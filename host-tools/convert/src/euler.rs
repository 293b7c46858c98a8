//! Euler angles of a rotation.

use crate::fk::Matrix;
use std::f64::consts::PI;

/// The Euler angles, in degrees, about three different axes in order, that give `m`: of all that do, the nearest to `before`.
pub(crate) fn near(m: &Matrix, [i, j, k]: [usize; 3], before: [f64; 3]) -> [f64; 3] {
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
pub(crate) fn nearest(angle: f64, before: f64) -> f64 {
    angle - 360.0 * ((angle - before) / 360.0).round()
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
                let back = turn(near(&m, axes, [0.0; 3]));
                let off = (0..9).map(|n| (m[n / 3][n % 3] - back[n / 3][n % 3]).abs()).fold(0.0, f64::max);
                assert!(off < 1e-9, "{axes:?} {euler:?}: off by {off}");
                let near = near(&m, axes, euler);
                assert!((0..3).all(|n| (near[n] - euler[n]).abs() < 1e-4), "{axes:?} {euler:?}: {near:?}");
            }
        }
    }
}
