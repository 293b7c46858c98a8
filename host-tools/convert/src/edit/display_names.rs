//! Which joints of a figure the display's joints stand for: by the usual names, or by a map file.

use super::sides::{Part, Side, parts};
use crate::error::{Error, Setting};
use crate::motion::Rig;
use crate::note::Remedy;
use anyhow::{Context, Result, anyhow, ensure};

/// The display's joints with their parents and the names, without their side, of what they stand for in the usual rigs, the best first:
/// CMU's BVH and ASF, Bandai Namco, Mixamo, Xia, Poser, H-Anim, 3ds Max. The chest is found by what hangs on it.
pub const DISPLAY: [(&str, Option<usize>, &[&str]); 15] = [
    ("Hips", None, &["hips", "hip", "pelvis", "sacroiliac", "root", "humanoidroot"]),
    ("Chest", Some(0), &[]),
    ("Head", Some(1), &["head", "skullbase", "skull"]),
    ("LeftUpperArm", Some(1), UPPER_ARM),
    ("LeftForearm", Some(3), FOREARM),
    ("LeftHand", Some(4), HAND),
    ("RightUpperArm", Some(1), UPPER_ARM),
    ("RightForearm", Some(6), FOREARM),
    ("RightHand", Some(7), HAND),
    ("LeftThigh", Some(0), THIGH),
    ("LeftShin", Some(9), SHIN),
    ("LeftFoot", Some(10), FOOT),
    ("RightThigh", Some(0), THIGH),
    ("RightShin", Some(12), SHIN),
    ("RightFoot", Some(13), FOOT),
];
const UPPER_ARM: &[&str] = &["upperarm", "arm", "humerus", "shldr", "shoulder"];
const FOREARM: &[&str] = &["forearm", "lowerarm", "radius", "elbow"];
const HAND: &[&str] = &["wrist", "hand"];
const THIGH: &[&str] = &["upleg", "upperleg", "thigh", "femur", "hip"];
const SHIN: &[&str] = &["leg", "lowerleg", "shin", "calf", "tibia", "knee"];
const FOOT: &[&str] = &["foot", "ankle"];
/// The chest and the head in [`DISPLAY`], and the joints that hang on the chest.
const CHEST: usize = 1;
const HEAD: usize = 2;
const ARMS: [usize; 2] = [3, 6];
/// Hips, chest and head of Blender's Rigify: bones of a spine that it numbers. Its limbs hang on none of them.
const RIGIFY: [(usize, &str); 3] = [(0, "spine"), (CHEST, "spine003"), (HEAD, "spine006")];

/// The source joint of each of the display's; `map` is a map file's text, whose lines go before names.
pub fn sources(rig: &Rig, map: &str) -> Result<[usize; 15]> {
    let found = completed(rig, mapped(rig, map)?);
    let missing: Vec<&str> = (0..15).filter(|&index| found[index].is_none()).map(|index| DISPLAY[index].0).collect();
    if !missing.is_empty() {
        let text = format!(
            "not found in the figure: {}. Name them in a map, a line each like `{} JOINT`, where JOINT is one of {}",
            missing.join(", "),
            missing[0],
            names(rig)
        );
        return Err(Error::setting(Setting::Retarget, text).remedy(Remedy::MapJoints).into());
    }
    Ok(std::array::from_fn(|index| found[index].unwrap_or_default()))
}

/// The joints of a body that others are put on, for which there is no map.
pub(crate) fn sources_of_body(rig: &Rig) -> Result<[usize; 15]> {
    let found = found(rig);
    let missing: Vec<&str> = (0..15).filter(|&index| found[index].is_none()).map(|index| DISPLAY[index].0).collect();
    if !missing.is_empty() {
        let text = format!(
            "not found in the body: {}. Its joints are {}. Take a figure whose joints have usual names, such as a clip of this one that was converted with other names",
            missing.join(", "),
            names(rig)
        );
        return Err(Error::setting(Setting::Body, text).into());
    }
    Ok(std::array::from_fn(|index| found[index].unwrap_or_default()))
}

/// The names of all joints, with commas between.
fn names(rig: &Rig) -> String {
    let names: Vec<&str> = rig.joints.iter().filter(|joint| !joint.end_site).map(|joint| joint.name.as_str()).collect();
    names.join(", ")
}

/// The joint of each of the display's by the usual names.
pub fn found(rig: &Rig) -> [Option<usize>; 15] {
    completed(rig, [None; 15])
}

/// The joints that are `found`, and for the others those with the usual names.
fn completed(rig: &Rig, mut found: [Option<usize>; 15]) -> [Option<usize>; 15] {
    let names: Vec<String> = rig.joints.iter().map(|joint| joint.name.clone()).collect();
    let parts = parts(&names);
    for (index, (name, _, words)) in DISPLAY.iter().enumerate() {
        found[index] = found[index].or_else(|| guess(&parts, name, words));
    }
    let spine = RIGIFY.map(|(_, rest)| parts.iter().position(|part| part.side.is_none() && part.rest == rest));
    if found[HEAD].is_none() && spine.iter().all(Option::is_some) {
        RIGIFY.iter().zip(spine).for_each(|(&(index, _), joint)| found[index] = found[index].or(joint));
    }
    if found[CHEST].is_none() {
        found[CHEST] =
            ARMS.iter().map(|&arm| found[arm]).collect::<Option<Vec<_>>>().and_then(|arms| fork(rig, arms[0], arms[1]));
    }
    found
}

fn guess(parts: &[Part], name: &str, words: &[&str]) -> Option<usize> {
    let side = if name.starts_with("Left") {
        Some(Side::Left)
    } else if name.starts_with("Right") {
        Some(Side::Right)
    } else {
        None
    };
    words.iter().find_map(|&word| {
        let is = |rest: &str| rest == word || rest == format!("joint{word}");
        parts.iter().position(|part| part.side == side && is(part.rest.trim_end_matches(|letter: char| letter.is_ascii_digit())))
    })
}

/// The lowest joint above both.
fn fork(rig: &Rig, a: usize, b: usize) -> Option<usize> {
    let above = |joint: usize| std::iter::successors(rig.joints[joint].parent, |&joint| rig.joints[joint].parent);
    above(a).find(|joint| above(b).any(|other| other == *joint))
}

fn mapped(rig: &Rig, map: &str) -> Result<[Option<usize>; 15]> {
    let mut found = [None; 15];
    for (number, line) in map.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        let Some(display) = line.split_whitespace().next() else { continue };
        let place = || format!("line {} of the map", number + 1);
        let joint = line[display.len()..].trim();
        ensure!(!joint.is_empty(), "{}: expected `{display} JOINT`", place());
        let index = DISPLAY.iter().position(|entry| entry.0.eq_ignore_ascii_case(display)).ok_or_else(|| {
            let names: Vec<&str> = DISPLAY.iter().map(|entry| entry.0).collect();
            anyhow!("{}: expected one of {}, found `{display}`", place(), names.join(", "))
        })?;
        let source = rig.joints.iter().position(|other| !other.end_site && other.name == joint);
        let source = source.with_context(|| format!("{}: the figure has no joint `{joint}`", place()))?;
        ensure!(found[index].is_none(), "{}: `{display}` has a joint already", place());
        ensure!(!found.contains(&Some(source)), "{}: `{joint}` stands for another joint already", place());
        found[index] = Some(source);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Joint;

    /// A figure of these names, the arms hanging on the third joint.
    fn rig(names: &[&str]) -> Rig {
        let joint = |(index, name): (usize, &&str)| Joint {
            name: name.to_string(),
            parent: (index > 0).then(|| [0, 0, 1, 2, 2, 4, 5, 2, 7, 8, 0, 10, 11, 0, 13, 14][index]),
            offset: [0.0; 3],
            kinds: Vec::new(),
            end_site: false,
            helper: false,
        };
        Rig { joints: names.iter().enumerate().map(joint).collect(), scalars: Vec::new(), cm_per_unit: 1.0, ..Rig::default() }
    }

    #[test]
    fn usual_names_are_known() {
        let expected = [0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
        let conventions = [
            "Hips Spine Spine1 Head LeftArm LeftForeArm LeftHand RightArm RightForeArm RightHand LeftUpLeg LeftLeg LeftFoot RightUpLeg RightLeg RightFoot",
            "mixamorig:Hips mixamorig:Spine mixamorig:Spine1 mixamorig:Head mixamorig:LeftArm mixamorig:LeftForeArm mixamorig:LeftHand mixamorig:RightArm mixamorig:RightForeArm mixamorig:RightHand mixamorig:LeftUpLeg mixamorig:LeftLeg mixamorig:LeftFoot mixamorig:RightUpLeg mixamorig:RightLeg mixamorig:RightFoot",
            "Hips Spine Chest Head UpperArm_L LowerArm_L Hand_L UpperArm_R LowerArm_R Hand_R UpperLeg_L LowerLeg_L Foot_L UpperLeg_R LowerLeg_R Foot_R",
            "root upperback thorax head lhumerus lradius lwrist rhumerus rradius rwrist lfemur ltibia lfoot rfemur rtibia rfoot",
            "Hips Chest Chest2 Head LeftShoulder LeftElbow LeftWrist RightShoulder RightElbow RightWrist LeftHip LeftKnee LeftAnkle RightHip RightKnee RightAnkle",
            "hip abdomen chest head lShldr lForeArm lHand rShldr rForeArm rHand lThigh lShin lFoot rThigh rShin rFoot",
            "HumanoidRoot vl5 vt6 skullbase l_shoulder l_elbow l_wrist r_shoulder r_elbow r_wrist l_hip l_knee l_ankle r_hip r_knee r_ankle",
        ];
        for names in conventions {
            let names: Vec<&str> = names.split(' ').collect();
            assert_eq!(sources(&rig(&names), "").unwrap_or_else(|error| panic!("{error:#}")), expected);
        }
    }

    #[test]
    fn the_spine_of_rigify_is_numbered_and_carries_no_limbs() {
        let names: Vec<&str> = "rig DEF-spine DEF-spine.001 DEF-spine.003 DEF-spine.006 DEF-upper_arm.L DEF-forearm.L DEF-hand.L DEF-upper_arm.R DEF-forearm.R DEF-hand.R DEF-thigh.L DEF-shin.L DEF-foot.L DEF-thigh.R DEF-shin.R DEF-foot.R".split(' ').collect();
        let parents = [0, 0, 1, 2, 3, 0, 5, 6, 0, 8, 9, 0, 11, 12, 0, 14, 15];
        let mut rig = rig(&names[..16]);
        rig.joints.push(Joint { name: names[16].into(), ..rig.joints[15].clone() });
        rig.joints.iter_mut().zip(parents).skip(1).for_each(|(joint, parent)| joint.parent = Some(parent));
        assert_eq!(sources(&rig, "").unwrap(), [1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);
        // A map's lines go before names.
        assert_eq!(sources(&rig, "Hips DEF-spine.001").unwrap()[..3], [2, 3, 4]);
    }

    #[test]
    fn what_is_missing_is_named_with_the_maps_form() {
        let names: Vec<&str> =
            "a b c Head LeftArm LeftForeArm LeftHand RightArm RightForeArm RightHand LeftUpLeg LeftLeg LeftFoot RightUpLeg RightLeg d".split(' ').collect();
        let rig = rig(&names);
        let error = sources(&rig, "").unwrap_err().to_string();
        assert!(
            error.contains("Hips, RightFoot. ")
                && error.contains("a line each like `Hips JOINT`, where JOINT is one of a, b, c,")
                && !error.contains('\n'),
            "{error}"
        );
        assert_eq!(sources(&rig, "# mine\nHips a # the root\n\nrightfoot d\n").unwrap()[14], 15);
        for (map, part) in [
            ("Hips a\nHips b", "line 2 of the map: `Hips` has a joint"),
            ("Hips a\nChest a", "line 2 of the map: `a` stands for"),
            ("Hips", "line 1 of the map: expected `Hips JOINT`"),
            ("\nHip a", "found `Hip`"),
            ("Hips z", "no joint `z`"),
        ] {
            let error = format!("{:#}", sources(&rig, map).unwrap_err());
            assert!(error.contains(part), "{error}");
        }
    }
}
