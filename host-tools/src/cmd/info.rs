//! `pantin info`.

use super::Files;
use crate::import::list;
use crate::output::{outln, print_json};
use anyhow::{Context, Result};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Print what a clip holds and how its bytes are used, or which animations a glTF, FBX or VRML file holds.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin info walk.ptn
  pantin info --json walk.ptn
  pantin info figure.glb")]
pub struct Arguments {
    /// The clip, or a .glb, .gltf, .fbx, .wrl or .x3dv
    input: PathBuf,
    /// Print one JSON object; `motion_bytes` is the file without its rig
    #[arg(long)]
    json: bool,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if list::chooses(&arguments.input) {
        return animations(&arguments.input, arguments.json);
    }
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    let clip = files.open().with_context(|| arguments.input.display().to_string())?;
    let rig = clip.rig();
    let file = files.clip_len();
    let fields = [
        ("frames", json!(clip.frames())),
        ("fps", json!((1e11 / f64::from(clip.frame_time_ns())).round() / 100.0)),
        ("joints", json!(rig.joints().filter(|joint| !joint.end_site).count())),
        ("channels", json!(rig.channels())),
        ("moving_channels", json!(clip.moving())),
        ("exponential_joints", json!((0..rig.joint_count()).filter(|&joint| clip.is_exponential(joint)).count())),
        ("looped", json!(clip.looped())),
        ("events", json!(clip.event_count())),
        ("cm_per_unit", json!(f64::from(rig.unit_micro_cm()) * 1e-6)),
        ("file_bytes", json!(file)),
        ("rig_bytes", json!(clip.rig_len())),
        ("motion_bytes", json!(file - clip.rig_len())),
        ("head_bytes", json!(clip.head_len())),
        ("crc_bytes", json!(clip.crc_len())),
        ("index_bytes", json!(clip.index_len())),
        ("per_frame_bytes", json!(clip.frames() as usize * rig.channels() * 2)),
    ];
    if arguments.json {
        let object: serde_json::Map<String, serde_json::Value> =
            fields.into_iter().map(|(name, value)| (name.into(), value)).collect();
        print_json(&serde_json::Value::Object(object))?;
    } else {
        fields.iter().try_for_each(|(name, value)| outln!("{:20} {value}", name.replace('_', " ")))?;
    }
    Ok(())
}

/// The animations of a file, one a line; `pantin convert --animation` takes their numbers or names.
pub fn animations(path: &Path, as_json: bool) -> Result<()> {
    let entries = list::list(path, None)?;
    if as_json {
        let object = |entry: &list::Entry| json!({"name": entry.name, "frames": entry.frames, "fps": entry.fps, "seconds": entry.seconds(), "tracks": entry.tracks});
        return print_json(&json!(entries.iter().map(object).collect::<Vec<_>>()));
    }
    for (number, entry) in entries.iter().enumerate() {
        let name = entry.name.as_deref().unwrap_or("without a name");
        let (frames, fps, tracks) = (entry.frames, (entry.fps * 1000.0).round() / 1000.0, entry.tracks);
        outln!("{number:3} {name}: {frames} frames at {fps} a second, {:.3} s, {tracks} tracks", entry.seconds())?;
    }
    Ok(())
}
