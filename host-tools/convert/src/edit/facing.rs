//! The direction in which a figure faces, and the joints by which it travels.

use super::display::{cross, norm};
use super::display_names::found;
use super::rotation::up;
use super::sides::{Side, counterparts, parts};
use crate::fk::positions;
use crate::motion::{Motion, Rig};

/// The two thighs and the two upper arms among the display's joints, left and right. The first pair that a figure has counts: shoulders turn more than the hips do.
const PAIRS: [(usize, usize); 2] = [(9, 12), (3, 6)];

/// The horizontal direction, of length 1, in which the figure faces in the mean of all frames. `None` if no names tell left from right, or if it turns to all sides.
pub(super) fn facing(motion: &Motion) -> Option<[f64; 3]> {
    let pairs = pairs(&motion.rig);
    let (mut sum, mut length) = ([0.0; 3], 0.0);
    for frame in 0..motion.frames {
        let places = positions(&motion.rig, &motion.values, frame);
        for &(left, right) in &pairs {
            let across: [f64; 3] = std::array::from_fn(|axis| places[left][axis] - places[right][axis]);
            let ahead = cross(across, up(&motion.rig));
            length += norm(ahead);
            (0..3).for_each(|axis| sum[axis] += ahead[axis]);
        }
    }
    let mean = norm(sum);
    (mean > UNCLEAR * length && mean > 0.0).then(|| sum.map(|x| x / mean))
}

/// Part of the single directions' lengths that their sum has at least: of a figure that turns to all sides it is nearly 0.
const UNCLEAR: f64 = 0.1;

/// Joints of the left side with those of the right.
fn pairs(rig: &Rig) -> Vec<(usize, usize)> {
    let roles = found(rig);
    if let Some(pair) = PAIRS.iter().find_map(|&(left, right)| Some((roles[left]?, roles[right]?))) {
        return vec![pair];
    }
    let parts = parts(&rig.joints.iter().map(|joint| joint.name.clone()).collect::<Vec<_>>());
    let others = counterparts(&parts);
    let left = (0..parts.len()).filter(|&index| parts[index].side == Some(Side::Left));
    left.filter_map(|index| Some((index, others[index]?))).collect()
}

/// The joints with positions that can carry the figure over the ground, the likeliest first: those that move horizontally, and then those that do not.
pub(super) fn carriers(motion: &Motion) -> Vec<usize> {
    let (firsts, up) = (motion.rig.first_channels(), motion.rig.up.axis());
    let placed = |&index: &usize| motion.rig.joints[index].kinds.iter().any(|kind| kind.is_position());
    let moves = |&index: &usize| {
        let kinds = motion.rig.joints[index].kinds.iter().enumerate();
        kinds.into_iter().any(|(slot, kind)| {
            let values = &motion.values[firsts[index] + slot];
            kind.is_position() && kind.axis() != Some(up) && values.iter().any(|value| *value != values[0])
        })
    };
    let (moving, still): (Vec<usize>, Vec<usize>) = (0..motion.rig.joints.len()).filter(placed).partition(moves);
    moving.into_iter().chain(still).collect()
}
