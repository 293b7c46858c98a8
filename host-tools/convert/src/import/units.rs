//! The unit of length of a source that does not state one.
//!
//! Rule: of the usual units, the one that makes the figure's rest height come nearest, as a ratio, to `ADULT_CM`.

use crate::error::{Error, Setting, require};
use crate::motion::{Joint, Motion};
use crate::note::{Note, NoteKind, Remedy};
use crate::number::Number;
use anyhow::Result;

/// Height that the guess aims at. Bones end below the crown, and above the sole: figures of adults measure 130 to 180 cm.
const ADULT_CM: f64 = 155.0;

/// The usual units, in cm. CMU's is an inch divided by the 0.45 that its skeletons are scaled with.
const USUAL: [(&str, f64); 5] = [("cm", 1.0), ("m", 100.0), ("inches (2.54 cm)", 2.54), ("CMU's 5.6444 cm", 5.6444), ("mm", 0.1)];

/// A figure outside of these heights is not taken for a person in any of the usual units.
const PLAUSIBLE_CM: std::ops::Range<f64> = 60.0..400.0;

/// The unit of `motion` in cm, and where it comes from: as the user says, else as the source says, else as guessed.
pub fn settle(motion: &Motion, user: Option<f64>, source: Option<f64>) -> Result<(f64, Note)> {
    let info = |text: String| Note::info(NoteKind::Unit, text);
    if let Some(cm) = user {
        let wrong = || Error::value(Setting::Unit, Number(cm), "expected a number above 0");
        require!(cm.is_finite() && cm > 0.0, wrong());
        return Ok((cm, info(format!("units: {} cm, as given", Number(cm)))));
    }
    if motion.rig.joints.is_empty() {
        return Ok((1.0, info("units: no joints, so none of length".into())));
    }
    if let Some(cm) = source {
        return Ok((cm, info(format!("units: {} cm, as the file says", Number(cm)))));
    }
    Ok(guess(rest_height(motion)))
}

/// The guess for a figure `height` units high.
fn guess(height: f64) -> (f64, Note) {
    let far = |cm: f64| (height * cm / ADULT_CM).ln().abs();
    let (name, cm) = USUAL.into_iter().min_by(|a, b| far(a.1).total_cmp(&far(b.1))).unwrap_or(USUAL[0]);
    let (cm, text) = match PLAUSIBLE_CM.contains(&(height * cm)) {
        true => (cm, format!("units: {height:.4} high at rest, so {name}")),
        false => (1.0, format!("units: {height:.4} high at rest fits no usual unit, so taken as cm")),
    };
    (cm, Note::info(NoteKind::Unit, text).remedy(Remedy::StateUnit))
}

/// Height of the figure at rest in cm, by the rig's own unit. For a figure of which no two joints are apart, 0.
pub fn rest_height_cm(motion: &Motion) -> f64 {
    rest_height(motion) * motion.rig.cm_per_unit
}

/// Height in cm that errors are shown in percent of: the way from head to foot where names tell it, else the extent at frame 0. `None` for
/// a motion without joints that are apart.
pub fn figure_height_cm(motion: &Motion) -> Option<f64> {
    let named = head_to_foot(&motion.rig.joints, &bones(motion)).map(|height| height * motion.rig.cm_per_unit);
    Some(named.unwrap_or_else(|| posed_height_cm(motion))).filter(|&height| height > 0.0)
}

/// Extent in cm of the figure at frame 0 along the axis where it is largest, without what only carries it: the joints before the first that
/// has several children.
pub fn posed_height_cm(motion: &Motion) -> f64 {
    let joints = &motion.rig.joints;
    let children = |joint: usize| joints.iter().filter(|other| other.parent == Some(joint)).count();
    let first = (0..joints.len()).find(|&joint| children(joint) > 1).unwrap_or(0);
    let places = crate::fk::positions(&motion.rig, &motion.values, 0);
    let along = |axis: usize| {
        let range = places[first..].iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        range.1 - range.0
    };
    if places.is_empty() { 0.0 } else { (0..3).map(along).fold(0.0, f64::max) }
}

/// The longest way along the bones from the end of a head to a foot, which no pose changes; without such names, the largest
/// extent at rest along an axis (files differ in which one is up).
fn rest_height(motion: &Motion) -> f64 {
    let bones = bones(motion);
    head_to_foot(&motion.rig.joints, &bones).unwrap_or_else(|| extent(&motion.rig.joints, &bones))
}

/// Each joint's place in its parent: the offset, or where frame 0 puts it if the offset is empty and channels replace it.
fn bones(motion: &Motion) -> Vec<[f64; 3]> {
    let firsts = motion.rig.first_channels();
    let place = |(joint, first): (&Joint, usize)| {
        let mut bone = joint.offset;
        if bone == [0.0; 3] {
            for (channel, kind) in joint.kinds.iter().enumerate().filter(|(_, kind)| kind.is_position()) {
                if let (Some(axis), Some(&value)) = (kind.axis(), motion.values[first + channel].first()) {
                    bone[axis] = value;
                }
            }
        }
        bone
    };
    motion.rig.joints.iter().zip(firsts).map(place).collect()
}

/// Foot joints and heads meet in a common ancestor: the way from one to the other passes no joint above it.
fn head_to_foot(joints: &[Joint], bones: &[[f64; 3]]) -> Option<f64> {
    let length = |joint: usize| bones[joint].iter().map(|x| x * x).sum::<f64>().sqrt();
    let named = |joint: usize, words: &[&str]| {
        let name = joints[joint].name.to_lowercase();
        words.iter().any(|word| name.contains(word))
    };
    let mut below_head = vec![false; joints.len()];
    // Longest way down from each joint to a head's end and to a foot.
    let mut head = vec![None; joints.len()];
    let mut foot = vec![None; joints.len()];
    for joint in 0..joints.len() {
        below_head[joint] = named(joint, &["head"]) || joints[joint].parent.is_some_and(|parent| below_head[parent]);
        head[joint] = below_head[joint].then_some(0.0);
        foot[joint] = named(joint, &["foot", "ankle"]).then_some(0.0);
    }
    let mut longest: Option<f64> = None;
    for joint in (1..joints.len()).rev() {
        let Some(parent) = joints[joint].parent else { continue };
        let to = |way: Option<f64>| way.map(|way| way + length(joint));
        let (up, down) = (to(head[joint]), to(foot[joint]));
        for (a, b) in [(up, foot[parent]), (down, head[parent])] {
            longest = a.zip(b).map(|(a, b)| a + b).into_iter().chain(longest).reduce(f64::max);
        }
        head[parent] = head[parent].into_iter().chain(up).reduce(f64::max);
        foot[parent] = foot[parent].into_iter().chain(down).reduce(f64::max);
    }
    longest.filter(|&way| way > 0.0)
}

fn extent(joints: &[Joint], bones: &[[f64; 3]]) -> f64 {
    let mut places: Vec<[f64; 3]> = Vec::with_capacity(joints.len());
    let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
    for (joint, bone) in joints.iter().zip(bones) {
        // The root's own offset is where the figure stands, and no part of it.
        let place = joint.parent.map_or([0.0; 3], |parent| std::array::from_fn(|axis| places[parent][axis] + bone[axis]));
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
        places.push(place);
    }
    (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_of_all_heights_get_their_unit() {
        for height_cm in [130.0, 150.0, 185.0] {
            for (_, cm) in USUAL {
                assert_eq!(guess(height_cm / cm).0, cm, "{height_cm} cm in units of {cm} cm");
            }
        }
    }

    #[test]
    fn the_guess_is_said() {
        let note = guess(24.6).1;
        assert_eq!((&*note.text, note.remedy), ("units: 24.6000 high at rest, so CMU's 5.6444 cm", Some(Remedy::StateUnit)));
        assert!(guess(0.0).1.text.contains("no usual unit"));
    }
}
