//! How the channels of a clip's joints and scalars are coded.

use crate::output::clean;
use pantin::{Clip, Joint};
use pantin_convert::facts::{self, Channel, Status};
use serde_json::{Value, json};

/// Joints and scalars with how they are coded; `channels` are the pose's.
pub(super) fn rig_json(clip: &Clip, channels: &[Channel]) -> Value {
    let channel = |(index, channel): (usize, &Channel)| {
        let mut object = json!({"channel": index, "kind": format!("{:?}", channel.kind), "track": word(channel.status)});
        if let (Status::Follows(leader), Some(object)) = (channel.status, object.as_object_mut()) {
            object.insert("leader".into(), json!(leader));
        }
        object
    };
    let of_joint = |(index, joint): (usize, Joint)| {
        let kinds: Vec<_> = clip.kinds(index).collect();
        let first = usize::from(joint.first_channel);
        let mine = channels.iter().enumerate().skip(first).take(kinds.len());
        json!({
            "name": joint.name(),
            "parent": joint.parent,
            "end_site": joint.end_site,
            "rotation": facts::rotation(&kinds),
            "channels": mine.map(channel).collect::<Vec<_>>(),
        })
    };
    let rig = clip.rig();
    let joints: Vec<Value> = rig.joints().enumerate().map(of_joint).collect();
    let scalars = channels.iter().enumerate().skip(rig.joint_channels());
    let scalars: Vec<Value> = rig
        .scalars()
        .zip(scalars)
        .map(|(scalar, entry)| {
            let mut object = channel(entry);
            if let Some(object) = object.as_object_mut() {
                object.insert("name".into(), json!(scalar.name()));
            }
            object
        })
        .collect();
    json!({"joints": joints, "scalars": scalars})
}

fn word(status: Status) -> &'static str {
    match status {
        Status::Constant => "constant",
        Status::Moving => "moving",
        Status::Follows(_) => "follows",
    }
}

/// One line for each joint with channels, and for each scalar: its first channel and how it is coded.
pub(super) fn table(clip: &Clip, channels: &[Channel]) -> Vec<String> {
    let rig = clip.rig();
    let joints = rig.joints().enumerate().map(|(index, joint)| {
        let kinds: Vec<_> = clip.kinds(index).collect();
        let positions = facts::positions(&kinds);
        let positions = if positions.is_empty() { positions } else { format!("position {positions}") };
        let coded = [positions, facts::rotation(&kinds)].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>();
        (clean(joint.name()), usize::from(joint.first_channel), kinds.len(), coded.join("; "))
    });
    let scalars = rig.scalars().enumerate();
    let scalars = scalars.map(|(index, scalar)| (clean(scalar.name()), rig.joint_channels() + index, 1, "scalar".to_string()));
    let rows: Vec<_> = joints.chain(scalars).filter(|(_, _, count, _)| *count > 0).collect();
    let wide = rows.iter().map(|(name, ..)| name.chars().count()).max().unwrap_or(0).max(5);
    let mut lines = vec![String::new(), format!("{:wide$} {:>9}  {:28} tracks", "joint", "channels", "coded as")];
    for (name, first, count, coded) in rows {
        let span = if count == 1 { first.to_string() } else { format!("{first}-{}", first + count - 1) };
        lines.push(format!("{name:wide$} {span:>9}  {coded:28} {}", tracks(&channels[first..first + count])));
    }
    lines
}

/// `2 moving, 1 constant`, and which channels are followed.
fn tracks(channels: &[Channel]) -> String {
    let count = |status: Status| channels.iter().filter(|channel| channel.status == status).count();
    let mut parts = Vec::new();
    for track in [Status::Moving, Status::Constant] {
        if count(track) > 0 {
            parts.push(format!("{} {}", count(track), word(track)));
        }
    }
    parts.extend(channels.iter().filter_map(|channel| match channel.status {
        Status::Follows(leader) => Some(format!("1 follows channel {leader}")),
        _ => None,
    }));
    parts.join(", ")
}
