//! What a decoder must make of a vector: `NAME.json`.
//!
//! `crcs` has one CRC a frame: CRC-16/IBM-3740 of the pose's raw values as little-endian 32-bit integers, in hexadecimal.
//! `poses` has whole poses by frame, as raw values. The other fields are the clip's own, as it tells them.

use anyhow::Result;
use conformance::Play;
use pantin::{ChannelState, Clip};
use serde_json::{Map, Value, json};

use super::json;

/// Most values of whole poses in a record.
const POSE_VALUES: usize = 400;

/// The CRC of every frame, step by step, and of those that [`conformance::sought`] names, by seeking.
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
        Play::Step => found.stepped.push(crc),
        Play::Seek => found.sought.push(crc),
    })?;
    Ok(found)
}

/// The text of a clip's record.
pub fn of(clip: &Clip<'_>) -> Result<String> {
    let crcs: Vec<String> = crcs(clip)?.stepped.iter().map(|crc| format!("{crc:04x}")).collect();
    let events: Vec<Value> = clip.events().map(|event| json!([event.frame, event.id])).collect();
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
        ("poses", json!(poses(clip)?)),
        ("crcs", json!(crcs)),
    ]))
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
            poses.insert(frame.to_string(), player.pose().into());
        }
        player.step();
    }
    Ok(poses)
}
