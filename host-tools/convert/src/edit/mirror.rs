//! The motion as a mirror at x = 0 shows it, left and right exchanged.
//!
//! Each joint takes what its counterpart does: x of its places, and y and z of its turns, change their sign. That mirrors every
//! pose in world space whatever the rest pose is, and gives a symmetric figure its own rig again.

use super::scale::scaled;
use super::sides::{Part, counterparts, parts};
use crate::error::{Error, Setting, require};
use crate::motion::{Joint, Kind, Motion, Rig, Scalar};
use anyhow::Result;
use pantin::{LEFT_FOOT_DOWN, RIGHT_FOOT_DOWN};

/// Mirrors `motion`. Refuses a figure whose names have no sides, or whose sides are not built alike.
pub fn mirror(motion: &Motion) -> Result<Motion> {
    let rig = &motion.rig;
    let pairs = joint_pairs(rig)?;
    let names: Vec<String> = rig.scalars.iter().map(|scalar| scalar.name.clone()).collect();
    let scalar_parts = parts(&names);
    let scalar_pairs = counterparts(&scalar_parts);
    let sided =
        pairs.iter().enumerate().any(|(index, &pair)| index != pair) || scalar_parts.iter().any(|part| part.side.is_some());
    require!(sided, unsided("no names tell left from right, as LeftArm and RightArm, Arm_L and Arm_R or larm and rarm do"));
    let firsts = rig.first_channels();
    let mut out = motion.without_figure();
    for (joint, &pair) in rig.joints.iter().zip(&pairs) {
        let source = &rig.joints[pair];
        let [x, y, z] = source.offset;
        // 0 has no sign that is worth keeping.
        out.rig.joints.push(Joint { offset: [0.0 - x, y, z], kinds: source.kinds.clone(), ..joint.clone() });
        for (slot, &kind) in source.kinds.iter().enumerate() {
            take(motion, &mut out, firsts[pair] + slot, changes_sign(kind));
        }
    }
    for (index, scalar) in rig.scalars.iter().enumerate() {
        let pair = scalar_pairs[index].ok_or_else(|| unsided(format!("the scalar {} has no counterpart", scalar.name)))?;
        out.rig.scalars.push(Scalar { full_scale: rig.scalars[pair].full_scale, name: scalar.name.clone() });
        take(motion, &mut out, rig.joint_channels() + pair, turns_sideways(&scalar_parts[pair]));
    }
    for event in &mut out.events {
        event.name = match event.name.as_str() {
            LEFT_FOOT_DOWN => RIGHT_FOOT_DOWN.into(),
            RIGHT_FOOT_DOWN => LEFT_FOOT_DOWN.into(),
            _ => continue,
        };
    }
    Ok(out)
}

fn take(motion: &Motion, out: &mut Motion, channel: usize, negated: bool) {
    let sign = if negated { -1.0 } else { 1.0 };
    out.values.push(motion.values[channel].iter().map(|value| value * sign).collect());
    out.keys.push(motion.keys[channel].clone().map(|keys| scaled(keys, sign)));
}

/// Mirrored at x, places change along x, and turns about all other axes.
fn changes_sign(kind: Kind) -> bool {
    kind.axis().is_some_and(|axis| (axis == 0) == kind.is_position())
}

/// Whether a scalar counts a turn or a shift to one side, as faces' `headYaw`, `head_roll` and `shift_jaw` do. A tongue rolls both ways.
fn turns_sideways(part: &Part) -> bool {
    let has = |word: &str| part.rest.contains(word);
    has("yaw") || has("shift") || (has("roll") && !has("tongue"))
}

fn unsided(text: impl Into<String>) -> Error {
    Error::setting(Setting::Mirror, text)
}

/// Each joint's counterpart: the parents of two are two as well, and so are their ends.
fn joint_pairs(rig: &Rig) -> Result<Vec<usize>> {
    let names: Vec<String> = rig.joints.iter().map(|joint| joint.name.clone()).collect();
    let named = counterparts(&parts(&names));
    let mut pairs = Vec::with_capacity(named.len());
    for (index, joint) in rig.joints.iter().enumerate() {
        let lonely = || unsided(format!("{} has no counterpart on the other side of the figure", rig.joint_name(index)));
        let pair = match joint.parent {
            Some(parent) if joint.end_site => {
                ends(rig, pairs[parent]).nth(ends(rig, parent).position(|end| end == index).unwrap_or(0))
            }
            _ => named[index],
        };
        let pair = pair.ok_or_else(lonely)?;
        let alike = joint.parent.map(|parent| pairs[parent]) == rig.joints[pair].parent;
        let (own, other) = (rig.joint_name(index), rig.joint_name(pair));
        let apart = || format!("{own} and {other} are counterparts by their names, but not the joints that they hang on");
        require!(alike, unsided(apart()));
        pairs.push(pair);
    }
    let back = |&(index, &pair): &(usize, &usize)| pairs[pair] != index;
    if let Some((index, _)) = pairs.iter().enumerate().find(back) {
        let name = rig.joint_name(pairs[index]);
        return Err(unsided(format!("several joints are counterparts of {name} by their names")).into());
    }
    Ok(pairs)
}

/// The End Sites of a joint.
fn ends(rig: &Rig, joint: usize) -> impl Iterator<Item = usize> {
    (0..rig.joints.len()).filter(move |&index| rig.joints[index].end_site && rig.joints[index].parent == Some(joint))
}
