//! Some of a motion's joints and scalars.

use crate::error::{Error, Setting, require};
use crate::motion::{Joint, Motion, Rig};
use anyhow::Result;
use glob::{MatchOptions, Pattern};

/// The joints and scalars whose names one of the globs `keep` matches (all, if there is none), but for those that one of `drop` does.
///
/// A joint that is not kept goes with its ends, unless a kept one hangs below: then it stays, and is held as in the first frame.
pub fn pick(motion: &Motion, keep: &[String], drop: &[String]) -> Result<Motion> {
    let rig = &motion.rig;
    let kept = Choice::new(rig, keep, drop)?;
    let needed = needed(rig, &kept.joints);
    let mut out = motion.without_figure();
    let mut places = vec![None; rig.joints.len()];
    let firsts = rig.first_channels();
    for (index, joint) in rig.joints.iter().enumerate().filter(|&(index, _)| needed[index]) {
        places[index] = Some(out.rig.joints.len());
        out.rig.joints.push(Joint { parent: joint.parent.and_then(|parent| places[parent]), ..joint.clone() });
        for channel in firsts[index]..firsts[index] + joint.kinds.len() {
            take(motion, &mut out, channel, kept.joints[index]);
        }
    }
    for (index, scalar) in rig.scalars.iter().enumerate().filter(|&(index, _)| kept.scalars[index]) {
        out.rig.scalars.push(scalar.clone());
        take(motion, &mut out, rig.joint_channels() + index, true);
    }
    let setting = if keep.is_empty() { Setting::Drop } else { Setting::Joints };
    require!(out.rig.channels() > 0, Error::setting(setting, "no channel is left"));
    Ok(out)
}

fn take(motion: &Motion, out: &mut Motion, channel: usize, moves: bool) {
    let values = &motion.values[channel];
    out.values.push(if moves { values.clone() } else { vec![values[0]; values.len()] });
    out.keys.push(motion.keys[channel].clone().filter(|_| moves));
}

/// What the globs choose.
struct Choice {
    joints: Vec<bool>,
    scalars: Vec<bool>,
}

impl Choice {
    fn new(rig: &Rig, keep: &[String], drop: &[String]) -> Result<Choice> {
        let keep = globs(rig, Setting::Joints, keep)?;
        let drop = globs(rig, Setting::Drop, drop)?;
        let chosen = |name: &str| (keep.is_empty() || any(&keep, name)) && !any(&drop, name);
        // An End Site goes with the joint that it ends.
        let joints = rig.joints.iter().map(|joint| match joint.parent {
            Some(parent) if joint.end_site => chosen(&rig.joints[parent].name),
            _ => chosen(&joint.name),
        });
        Ok(Choice { joints: joints.collect(), scalars: rig.scalars.iter().map(|scalar| chosen(&scalar.name)).collect() })
    }
}

/// The kept joints and all above them.
fn needed(rig: &Rig, kept: &[bool]) -> Vec<bool> {
    let mut needed = kept.to_vec();
    for index in (0..needed.len()).rev() {
        if let Some(parent) = rig.joints[index].parent {
            needed[parent] |= needed[index];
        }
    }
    needed
}

const IN_ANY_CASE: MatchOptions =
    MatchOptions { case_sensitive: false, require_literal_separator: false, require_literal_leading_dot: false };

fn any(globs: &[Pattern], name: &str) -> bool {
    globs.iter().any(|glob| glob.matches_with(name, IN_ANY_CASE))
}

fn globs(rig: &Rig, setting: Setting, texts: &[String]) -> Result<Vec<Pattern>> {
    let joints = rig.joints.iter().filter(|joint| !joint.end_site).map(|joint| joint.name.as_str());
    let names: Vec<&str> = joints.chain(rig.scalars.iter().map(|scalar| scalar.name.as_str())).collect();
    let glob = |text: &String| {
        let glob = Pattern::new(text).map_err(|error| Error::value(setting, text, error.to_string()))?;
        let unknown = || Error::value(setting, text, format!("no joint or scalar is called so; there are {}", names.join(", ")));
        require!(names.iter().any(|name| any(std::slice::from_ref(&glob), name)), unknown());
        Ok(glob)
    };
    texts.iter().map(glob).collect()
}
