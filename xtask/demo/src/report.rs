//! The demo's table: what the motion was, what the clip is, what playing it costs.

use std::fmt;
use std::path::PathBuf;

use anyhow::{Context, Result};
use harness::icount::{FRAME_REGIONS, Stats};
use serde_json::Value;

/// A converted clip, as the host tool describes it.
pub struct Clip {
    /// Its file.
    pub path: PathBuf,
    /// Number of frames.
    pub frames: usize,
    /// Frames a second.
    pub rate: f64,
    channels: usize,
    moving: usize,
    bytes: usize,
    motion_bytes: usize,
    per_frame_bytes: usize,
    /// What the conversion's errors are called, and how great they are.
    errors: Vec<(&'static str, String)>,
}

impl Clip {
    /// Reads the clip's file; `errors` are those that `pantin convert --json` prints.
    pub fn new(path: PathBuf, errors: &Value) -> Result<Self> {
        let bytes = std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let clip = pantin::Clip::new_checked(&bytes)?;
        let channels = clip.rig().channels();
        Ok(Self {
            path,
            frames: clip.frames() as usize,
            rate: 1e9 / f64::from(clip.frame_time_ns()),
            channels,
            moving: clip.moving(),
            bytes: bytes.len(),
            motion_bytes: bytes.len() - clip.rig_len(),
            per_frame_bytes: clip.frames() as usize * channels * 2,
            errors: self::errors(errors),
        })
    }
}

/// The errors of joints, of channels that move none, or both.
fn errors(converted: &Value) -> Vec<(&'static str, String)> {
    let kinds = [
        ("max_error_cm", "max error at any joint", "cm"),
        ("mean_error_cm", "mean error", "cm"),
        ("max_scalar_error_percent", "max error of other channels", "% of full scale"),
    ];
    let error = |(key, name, unit)| converted[key].as_f64().map(|value: f64| (name, format!("{value:.3} {unit}")));
    kinds.into_iter().filter_map(error).collect()
}

/// The table.
pub struct Report<'a> {
    /// What was played.
    pub clip: &'a Clip,
    /// Instructions a region of a frame, where counted.
    pub counts: Option<Vec<Stats>>,
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let clip = self.clip;
        let seconds = clip.frames as f64 / clip.rate;
        let rows = [
            ("frames", format!("{} ({seconds:.2} s at {:.0} a second)", clip.frames, clip.rate)),
            ("channels", format!("{} ({} of them moving)", clip.channels, clip.moving)),
            ("bytes per-frame, 16 bits a value", clip.per_frame_bytes.to_string()),
            ("bytes of the clip's motion", clip.motion_bytes.to_string()),
            ("bytes of the clip with its rig", clip.bytes.to_string()),
            ("saving of the motion", format!("{:.1} %", 100.0 * (1.0 - clip.motion_bytes as f64 / clip.per_frame_bytes as f64))),
        ];
        for (name, value) in rows.iter().chain(&clip.errors) {
            writeln!(formatter, "{name:<34} {value}")?;
        }
        let Some(counts) = &self.counts else {
            return writeln!(formatter, "{:<34} not counted", "guest instructions a frame");
        };
        let total: f64 = counts.iter().map(Stats::mean).sum();
        writeln!(formatter, "{:<34} {total:.0} on average", "guest instructions a frame")?;
        for (name, stats) in FRAME_REGIONS.iter().zip(counts) {
            let worst = format!("at most {} in frame {}", stats.most, stats.worst);
            writeln!(formatter, "  {name:<32} {:.0} ({worst})", stats.mean())?;
        }
        Ok(())
    }
}
