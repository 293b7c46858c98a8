//! The lines that describe the figure, and the names of its channels.

use super::{Read, number, positive, wrong};
use crate::motion::{Joint, Kind, Rig, Scalar};
use pantin::codec::layout::{MAX_CHANNELS, MAX_JOINTS};

/// `joint NAME [parent NAME] offset X Y Z [channels KIND...]`: adds the joint that the words after `joint` describe.
pub fn joint(rig: &mut Rig, words: &[&str]) -> Read<()> {
    let [name, rest @ ..] = words else { return wrong("expected a name after `joint`") };
    check_unused(rig, name)?;
    let (parent, rest) = match rest {
        ["parent", parent, rest @ ..] => (Some(find(rig, parent)?), rest),
        _ if rig.joints.is_empty() => (None, rest),
        _ => return wrong(format!("expected `parent NAME` after `{name}`; only the first joint has none")),
    };
    let (offset, rest) = offset(rest)?;
    let kinds = match rest {
        [] => Vec::new(),
        ["channels", kinds @ ..] => {
            if let Some(at) = (1..kinds.len()).find(|&at| kinds[..at].contains(&kinds[at])) {
                return wrong(format!("`{name}` has the channel {} twice", kinds[at]));
            }
            kinds.iter().map(|word| kind(word)).collect::<Read<_>>()?
        }
        [word, ..] => return wrong(format!("expected `channels` or the end of the line, found `{word}`")),
    };
    rig.joints.push(Joint { name: (*name).into(), parent, offset, kinds, end_site: false, helper: false });
    Ok(())
}

/// `end parent NAME offset X Y Z`: adds an End Site.
pub fn end(rig: &mut Rig, words: &[&str]) -> Read<()> {
    let ["parent", parent, rest @ ..] = words else { return wrong("expected `end parent NAME offset X Y Z`") };
    check_room(rig)?;
    let parent = Some(find(rig, parent)?);
    let (offset, rest) = offset(rest)?;
    if let [word, ..] = rest {
        return wrong(format!("expected the end of the line, found `{word}`"));
    }
    rig.joints.push(Joint { name: String::new(), parent, offset, kinds: Vec::new(), end_site: true, helper: false });
    Ok(())
}

/// `scalar NAME scale NUMBER`: adds a channel that moves no joint.
pub fn scalar(rig: &mut Rig, words: &[&str]) -> Read<()> {
    let [name, "scale", scale] = words else { return wrong("expected `scalar NAME scale NUMBER`") };
    check_unused(rig, name)?;
    rig.scalars.push(Scalar { name: (*name).into(), full_scale: positive("scale", &[scale])? });
    Ok(())
}

fn check_room(rig: &Rig) -> Read<()> {
    if rig.joints.len() < MAX_JOINTS && rig.channels() < MAX_CHANNELS {
        return Ok(());
    }
    wrong(format!("more than a clip holds: {MAX_JOINTS} joints, {MAX_CHANNELS} channels"))
}

fn check_unused(rig: &Rig, name: &str) -> Read<()> {
    check_room(rig)?;
    let joints = rig.joints.iter().map(|joint| joint.name.as_str());
    let mut names = joints.chain(rig.scalars.iter().map(|scalar| scalar.name.as_str()));
    if names.any(|used| used == name) { wrong(format!("the name `{name}` is taken")) } else { Ok(()) }
}

fn find(rig: &Rig, name: &str) -> Read<usize> {
    let found = rig.joints.iter().position(|joint| !joint.end_site && joint.name == name);
    found.ok_or_else(|| format!("no joint `{name}` stands above this line").into())
}

fn offset<'a, 'w>(words: &'a [&'w str]) -> Read<([f64; 3], &'a [&'w str])> {
    match words {
        ["offset", x, y, z, rest @ ..] => Ok(([number(x)?, number(y)?, number(z)?], rest)),
        [word, ..] => wrong(format!("expected `offset X Y Z`, found `{word}`")),
        [] => wrong("expected `offset X Y Z`, found the end of the line"),
    }
}

fn kind(word: &str) -> Read<Kind> {
    let found = Kind::ALL.into_iter().find(|kind| *kind != Kind::Scalar && format!("{kind:?}") == word);
    found.ok_or_else(|| {
        format!("expected a channel such as Xrotation, Yposition, Wquaternion or Zexponential, found `{word}`").into()
    })
}

/// Channels that `name` stands for: a joint's, one of a joint's (`hip.Xrotation`), or a scalar's.
pub fn channels(rig: &Rig, name: &str) -> Read<Vec<usize>> {
    let firsts = rig.first_channels();
    if let Some(joint) = rig.joints.iter().position(|joint| !joint.end_site && joint.name == name) {
        return Ok((firsts[joint]..).take(rig.joints[joint].kinds.len()).collect());
    }
    let of_joint = name.rsplit_once('.').and_then(|(joint, word)| {
        let joint = rig.joints.iter().position(|other| !other.end_site && other.name == joint)?;
        Some(firsts[joint] + rig.joints[joint].kinds.iter().position(|kind| format!("{kind:?}") == word)?)
    });
    let of_scalar = || Some(rig.joint_channels() + rig.scalars.iter().position(|scalar| scalar.name == name)?);
    let found = of_joint.or_else(of_scalar);
    found.map(|channel| vec![channel]).ok_or_else(|| format!("no joint or channel `{name}`").into())
}

/// The components of a quaternion or an exponential map mean nothing apart (docs/METHOD.md 1): all of a joint's or none.
pub fn check_groups(rig: &Rig, channels: &[usize]) -> Read<()> {
    let kinds = rig.channel_kinds();
    let grouped = |kind: Kind| kind.is_quaternion() || kind.is_exponential();
    for &channel in channels {
        let (joint, kind) = kinds[channel];
        let mut same = (0..kinds.len()).filter(|&other| kinds[other].0 == joint && grouped(kinds[other].1));
        if grouped(kind) && same.any(|other| !channels.contains(&other)) {
            let name = rig.channel_name(channel);
            return wrong(format!("`{name}` is one of a group; expected all of its joint's components in one `keys`"));
        }
    }
    Ok(())
}
