//! A joint's rotation, read from its channels as a matrix and written to them whatever their kinds.

use crate::euler::{near, nearest};
use crate::fit::figure::exponential_near;
use crate::fk::{self, Matrix, product};
use crate::motion::{Joint, Kind, Motion, Rig};

/// The vertical direction of a rig's world, of length 1.
pub(crate) fn up(rig: &Rig) -> [f64; 3] {
    let mut vector = [0.0; 3];
    vector[rig.up.axis()] = if rig.up.is_negative() { -1.0 } else { 1.0 };
    vector
}

/// A joint's rotation in its parent at a frame; `first` is its first channel.
pub(crate) fn local(motion: &Motion, joint: usize, first: usize, frame: usize) -> Matrix {
    fk::local(&motion.rig.joints[joint], |slot| motion.values[first + slot][frame]).0
}

/// The angle in radians of the part of a rotation that is about an axis; the rest is about axes at right angles to it.
pub(crate) fn twist(turn: &Matrix, axis: usize) -> f64 {
    let quaternion = fk::quaternion(turn);
    2.0 * quaternion[axis].atan2(quaternion[3])
}

/// Whether a joint's channels can turn it in any way.
pub(crate) fn turns_freely(joint: &Joint) -> bool {
    let axes = angle_axes(joint);
    let own = joint.kinds.iter().any(|kind| kind.is_exponential() || kind.is_quaternion());
    own || axes.len() == 3 && [0, 1, 2].iter().all(|axis| axes.contains(axis))
}

fn angle_axes(joint: &Joint) -> Vec<usize> {
    joint.kinds.iter().filter(|kind| kind.is_rotation()).filter_map(|kind| kind.axis()).collect()
}

/// Writes a rotation to a joint's channels, from `first` on, at a frame: of all values that stand for it those nearest to the frame before. A joint with one or two
/// angles turns as far as these go. Places stay as they are.
pub(crate) fn write(rig_joint: &Joint, first: usize, values: &mut [Vec<f64>], frame: usize, turn: &Matrix) {
    let before: Vec<f64> = (0..rig_joint.kinds.len()).map(|slot| values[first + slot][frame.saturating_sub(1)]).collect();
    let own = rig_joint.kinds.iter().copied().enumerate();
    let mut set = |slot: usize, value: f64| values[first + slot][frame] = value;
    if rig_joint.kinds.iter().any(|kind| kind.is_quaternion()) {
        let [x, y, z, w] = fk::quaternion(turn);
        let component = |kind: Kind| kind.axis().map_or(w, |axis| [x, y, z][axis]);
        let quaternion: Vec<(usize, f64)> =
            own.clone().filter(|(_, kind)| kind.is_quaternion()).map(|(slot, kind)| (slot, component(kind))).collect();
        let along: f64 = quaternion.iter().map(|&(slot, value)| value * before[slot]).sum();
        quaternion.iter().for_each(|&(slot, value)| set(slot, if along < 0.0 { -value } else { value }));
        own.filter(|(_, kind)| kind.is_rotation() || kind.is_exponential()).for_each(|(slot, _)| set(slot, 0.0));
    } else if rig_joint.kinds.iter().any(|kind| kind.is_exponential()) {
        let mut last = [0.0; 3];
        let maps: Vec<(usize, usize)> =
            own.clone().filter(|(_, kind)| kind.is_exponential()).map(|(slot, kind)| (slot, kind.axis().unwrap_or(0))).collect();
        maps.iter().for_each(|&(slot, axis)| last[axis] = before[slot]);
        let map = exponential_near(turn, last);
        maps.iter().for_each(|&(slot, axis)| set(slot, map[axis]));
        own.filter(|(_, kind)| kind.is_rotation()).for_each(|(slot, _)| set(slot, 0.0));
    } else {
        let slots: Vec<usize> = own.filter(|(_, kind)| kind.is_rotation()).map(|(slot, _)| slot).collect();
        let last: Vec<f64> = slots.iter().map(|&slot| before[slot]).collect();
        let angles = angles(&angle_axes(rig_joint), turn, &last);
        slots.iter().zip(angles).for_each(|(&slot, angle)| set(slot, angle));
    }
}

/// Angles in degrees about one to three axes, one after the other, for a rotation; those after the third stay.
fn angles(axes: &[usize], turn: &Matrix, before: &[f64]) -> Vec<f64> {
    match *axes {
        [axis] => vec![nearest(twist(turn, axis).to_degrees(), before[0])],
        [first, second] if first != second => {
            let found = near(turn, [first, second, 3 - first - second], [before[0], before[1], 0.0]);
            found[..2].to_vec()
        }
        [first, second, third] if first != second && second != third && first != third => {
            near(turn, [first, second, third], [before[0], before[1], before[2]]).to_vec()
        }
        // An axis that comes twice: the first angle alone, which is rare enough.
        [first, .., _] => {
            let mut all = before.to_vec();
            all[0] = nearest(twist(turn, first).to_degrees(), before[0]);
            all
        }
        [] => Vec::new(),
    }
}

/// The rotation that is a part of the way from one to another.
pub(crate) fn between(from: &Matrix, to: &Matrix, part: f64) -> Matrix {
    let difference = product(&super::display::transposed(from), to);
    let vector = exponential_near(&difference, [0.0; 3]).map(|degrees| (degrees * part).to_radians());
    product(from, &fk::from_exponential(vector))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fk::about;

    fn joint(kinds: &[Kind]) -> Joint {
        Joint { name: "a".into(), parent: None, offset: [0.0; 3], kinds: kinds.to_vec(), end_site: false, helper: false }
    }

    #[test]
    fn a_rotation_comes_back_from_every_kind_of_channels() {
        use Kind::*;
        let turn = product(&about(1, 0.7), &product(&about(0, -1.1), &about(2, 2.0)));
        for kinds in [
            vec![Xposition, Zrotation, Xrotation, Yrotation],
            vec![Xexponential, Yexponential, Zexponential],
            vec![Wquaternion, Xquaternion, Yquaternion, Zquaternion],
        ] {
            let joint = joint(&kinds);
            assert!(turns_freely(&joint));
            let mut values = vec![vec![5.0]; kinds.len()];
            write(&joint, 0, &mut values, 0, &turn);
            let back = fk::local(&joint, |slot| values[slot][0]).0;
            assert!((0..9).all(|n| (turn[n / 3][n % 3] - back[n / 3][n % 3]).abs() < 1e-9), "{kinds:?}: {values:?}");
            assert!(kinds[0] != Xposition || values[0][0] == 5.0, "places stay");
        }
    }

    #[test]
    fn a_hinge_turns_as_far_as_it_goes() {
        let joint = joint(&[Kind::Xrotation]);
        assert!(!turns_freely(&joint));
        let mut values = vec![vec![350.0, 0.0]];
        write(&joint, 0, &mut values, 1, &about(0, 0.2));
        assert!((values[0][1] - 360.0 - 0.2_f64.to_degrees()).abs() < 1e-9, "the angle nearest to the one before");
    }

    #[test]
    fn half_the_way_is_half_the_angle() {
        let half = between(&about(1, 0.2), &about(1, 1.0), 0.5);
        assert!((twist(&half, 1) - 0.6).abs() < 1e-12);
    }
}
