//! Scales that change. A rig has none, so every joint below gets position channels that put it where the source has it, and the scale itself becomes scalars.

use crate::motion::{Joint, Motion, Scalar};
use crate::note::{Note, NoteKind, Remedy};
use std::collections::HashSet;

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
    let of_joint = |joint: &Joint| [0, 1, 2].map(|axis| name(&joint.name, axis));
    let scales: HashSet<String> = rig.joints.iter().flat_map(of_joint).collect();
    let channels = rig.joint_channels();
    let kept: Vec<bool> = rig.scalars.iter().map(|scalar| !scales.contains(&scalar.name)).collect();
    let scaled = |joint: &&Joint| of_joint(joint).iter().any(|name| rig.scalars.iter().any(|scalar| scalar.name == *name));
    let count = rig.joints.iter().filter(scaled).count();
    let is_kept = |channel: usize| channel.checked_sub(channels).is_none_or(|scalar| kept[scalar]);
    motion.values = retained(std::mem::take(&mut motion.values), is_kept);
    motion.keys = retained(std::mem::take(&mut motion.keys), is_kept);
    motion.rig.scalars = retained(std::mem::take(&mut motion.rig.scalars), |scalar| kept[scalar]);
    count
}

/// Those whose numbers are kept.
fn retained<T>(all: Vec<T>, is_kept: impl Fn(usize) -> bool) -> Vec<T> {
    all.into_iter().enumerate().filter(|(number, _)| is_kept(*number)).map(|(_, one)| one).collect()
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
    use crate::motion::{Kind, Rig};
    use pantin::Up;

    #[test]
    fn only_axes_that_change_become_scalars() {
        let scales = [[1.0, 2.0, -3.0], [1.000_001, 2.0, -3.0], [1.0, 2.5, -6.0]];
        let found = scalars("a", &scales);
        assert_eq!(found.iter().map(|(scalar, _)| scalar.name.as_str()).collect::<Vec<_>>(), ["a.scale.y", "a.scale.z"]);
        assert_eq!((found[1].0.full_scale, found[1].1.as_slice()), (6.0, &[-3.0, -3.0, -6.0][..]));
        assert!(warning(&[]).is_none() && warning(&["a", "b", "c"]).unwrap().text.contains("`a` (and of 2 other joints)"));
    }

    #[test]
    fn scales_of_joints_are_left_out_and_other_scalars_stay() {
        let joint = |name: &str| Joint {
            name: name.into(),
            parent: None,
            offset: [0.0; 3],
            kinds: vec![Kind::Xrotation],
            end_site: false,
            helper: false,
        };
        let scalar = |name: &str| Scalar { name: name.into(), full_scale: 1.0 };
        let rig = Rig {
            joints: vec![joint("hip"), joint("knee")],
            scalars: ["hip.scale.x", "smile", "hip.scale.z", "hair.scale.x"].map(scalar).into(),
            cm_per_unit: 1.0,
            up: Up::Y,
        };
        let values: Vec<Vec<f64>> = (0..6).map(|channel| vec![f64::from(channel)]).collect();
        let mut motion = Motion {
            rig,
            frame_time: 0.1,
            frames: 1,
            values,
            keys: vec![None; 6],
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        };
        assert_eq!(leave_out(&mut motion), 1);
        assert_eq!(motion.rig.scalars, ["smile", "hair.scale.x"].map(scalar));
        assert_eq!((motion.values, motion.keys.len()), (vec![vec![0.0], vec![1.0], vec![3.0], vec![5.0]], 4));
    }
}
