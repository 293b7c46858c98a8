//! What a decoder must make of a vector: `NAME.json`.
//!
//! `crcs` has one CRC a frame: CRC-16/IBM-3740 of the pose's raw values as little-endian 32-bit integers, in hexadecimal.
//! `poses` has whole poses by frame, as raw values. The other fields are the clip's own, as it tells them.

use std::path::Path;

use anyhow::{Context, Result};
use conformance::Play;
use pantin::{ChannelState, Clip};
use serde_json::{Map, Value, json};

use super::json;

/// Most values of whole poses in a record.
const POSE_VALUES: usize = 400;

/// The CRC of every frame, step by step, and of those that [`conformance::sought`] names, by seeking.
#[derive(Debug, Default)]
pub struct Crcs {
    /// One a frame.
    pub stepped: Vec<u16>,
    /// One a frame sought.
    pub sought: Vec<u16>,
}

/// Plays a clip.
pub fn crcs(clip: &Clip<'_>) -> Result<Crcs> {
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut found = Crcs { stepped: vec![], sought: vec![] };
    conformance::play(*clip, &mut states, &mut pose, &mut |way, crc| match way {
        Play::Progress => found.stepped.push(crc),
        Play::Seek => found.sought.push(crc),
    })?;
    Ok(found)
}

/// The text of a clip's record.
pub fn of(clip: &Clip<'_>) -> Result<String> {
    let crcs: Vec<String> = crcs(clip)?.stepped.iter().map(|crc| format!("{crc:04x}")).collect();
    let events: Vec<Value> = clip.events().map(|event| json!([event.frame, event.id])).collect();
    let names: Vec<String> = clip.event_names().map(|name| String::from_utf8_lossy(name).into_owned()).collect();
    let joints = clip.rig().joints().enumerate();
    let helpers: Vec<usize> = joints.filter(|(_, joint)| joint.helper).map(|(index, _)| index).collect();
    let exponentials: Vec<usize> = (0..clip.rig().joint_count()).filter(|&joint| clip.is_exponential(joint)).collect();
    Ok(json::text(&[
        ("frames", json!(clip.frames())),
        ("frame_time_ns", json!(clip.frame_time_ns())),
        ("looped", json!(clip.looped())),
        ("joints", json!(clip.rig().joint_count())),
        ("channels", json!(clip.rig().channels())),
        ("moving", json!(clip.moving())),
        ("length_exponent", json!(clip.length_exponent())),
        ("exponential_joints", json!(exponentials)),
        ("events", json!(events)),
        ("event_names", json!(names)),
        ("up", json!(clip.rig().up().byte())),
        ("helpers", json!(helpers)),
        ("poses", json!(poses(clip)?)),
        ("crcs", json!(crcs)),
    ]))
}

/// The CRCs of a committed record, which names no frames sought: their poses are those of the frames.
pub fn read(folder: &Path, name: &str) -> Result<Crcs> {
    let path = folder.join(name).with_extension("json");
    let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    let record: Value = serde_json::from_str(&text).with_context(|| path.display().to_string())?;
    let crc = |crc: &Value| u16::from_str_radix(crc.as_str()?, 16).ok();
    let stepped: Option<Vec<u16>> = record["crcs"].as_array().and_then(|crcs| crcs.iter().map(crc).collect());
    let stepped = stepped.filter(|crcs| record["frames"] == crcs.len());
    let stepped = stepped.with_context(|| format!("{}: `crcs` has no CRC for each of `frames`", path.display()))?;
    let sought = conformance::sought(stepped.len() as u32).map(|frame| stepped[frame as usize]).collect();
    Ok(Crcs { stepped, sought })
}

/// The first, the middle and the last pose, as far as they are short.
fn poses(clip: &Clip<'_>) -> Result<Map<String, Value>> {
    let last = clip.frames() - 1;
    let mut states = vec![ChannelState::default(); clip.moving()];
    let mut pose = vec![0; clip.rig().channels()];
    let mut player = pantin::Player::new(*clip, &mut states, &mut pose)?;
    let mut poses = Map::new();
    for frame in 0..=last {
        let left = POSE_VALUES.saturating_sub(poses.len() * clip.rig().channels());
        if [0, last / 2, last].contains(&frame) && clip.rig().channels() <= left {
            poses.insert(frame.to_string(), player.pose().values.into());
        }
        player.step();
    }
    Ok(poses)
}
