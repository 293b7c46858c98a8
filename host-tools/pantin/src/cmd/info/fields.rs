//! The numbers of a clip under the names that `--json` has.

use anyhow::Result;
use pantin::Clip;
use pantin_convert::facts::{self, MemoryNeeds};
use pantin_convert::import::up;
use pantin_store::BLOCK_BYTES;
use pantin_store::region::{REGIONS, Region};
use serde_json::{Value, json};

/// Most channels, moving channels and joints of the figure of a clip that a board has buffers for (`firmware/boards`): with 16 KiB of
/// RAM, and with more.
pub const SMALL_CAPACITY: [usize; 3] = [144, 96, 36];
/// As [`SMALL_CAPACITY`], of boards with 64 KiB of RAM or more.
pub const CAPACITY: [usize; 3] = [400, 320, 80];

/// How many segments a clip has.
pub(super) struct SegmentCount {
    /// Their number, taken to go on as it begins if the clip is too long to be played; a key clip has none.
    pub count: Option<usize>,
    /// The frames in which they were counted, if not all.
    pub counted_frames: Option<u32>,
    /// A time between snapshots with which seeks are short; none if they are, or if the clip has an index.
    pub suggested_index_seconds: Option<f64>,
}

impl SegmentCount {
    /// Counts them by playing the clip, for at most half a second.
    pub fn of(clip: &Clip) -> Result<SegmentCount> {
        if clip.has_keys() {
            return Ok(SegmentCount { count: None, counted_frames: None, suggested_index_seconds: None });
        }
        let counted = facts::segments(clip)?;
        let count = (counted.count as f64 * f64::from(clip.frames()) / f64::from(counted.frames)).round() as usize;
        let spacing = facts::index_spacing(clip.duration_ns() as f64 * 1e-9, count);
        Ok(SegmentCount {
            count: Some(count),
            counted_frames: Some(counted.frames).filter(|&frames| frames != clip.frames()),
            suggested_index_seconds: spacing.filter(|_| clip.index_len() == 0),
        })
    }
}

/// All fields of a clip in a file of `file_bytes`, in the order in which they are printed. Those that do not apply are null.
pub(super) fn of_clip(
    clip: &Clip,
    file_bytes: usize,
    memory: &MemoryNeeds,
    segments: &SegmentCount,
) -> Result<Vec<(&'static str, Value)>> {
    let rig = clip.rig();
    let mut fields = vec![
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
        ("file_bytes", json!(file_bytes)),
        ("rig_bytes", json!(clip.rig_len())),
        ("motion_bytes", json!(file_bytes - clip.rig_len())),
        ("head_bytes", json!(clip.head_len())),
        ("crc_bytes", json!(clip.crc_len())),
        ("index_bytes", json!(clip.index_len())),
        ("keys", json!(facts::keys(clip)?)),
        ("segments", json!(segments.count)),
        ("segments_counted_in_frames", json!(segments.counted_frames)),
        ("suggested_index_seconds", json!(segments.suggested_index_seconds)),
        ("event_names_bytes", json!(clip.event_names_len())),
        ("per_frame_bytes", json!(clip.frames() as usize * rig.channels() * 2)),
    ];
    fields.extend(memory_fields(memory));
    let (built_in, by_update) = boards(clip, memory, file_bytes);
    fields.extend([("boards", json!(built_in)), ("boards_by_update", json!(by_update))]);
    Ok(fields)
}

/// The boards that play the clip when it is built in, and those that keep it when `pantin update` sends it. Key clips are left out, which take an image with feature `keys`.
fn boards(clip: &Clip, memory: &MemoryNeeds, file: usize) -> (Vec<&'static str>, Vec<&'static str>) {
    let needs = [memory.channels, memory.moving, memory.figure_joints];
    let plays = |region: &&Region| {
        let capacity = if region.board == "microbit" { SMALL_CAPACITY } else { CAPACITY };
        !clip.has_keys() && needs.iter().zip(capacity).all(|(need, most)| *need <= most)
    };
    let keeps = |region: &&Region| plays(region) && clip.rig_len() > 0 && file + BLOCK_BYTES <= region.slot as usize;
    let names = |fits: &dyn Fn(&&Region) -> bool| REGIONS.iter().filter(fits).map(|region| region.board).collect();
    (names(&plays), names(&keeps))
}

/// What a program lends to play and draw: each number under the name that it has in source text, in lower case.
pub(in crate::cmd) fn memory_fields(memory: &MemoryNeeds) -> Vec<(&'static str, Value)> {
    let sizes = memory.sizes().into_iter().map(|size| (size.field, json!(size.value)));
    let bytes = [("player_bytes", json!(memory.player_bytes())), ("workspace_bytes", json!(memory.workspace_bytes()))];
    sizes.chain(bytes).collect()
}
