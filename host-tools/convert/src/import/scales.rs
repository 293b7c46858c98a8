//! Scales that change. A rig has none, so every joint below gets position channels that put it where the source has it, and the scale itself becomes scalars.

use crate::motion::{Motion, Scalar};
use crate::note::{Note, NoteKind, Remedy};

/// Part of a scale by which it may waver and still be constant. The joints below follow smaller changes, too.
const CONSTANT: f64 = 1e-5;

/// The axes along which a scale changes.
pub fn changing(scales: &[[f64; 3]]) -> Vec<usize> {
    let Some(first) = scales.first() else { return Vec::new() };
    let changes = |axis: &usize| scales.iter().any(|scale| (scale[*axis] - first[*axis]).abs() > CONSTANT * first[*axis].abs());
    (0..3).filter(changes).collect()
}

/// The name of a joint's scale along an axis.
pub fn name(joint: &str, axis: usize) -> String {
    format!("{joint}.scale.{}", ["x", "y", "z"][axis])
}

/// Scalars for the axes along which the scale of `joint` changes.
pub fn scalars(joint: &str, scales: &[[f64; 3]]) -> Vec<(Scalar, Vec<f64>)> {
    let of_axis = |axis: usize| {
        let values: Vec<f64> = scales.iter().map(|scale| scale[axis]).collect();
        let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        (Scalar { name: name(joint, axis), full_scale: if largest > 0.0 { largest } else { 1.0 } }, values)
    };
    changing(scales).into_iter().map(of_axis).collect()
}

/// Leaves out the scalars of joints' scales, which say nothing of another body. Returns how many joints had any.
pub fn leave_out(motion: &mut Motion) -> usize {
    let rig = &motion.rig;
    let scales: Vec<String> = rig.joints.iter().flat_map(|joint| (0..3).map(|axis| name(&joint.name, axis))).collect();
    let kept: Vec<bool> = rig.scalars.iter().map(|scalar| !scales.contains(&scalar.name)).collect();
    let joints = rig.joints.iter().filter(|joint| {
        let own = (0..3).map(|axis| name(&joint.name, axis));
        own.into_iter().any(|name| rig.scalars.iter().any(|scalar| scalar.name == name))
    });
    let count = joints.count();
    let channels = vec![true; rig.joint_channels()];
    let all: Vec<bool> = channels.into_iter().chain(kept.iter().copied()).collect();
    let mut own = all.iter();
    motion.values.retain(|_| *own.next().unwrap_or(&true));
    let mut own = all.iter();
    motion.keys.retain(|_| *own.next().unwrap_or(&true));
    let mut own = kept.iter();
    motion.rig.scalars.retain(|_| *own.next().unwrap_or(&true));
    count
}

/// What the user should know about the joints whose scales change.
pub fn warning(joints: &[&str]) -> Option<Note> {
    let first = joints.first()?;
    let others = match joints.len() - 1 {
        0 => String::new(),
        1 => " (and of 1 other joint)".into(),
        count => format!(" (and of {count} other joints)"),
    };
    let text = format!(
        "the scale of `{first}`{others} changes: the joints below keep their exact places, in position channels; the scale itself becomes \
         scalars such as `{first}.scale.y`"
    );
    Some(Note::warning(NoteKind::Scale, text).of_joint(*first).remedy(Remedy::DropScales))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_axes_that_change_become_scalars() {
        let scales = [[1.0, 2.0, -3.0], [1.000_001, 2.0, -3.0], [1.0, 2.5, -6.0]];
        let found = scalars("a", &scales);
        assert_eq!(found.iter().map(|(scalar, _)| scalar.name.as_str()).collect::<Vec<_>>(), ["a.scale.y", "a.scale.z"]);
        assert_eq!((found[1].0.full_scale, found[1].1.as_slice()), (6.0, &[-3.0, -3.0, -6.0][..]));
        assert!(warning(&[]).is_none() && warning(&["a", "b", "c"]).unwrap().text.contains("`a` (and of 2 other joints)"));
    }
}
