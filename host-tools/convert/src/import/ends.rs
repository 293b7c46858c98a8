//! End Sites for leaves that have none: without one, a bound on places does not see how the leaf turns.

use crate::motion::Joint;
use crate::note::{Note, NoteKind};

/// Gives every joint that turns and carries nothing an End Site as far away as the mean bone is long: in the direction of its own bone,
/// or upwards where it has none. Returns a warning that names one of them.
///
/// A joint with an End Site of length 0 keeps it: there the author says that turning does not count.
pub fn complete(joints: &mut Vec<Joint>) -> Option<Note> {
    let mut carries = vec![false; joints.len()];
    joints.iter().filter_map(|joint| joint.parent).for_each(|parent| carries[parent] = true);
    let turns = |joint: &Joint| joint.kinds.iter().any(|kind| !kind.is_position());
    let leaves: Vec<usize> = (0..joints.len()).filter(|&index| !carries[index] && turns(&joints[index])).collect();
    let first = joints[*leaves.first()?].name.clone();
    let length = mean_bone(joints);
    for &leaf in &leaves {
        let bone = joints[leaf].parent.map_or([0.0; 3], |_| joints[leaf].offset);
        let offset = match norm(bone) {
            0.0 => [0.0, length, 0.0],
            own => bone.map(|x| x / own * length),
        };
        joints.push(Joint { name: String::new(), parent: Some(leaf), offset, kinds: Vec::new(), end_site: true, helper: false });
    }
    let text = format!(
        "{} joints end without an End Site (`{first}` is one): each gets one {length:.4} units away, so that its rotation counts",
        leaves.len()
    );
    Some(Note::warning(NoteKind::Joints, text).of_joint(first))
}

/// The mean length of the bones that have one; 1 where none has.
fn mean_bone(joints: &[Joint]) -> f64 {
    let bones =
        joints.iter().filter(|joint| joint.parent.is_some()).map(|joint| norm(joint.offset)).filter(|length| *length > 0.0);
    let (count, sum) = bones.fold((0u32, 0.0), |(count, sum), length| (count + 1, sum + length));
    if count == 0 { 1.0 } else { sum / f64::from(count) }
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
