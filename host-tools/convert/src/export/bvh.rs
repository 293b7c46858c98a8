//! BVH out: the joints, End Sites, channels and frames of a motion, for any other tool.

use super::euler_frames::EulerFrames;
use crate::motion::{Frames, Joint, Kind, Rig};
use anyhow::{Context, Result, bail};
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::io::Write;

/// Which channels a file has, with Euler angles in place of quaternions and exponential maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// Those of the motion.
    Own,
    /// Three rotations a joint, as many readers demand: those that the motion has not are 0.
    ThreeRotations,
}

/// Writes `motion` as BVH. Values carry seven decimals, so they come back within 5e-8 of their unit. Quaternions and exponential maps become three Euler
/// angles: in the joint's own order if the rig has one, else z, x, y. Fails on what BVH cannot hold, and names it.
pub fn write(motion: &impl Frames, of: Columns, out: &mut impl Write) -> Result<()> {
    let motion = &EulerFrames::new(motion);
    let rig = motion.rig();
    let mut text = String::from("HIERARCHY\n");
    let order = hierarchy(rig, of, &mut text)?;
    writeln!(text, "MOTION\nFrames: {}\nFrame Time: {}", motion.frames(), trimmed(format!("{:.9}", motion.frame_time())))?;
    let firsts = rig.first_channels();
    let of_joint = |&joint: &usize| {
        columns(&rig.joints[joint], of).into_iter().map({
            let first = firsts[joint];
            move |(kind, at)| (at.map(|at| first + at), if kind.is_position() { LENGTH_DECIMALS } else { ANGLE_DECIMALS })
        })
    };
    let channels: Vec<(Option<usize>, usize)> = order.iter().flat_map(of_joint).collect();
    motion.each(&mut |pose| {
        for (index, &(channel, decimals)) in channels.iter().enumerate() {
            text.push_str(if index == 0 { "" } else { " " });
            number(&mut text, channel.map_or(0.0, |channel| pose[channel]), decimals)?;
        }
        text.push('\n');
        out.write_all(text.as_bytes())?;
        text.clear();
        Ok(())
    })?;
    // Of a motion without frames the hierarchy is still to be written.
    Ok(out.write_all(text.as_bytes())?)
}

/// Channels of a joint in the file, each with its place among the joint's own; rotations that are added come last.
fn columns(joint: &Joint, of: Columns) -> Vec<(Kind, Option<usize>)> {
    let mut columns: Vec<_> = joint.kinds.iter().enumerate().map(|(at, &kind)| (kind, Some(at))).collect();
    let three = of == Columns::ThreeRotations && !joint.end_site;
    if three && joint.kinds.iter().filter(|kind| kind.is_rotation()).count() < 3 {
        let missing = [Kind::Zrotation, Kind::Xrotation, Kind::Yrotation].into_iter().filter(|kind| !joint.kinds.contains(kind));
        columns.extend(missing.map(|kind| (kind, None)));
    }
    columns
}

/// Writes the joints depth first, as BVH nests them, and returns their indices in that order.
fn hierarchy(rig: &Rig, of: Columns, text: &mut String) -> Result<Vec<usize>> {
    let names = names(rig);
    if let Some(scalar) = rig.scalars.first() {
        bail!("channel `{}` moves no joint, so BVH cannot hold it", scalar.name);
    }
    if rig.joints.is_empty() {
        bail!("a motion without joints, so BVH cannot hold it; .csv holds any channels");
    }
    if let Some(second) = rig.joints.iter().skip(1).find(|joint| joint.parent.is_none()) {
        bail!("`{}` is a second root, and a BVH holds one figure", second.name);
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
        open(rig, of, joint, &names[joint], depth, text)?;
        order.push(joint);
        depth += 1;
        left.push(None);
        left.extend(children[joint].iter().rev().map(|&child| Some(child)));
    }
    Ok(order)
}

fn open(rig: &Rig, of: Columns, index: usize, name: &str, depth: usize, text: &mut String) -> Result<()> {
    let joint = &rig.joints[index];
    let indent = "\t".repeat(depth);
    match (joint.end_site, joint.parent) {
        (true, _) => writeln!(text, "{indent}End Site")?,
        (false, None) => writeln!(text, "{indent}ROOT {name}")?,
        (false, Some(_)) => writeln!(text, "{indent}JOINT {name}")?,
    }
    write!(text, "{indent}{{\n{indent}\tOFFSET")?;
    for x in joint.offset {
        text.push(' ');
        number(text, x, LENGTH_DECIMALS)?;
    }
    text.push('\n');
    if !joint.end_site {
        let columns = columns(joint, of);
        write!(text, "{indent}\tCHANNELS {}", columns.len())?;
        for (kind, _) in columns {
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

/// The joints' names as the file has them: on one line, and without braces, which would end them for a reader. A name that this changes
/// becomes none that another joint has.
pub fn names(rig: &Rig) -> Vec<String> {
    let plain = |(index, joint): (usize, &Joint)| {
        let plain: String = joint.name.chars().map(|c| if c.is_control() || matches!(c, '{' | '}') { '_' } else { c }).collect();
        if plain.trim().is_empty() { format!("joint{index}") } else { plain }
    };
    let mut names: Vec<String> = rig.joints.iter().enumerate().map(plain).collect();
    let changed: Vec<bool> = rig.joints.iter().zip(&names).map(|(joint, name)| !joint.end_site && joint.name != *name).collect();
    let mut taken: HashSet<String> =
        names.iter().zip(&changed).filter(|(_, changed)| !**changed).map(|(name, _)| name.clone()).collect();
    let mut numbers: HashMap<String, u32> = HashMap::new();
    for (name, _) in names.iter_mut().zip(changed).filter(|(_, changed)| *changed) {
        let plain = name.clone();
        let number = numbers.entry(plain.clone()).or_insert(1);
        while !taken.insert(name.clone()) {
            *number += 1;
            *name = format!("{plain}_{number}");
        }
    }
    names
}

/// Decimals of offsets and positions: figures may be 0.1 units high, and bounds a ten-thousandth of that.
const LENGTH_DECIMALS: usize = 9;
/// Decimals of angles: at the end of 100 m of bones what rounding takes is less than 1e-5 cm.
const ANGLE_DECIMALS: usize = 7;

fn number(text: &mut String, value: f64, decimals: usize) -> Result<()> {
    let start = text.len();
    write!(text, "{value:.decimals$}")?;
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
    use crate::motion::{Motion, Scalar};

    fn joint(name: &str, parent: Option<usize>, kinds: &[Kind], end_site: bool) -> Joint {
        Joint { name: name.into(), parent, offset: [0.0, 1.5, -0.00000001], kinds: kinds.to_vec(), end_site, helper: false }
    }

    fn motion(joints: Vec<Joint>, values: &[f64]) -> Motion {
        let rig = Rig { joints, scalars: Vec::new(), cm_per_unit: 1.0, ..Rig::default() };
        let keys = vec![None; values.len()];
        let values = values.iter().map(|&value| vec![value]).collect();
        Motion {
            rig,
            frame_time: 1.0 / 120.0,
            frames: 1,
            values,
            keys,
            looped: false,
            events: Vec::new(),
            origin: Default::default(),
        }
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
        write(&motion(joints, &[1.0, -0.25, 1e-9]), Columns::ThreeRotations, &mut out).unwrap();
        let expected = "HIERARCHY
ROOT a _b_
{
\tOFFSET 0 1.5 -0.00000001
\tCHANNELS 4 Xposition Zrotation Xrotation Yrotation
\tJOINT left
\t{
\t\tOFFSET 0 1.5 -0.00000001
\t\tCHANNELS 3 Xrotation Zrotation Yrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 1.5 -0.00000001
\t\t}
\t}
\tJOINT right
\t{
\t\tOFFSET 0 1.5 -0.00000001
\t\tCHANNELS 3 Yrotation Zrotation Xrotation
\t}
}
MOTION
Frames: 1
Frame Time: 0.008333333
1 0 0 0 -0.25 0 0 0 0 0
";
        assert_eq!(String::from_utf8(out).unwrap(), expected);
    }

    #[test]
    fn quaternions_and_exponential_maps_become_euler_angles() {
        use Kind::*;
        let joints = vec![
            joint("hip", None, &[Yposition, Wquaternion, Xquaternion, Yquaternion, Zquaternion], false),
            joint("knee", Some(0), &[Xexponential, Yexponential, Zexponential], false),
            joint("toe", Some(1), &[Xrotation, Yrotation, Zrotation, Wquaternion, Xquaternion, Yquaternion, Zquaternion], false),
        ];
        // A quarter turn about x; 30 degrees about y; 20 degrees about z, then a quaternion of no length, which turns nothing.
        let half = 0.5f64.sqrt();
        let mut motion = motion(joints, &[7.0, half, half, 0.0, 0.0, 0.0, 30.0, 0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 0.0]);
        // The opposite quaternion is the same rotation: the angles stay.
        motion.frames = 2;
        motion.values.iter_mut().for_each(|values| values.push(values[0]));
        motion.values[1..5].iter_mut().for_each(|values| values[1] = -values[1]);
        for of in [Columns::Own, Columns::ThreeRotations] {
            let mut out = Vec::new();
            write(&motion, of, &mut out).unwrap();
            let text = String::from_utf8(out).unwrap();
            let channels: Vec<&str> = text.lines().filter_map(|line| line.trim().strip_prefix("CHANNELS ")).collect();
            let expected = [
                "4 Yposition Zrotation Xrotation Yrotation",
                "3 Zrotation Xrotation Yrotation",
                "3 Xrotation Yrotation Zrotation",
            ];
            assert_eq!(channels, expected);
            let rows: Vec<&str> = text.lines().rev().take(2).collect();
            assert_eq!(rows, ["7 0 90 0 0 0 30 0 0 20"; 2]);
        }
    }

    #[test]
    fn what_bvh_cannot_hold_is_named() {
        let error = |motion: &Motion| format!("{:#}", write(motion, Columns::Own, &mut Vec::new()).unwrap_err());
        let mut scalar = motion(vec![joint("hip", None, &[], false)], &[1.0]);
        scalar.rig.scalars.push(Scalar { name: "smile".into(), full_scale: 1.0 });
        assert!(error(&scalar).contains("`smile`"));
    }
}
