//! `pantin info`.

use super::{Files, against, bank};
use crate::memory;
use crate::open::is_bank;
use crate::output::{self, clean, note, outln};
use anyhow::{Context, Result, ensure};
use pantin::{Clip, Joint};
use pantin_convert::error_text;
use pantin_convert::events;
use pantin_convert::facts::{self, Channel, MemoryNeeds, Status};
use pantin_convert::import::{self, ImportOptions, animations, up};
use pantin_convert::motion::Event;
use pantin_store::BLOCK_BYTES;
use pantin_store::region::{REGIONS, Region};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Print what a clip or a bank holds and how its bytes are used, or which animations a glTF, FBX or VRML file holds.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin info walk.ptn
  pantin info walk.ptn --json         `motion_bytes` is the file without its rig
  pantin info walk.ptn --against walk.bvh
  pantin info figure.glb")]
pub struct Arguments {
    /// The clip, or a .glb, .gltf, .fbx, .wrl or .x3dv
    input: PathBuf,
    /// The rig of a clip that was made with --rig-out
    #[arg(long)]
    rig: Option<PathBuf>,
    /// The motion that the clip was made of: print the greatest place, shell and rotation error of the clip, each with its joint and frame
    #[arg(long, value_name = "MOTION")]
    against: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    if animations::chooses(&arguments.input) {
        ensure!(arguments.rig.is_none(), "{}: --rig is for clips, and this is a motion", arguments.input.display());
        ensure!(arguments.against.is_none(), "{}: --against is for clips, and this is a motion", arguments.input.display());
        return animations(&arguments.input);
    }
    let files = Files::read(&arguments.input, arguments.rig.as_deref())?;
    if is_bank(files.clip()) {
        ensure!(
            arguments.rig.is_none(),
            "{}: --rig is for clips without one, and a bank holds its rig",
            arguments.input.display()
        );
        ensure!(arguments.against.is_none(), "{}: --against is for one clip, and this is a bank", arguments.input.display());
        return bank::print(&arguments.input, files.clip());
    }
    let clip = files.open_alone().with_context(|| arguments.input.display().to_string())?;
    let rig = clip.rig();
    let file = files.clip_len();
    let memory = MemoryNeeds::of(&clip)?;
    let counted = facts::segments(&clip)?;
    // A clip that is too long to be played is taken to go on as it begins.
    let whole = counted.frames == clip.frames();
    let segments = (counted.count as f64 * f64::from(clip.frames()) / f64::from(counted.frames)).round() as usize;
    let spacing = facts::index_spacing(clip.duration_ns() as f64 * 1e-9, segments).filter(|_| clip.index_len() == 0);
    let fields = [
        ("frames", json!(clip.frames())),
        ("fps", json!((1e11 / f64::from(clip.frame_time_ns())).round() / 100.0)),
        ("seconds", json!((clip.duration_ns() as f64 / 1e6).round() / 1000.0)),
        ("looped", json!(clip.looped())),
        ("joints", json!(rig.joints().filter(|joint| !joint.end_site).count())),
        ("end_sites", json!(rig.joints().filter(|joint| joint.end_site).count())),
        ("scalar_channels", json!(rig.channels() - rig.joint_channels())),
        ("exponential_joints", json!((0..rig.joint_count()).filter(|&joint| clip.is_exponential(joint)).count())),
        ("events", json!(clip.event_count())),
        ("up", json!(up::text(rig.up()))),
        ("helpers", json!(rig.joints().filter(|joint| joint.helper).count())),
        ("cm_per_unit", json!(f64::from(rig.unit_micro_cm()) * 1e-6)),
        ("length_exponent", json!(clip.length_exponent())),
        ("file_bytes", json!(file)),
        ("rig_bytes", json!(clip.rig_len())),
        ("motion_bytes", json!(file - clip.rig_len())),
        ("head_bytes", json!(clip.head_len())),
        ("crc_bytes", json!(clip.crc_len())),
        ("index_bytes", json!(clip.index_len())),
        ("segments", json!(segments)),
        ("segments_counted_in_frames", if whole { Value::Null } else { json!(counted.frames) }),
        ("suggested_index_seconds", json!(spacing)),
        ("event_names_bytes", json!(clip.event_names_len())),
        ("per_frame_bytes", json!(clip.frames() as usize * rig.channels() * 2)),
    ];
    let fields = fields.into_iter().chain(memory_fields(&memory));
    let (built_in, by_update) = boards(&clip, &memory, file);
    let fields = fields.chain([("boards", json!(built_in)), ("boards_by_update", json!(by_update))]);
    let fields: Vec<(&str, Value)> = fields.collect();
    let compared = arguments.against.as_deref().map(|motion| against::errors(&clip, motion)).transpose()?;
    let channels = facts::channels(&clip)?;
    let events = events::of_clip(&clip);
    let seconds = |frame: usize| (frame as f64 * f64::from(clip.frame_time_ns()) / 1e6).round() / 1000.0;
    if output::is_json() {
        let mut object: serde_json::Map<String, Value> = fields.into_iter().map(|(name, value)| (name.into(), value)).collect();
        let event = |event: &Event| json!({"frame": event.frame, "seconds": seconds(event.frame), "name": event.name});
        object.insert("event_markers".into(), events.iter().map(event).collect());
        object.insert("rig".into(), rig_json(&clip, &channels));
        if let Some((report, motion)) = &compared {
            object.insert("errors".into(), Value::Object(error_text::to_json(report, motion)));
        }
        output::report(Value::Object(object));
    } else {
        for (name, value) in fields.into_iter().filter(|(_, value)| !value.is_null()) {
            let value = match &value {
                Value::Array(names) => names.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", "),
                Value::String(text) => text.clone(),
                value => value.to_string(),
            };
            outln!("{:22} {value}", name.replace('_', " "))?;
        }
        if let Some((report, motion)) = &compared {
            error_text::to_text(report, motion).lines().try_for_each(|line| outln!("{}", line.trim_start()))?;
        }
        table(&clip, &channels).iter().try_for_each(|line| outln!("{line}"))?;
        if let Some(seconds) = spacing {
            let ms = segments as f64 * facts::SEEK_MS_PER_SEGMENT;
            note!(
                "a seek passes up to {segments} segments ({ms:.0} ms on a Cortex-M0 at 48 MHz): `pantin convert --index {seconds}` adds snapshots to seek from"
            );
        }
        if !events.is_empty() {
            outln!("")?;
            outln!("{:>7} {:>9}  event", "frame", "seconds")?;
        }
        for event in &events {
            outln!("{:7} {:9.3}  {}", event.frame, seconds(event.frame), clean(&event.name))?;
        }
    }
    Ok(())
}

/// Most channels, moving channels and joints of the figure of a clip that a board has buffers for (`firmware/boards`): with 16 KiB of
/// RAM, and with more.
pub const SMALL_CAPACITY: [usize; 3] = [144, 96, 36];
/// The same with 64 KiB of RAM or more.
pub const CAPACITY: [usize; 3] = [400, 320, 80];

/// The boards that play the clip when it is built in, and those that keep it when `pantin update` sends it.
fn boards(clip: &Clip, memory: &MemoryNeeds, file: usize) -> (Vec<&'static str>, Vec<&'static str>) {
    let needs = [memory.channels, memory.moving, memory.figure_joints];
    let plays = |region: &&Region| {
        let capacity = if region.board == "microbit" { SMALL_CAPACITY } else { CAPACITY };
        needs.iter().zip(capacity).all(|(need, most)| *need <= most)
    };
    let keeps = |region: &&Region| plays(region) && clip.rig_len() > 0 && file + BLOCK_BYTES <= region.slot as usize;
    let names = |fits: &dyn Fn(&&Region) -> bool| REGIONS.iter().filter(fits).map(|region| region.board).collect();
    (names(&plays), names(&keeps))
}

/// What a program lends to play and draw: each number under the name that it has in source text, in lower case.
pub(super) fn memory_fields(memory: &MemoryNeeds) -> Vec<(&'static str, Value)> {
    let sizes = memory.sizes().into_iter().map(|size| (size.field, json!(size.value)));
    let bytes = [("player_bytes", json!(memory.player_bytes())), ("workspace_bytes", json!(memory.workspace_bytes()))];
    sizes.chain(bytes).collect()
}

/// Joints and scalars with how they are coded; `channels` are the pose's.
fn rig_json(clip: &Clip, channels: &[Channel]) -> Value {
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
fn table(clip: &Clip, channels: &[Channel]) -> Vec<String> {
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

/// The animations of a file, one a line; `pantin convert --animation` takes their numbers or names.
pub fn animations(path: &Path) -> Result<()> {
    let entries = import::list(&memory::disk(), path, &ImportOptions::new().memory(memory::limit()))?;
    if output::is_json() {
        let object = |entry: &animations::Entry| json!({"name": entry.name, "frames": entry.frames, "fps": entry.fps, "seconds": entry.seconds(), "tracks": entry.tracks});
        output::report(json!({"animations": entries.iter().map(object).collect::<Vec<_>>()}));
        return Ok(());
    }
    for (number, entry) in entries.iter().enumerate() {
        let name = entry.name.as_deref().unwrap_or("without a name");
        let (frames, fps, tracks) = (entry.frames, (entry.fps * 1000.0).round() / 1000.0, entry.tracks);
        outln!("{number:3} {name}: {frames} frames at {fps} a second, {:.3} s, {tracks} tracks", entry.seconds())?;
    }
    Ok(())
}
