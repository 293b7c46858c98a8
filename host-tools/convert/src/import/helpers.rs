//! Joints that only steer others: targets and poles of IK chains, controls, copies of a bone.

use crate::motion::Rig;

/// Words of which a helper's name has one.
const WORDS: [&str; 9] = ["ik", "pole", "target", "ctrl", "control", "effector", "handle", "poletarget", "iktarget"];

/// Marks the joints of `rig` that only steer: those whose names say so, and second copies of a bone at its place (`Arm.001` beside `Arm`), as long as nothing else hangs
/// on them. Returns how many.
pub fn mark(rig: &mut Rig) -> usize {
    let named: Vec<bool> =
        (0..rig.joints.len()).map(|joint| joint > 0 && (steers(&rig.joints[joint].name) || is_copy(rig, joint))).collect();
    let mut helpers: Vec<bool> = (0..rig.joints.len()).map(|joint| named[joint] || rig.joints[joint].end_site).collect();
    // What bears a limb is one.
    for joint in (0..rig.joints.len()).rev() {
        if let (false, Some(parent)) = (helpers[joint], rig.joints[joint].parent) {
            helpers[parent] = false;
        }
    }
    // An End Site goes with the joint that it ends.
    let mut count = 0;
    for (joint, helper) in rig.joints.iter_mut().zip(helpers) {
        joint.helper = helper && !joint.end_site;
        count += usize::from(joint.helper);
    }
    // Nothing would be left to draw.
    let drawn = rig.joints.iter().skip(1).any(|joint| !joint.helper && !joint.end_site);
    if !drawn {
        rig.joints.iter_mut().for_each(|joint| joint.helper = false);
        count = 0;
    }
    count
}

/// Whether one of the words of a name says so: `IK_Foot_L`, `kneePoleTarget.R`, `foot.ik.L`, `LeftFootIK`.
fn steers(name: &str) -> bool {
    let mut words: Vec<String> = Vec::new();
    let mut before = ' ';
    for letter in name.chars() {
        if letter.is_alphabetic() {
            let begins = !before.is_alphabetic() || (letter.is_uppercase() && before.is_lowercase());
            if begins || words.is_empty() {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.extend(letter.to_lowercase());
            }
        }
        before = letter;
    }
    words.iter().any(|word| WORDS.contains(&word.as_str()))
}

/// Whether the joint is `NAME.001` with a sibling `NAME` at the same place in their parent.
fn is_copy(rig: &Rig, joint: usize) -> bool {
    let own = &rig.joints[joint];
    let Some((name, digits)) = own.name.rsplit_once('.') else { return false };
    let numbered = digits.len() == 3 && digits.bytes().all(|byte| byte.is_ascii_digit());
    let size = own.offset.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    let same = |other: &crate::motion::Joint| {
        other.name == name
            && other.parent == own.parent
            && other.offset.iter().zip(&own.offset).all(|(a, b)| (a - b).abs() <= 1e-4 * size)
    };
    numbered && rig.joints.iter().any(same)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Joint;

    fn rig(joints: &[(&str, Option<usize>)]) -> Rig {
        let joint = |&(name, parent): &(&str, Option<usize>)| Joint {
            name: name.into(),
            parent,
            offset: [0.0, 1.0, 0.0],
            kinds: Vec::new(),
            end_site: name.is_empty(),
            helper: false,
        };
        Rig { joints: joints.iter().map(joint).collect(), cm_per_unit: 1.0, ..Rig::default() }
    }

    fn marked(joints: &[(&str, Option<usize>)]) -> Vec<String> {
        let mut rig = rig(joints);
        mark(&mut rig);
        rig.joints.into_iter().filter(|joint| joint.helper).map(|joint| joint.name).collect()
    }

    #[test]
    fn what_steers_is_marked_and_what_bears_a_limb_is_not() {
        let found = marked(&[
            ("Root", None),
            ("Hips", Some(0)),
            ("IK_Foot_L", Some(0)),
            ("", Some(2)),
            ("kneePoleTarget.R", Some(0)),
            ("LeftFootIK", Some(1)),
            ("Striker", Some(1)),
            ("hand_ctrl", Some(0)),
            ("Arm", Some(7)),
            ("Arm.001", Some(7)),
        ]);
        assert_eq!(found, ["IK_Foot_L", "kneePoleTarget.R", "LeftFootIK", "Arm.001"]);
    }

    #[test]
    fn a_chain_of_numbered_bones_stays_and_so_does_a_figure_of_controls_alone() {
        assert!(marked(&[("Bone", None), ("Bone.001", Some(0)), ("Bone.002", Some(1))]).is_empty());
        assert!(marked(&[("Root", None), ("ctrl", Some(0)), ("ik", Some(1))]).is_empty());
    }
}
