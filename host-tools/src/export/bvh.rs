//! BVH out: the joints, End Sites, channels and frames of a motion, for any other tool.

use crate::motion::{Kind, Motion, Rig};
use anyhow::{Context, Result, bail};
use std::fmt::Write as _;
use std::io::Write;
#[cfg(feature = "cli")]
use {
    crate::output::{Staged, commit},
    std::path::Path,
};

/// Writes `motion` to the output `path`: all of it, or the file stays as it was.
#[cfg(feature = "cli")]
pub fn save(motion: &Motion, path: &Path) -> Result<()> {
    let place = || path.display().to_string();
    let mut file = Staged::create(path)?;
    write(motion, &mut file).with_context(place)?;
    commit(vec![file])
}

/// Writes `motion` as BVH. Values carry seven decimals, so they come back within 5e-8 of their unit.
/// Fails on channels that BVH has no word for, naming the joint.
pub fn write(motion: &Motion, out: &mut impl Write) -> Result<()> {
    let mut text = String::from("HIERARCHY\n");
    let order = hierarchy(&motion.rig, &mut text)?;
    writeln!(text, "MOTION\nFrames: {}\nFrame Time: {}", motion.frames, trimmed(format!("{:.9}", motion.frame_time)))?;
    let firsts = motion.rig.first_channels();
    let channels: Vec<usize> =
        order.iter().flat_map(|&joint| (firsts[joint]..).take(motion.rig.joints[joint].kinds.len())).collect();
    for frame in 0..motion.frames {
        for (index, &channel) in channels.iter().enumerate() {
            text.push_str(if index == 0 { "" } else { " " });
            number(&mut text, motion.values[channel][frame])?;
        }
        text.push('\n');
        out.write_all(text.as_bytes())?;
        text.clear();
    }
    Ok(())
}

/// Writes the joints depth first, as BVH nests them, and returns their indices in that order.
fn hierarchy(rig: &Rig, text: &mut String) -> Result<Vec<usize>> {
    if let Some(scalar) = rig.scalars.first() {
        bail!("channel `{}` moves no joint, so BVH cannot hold it", scalar.name);
    }
    let mut children = vec![Vec::new(); rig.joints.len()];
    for (index, joint) in rig.joints.iter().enumerate() {
        if let Some(parent) = joint.parent {
            children[parent].push(index);
        }
    }
    let mut order = Vec::new();
    // Joints to open, and, as None, braces to close.
    let mut left = vec![Some(0)];
    let mut depth = 0;
    while let Some(next) = left.pop() {
        let Some(joint) = next else {
            depth -= 1;
            writeln!(text, "{}}}", "\t".repeat(depth))?;
            continue;
        };
        open(rig, joint, depth, text)?;
        order.push(joint);
        depth += 1;
        left.push(None);
        left.extend(children[joint].iter().rev().map(|&child| Some(child)));
    }
    Ok(order)
}

fn open(rig: &Rig, index: usize, depth: usize, text: &mut String) -> Result<()> {
    let joint = &rig.joints[index];
    let indent = "\t".repeat(depth);
    match (joint.end_site, joint.parent) {
        (true, _) => writeln!(text, "{indent}End Site")?,
        (false, None) => writeln!(text, "{indent}ROOT {}", name(rig, index))?,
        (false, Some(_)) => writeln!(text, "{indent}JOINT {}", name(rig, index))?,
    }
    write!(text, "{indent}{{\n{indent}\tOFFSET")?;
    for x in joint.offset {
        text.push(' ');
        number(text, x)?;
    }
    text.push('\n');
    if !joint.end_site {
        write!(text, "{indent}\tCHANNELS {}", joint.kinds.len())?;
        for &kind in &joint.kinds {
            write!(text, " {}", word(kind).with_context(|| format!("joint `{}`: BVH has no {kind:?}", joint.name))?)?;
        }
        text.push('\n');
    }
    Ok(())
}

fn word(kind: Kind) -> Option<&'static str> {
    Some(match kind {
        Kind::Xposition => "Xposition",
        Kind::Yposition => "Yposition",
        Kind::Zposition => "Zposition",
        Kind::Xrotation => "Xrotation",
        Kind::Yrotation => "Yrotation",
        Kind::Zrotation => "Zrotation",
        _ => return None,
    })
}

/// A joint's name on one line; braces would end it for a reader.
fn name(rig: &Rig, index: usize) -> String {
    let name = &rig.joints[index].name;
    let plain: String = name.chars().map(|c| if c.is_control() || matches!(c, '{' | '}') { '_' } else { c }).collect();
    if plain.trim().is_empty() { format!("joint{index}") } else { plain }
}

fn number(text: &mut String, value: f64) -> Result<()> {
    let start = text.len();
    write!(text, "{value:.7}")?;
    let kept = text[start..].trim_end_matches('0').trim_end_matches('.').len();
    text.truncate(start + kept);
    if &text[start..] == "-0" {
        text.replace_range(start.., "0");
    }
    Ok(())
}

fn trimmed(number: String) -> String {
    number.trim_end_matches('0').trim_end_matches('.').to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Joint, Scalar};

    fn joint(name: &str, parent: Option<usize>, kinds: &[Kind], end_site: bool) -> Joint {
        Joint { name: name.into(), parent, offset: [0.0, 1.5, -0.00000001], kinds: kinds.to_vec(), end_site }
    }

    fn motion(joints: Vec<Joint>, values: &[f64]) -> Motion {
        let rig = Rig { joints, scalars: Vec::new(), cm_per_unit: 1.0 };
        let keys = vec![None; values.len()];
        let values = values.iter().map(|&value| vec![value]).collect();
        Motion { rig, frame_time: 1.0 / 120.0, frames: 1, values, keys, looped: false }
    }

    #[test]
    fn joints_are_nested_and_channels_follow_them() {
        let joints = vec![
            joint("a {b}", None, &[Kind::Xposition], false),
            joint("left", Some(0), &[Kind::Xrotation], false),
            joint("right", Some(0), &[Kind::Yrotation], false),
            joint("", Some(1), &[], true),
        ];
        let mut out = Vec::new();
        write(&motion(joints, &[1.0, -0.25, 1e-9]), &mut out).unwrap();
        let expected = "HIERARCHY
ROOT a _b_
{
\tOFFSET 0 1.5 0
\tCHANNELS 1 Xposition
\tJOINT left
\t{
\t\tOFFSET 0 1.5 0
\t\tCHANNELS 1 Xrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 1.5 0
\t\t}
\t}
\tJOINT right
\t{
\t\tOFFSET 0 1.5 0
\t\tCHANNELS 1 Yrotation
\t}
}
MOTION
Frames: 1
Frame Time: 0.008333333
1 -0.25 0
";
        assert_eq!(String::from_utf8(out).unwrap(), expected);
    }

    #[test]
    fn what_bvh_cannot_hold_is_named_and_nothing_is_left() {
        let path = std::env::temp_dir().join(format!("pantin-export-{}.bvh", std::process::id()));
        let error = |motion: &Motion| format!("{:#}", save(motion, &path).unwrap_err());
        let quaternion = motion(vec![joint("hip", None, &[Kind::Wquaternion], false)], &[1.0]);
        assert!(error(&quaternion).contains("joint `hip`: BVH has no Wquaternion"));
        let mut scalar = motion(vec![joint("hip", None, &[], false)], &[1.0]);
        scalar.rig.scalars.push(Scalar { name: "smile".into(), full_scale: 1.0 });
        assert!(error(&scalar).contains("`smile`"));
        assert!(!path.exists() && !path.with_extension("bvh.part").exists());
    }
}
