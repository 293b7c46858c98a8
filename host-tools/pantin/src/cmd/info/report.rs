//! What `pantin info` reports of a clip, as JSON and as text.

use super::channels::{rig_json, table};
use super::fields::{self, SegmentCount};
use crate::cmd::against;
use crate::output::{clean, note, outln};
use anyhow::Result;
use pantin::Clip;
use pantin_convert::facts::{self, Channel, MemoryNeeds};
use pantin_convert::motion::{Event, Motion};
use pantin_convert::{error_text, events, verify};
use serde_json::{Map, Value, json};
use std::path::Path;

/// What is known of a clip.
pub(super) struct Report<'c> {
    clip: &'c Clip<'c>,
    /// Numbers and texts with their names; null where one does not apply.
    fields: Vec<(&'static str, Value)>,
    segments: SegmentCount,
    /// The errors against a motion, and that motion.
    compared: Option<(verify::Report, Motion)>,
    channels: Vec<Channel>,
    events: Vec<Event>,
}

impl<'c> Report<'c> {
    /// Collects the report of a clip whose file has `file_bytes` bytes, and compares the clip with the motion file `against`. Fails if the
    /// motion is of another figure.
    pub fn of(clip: &'c Clip<'c>, file_bytes: usize, against: Option<&Path>) -> Result<Report<'c>> {
        let memory = MemoryNeeds::of(clip)?;
        let segments = SegmentCount::of(clip)?;
        Ok(Report {
            clip,
            fields: fields::of_clip(clip, file_bytes, &memory, &segments)?,
            segments,
            compared: against.map(|motion| against::errors(clip, motion)).transpose()?,
            channels: facts::channels(clip)?,
            events: events::of_clip(clip),
        })
    }

    /// The time of a frame in seconds, to the millisecond.
    fn seconds(&self, frame: usize) -> f64 {
        (frame as f64 * f64::from(self.clip.frame_time_ns()) / 1e6).round() / 1000.0
    }

    /// The object that `--json` prints.
    pub fn to_json(&self) -> Value {
        let mut object: Map<String, Value> = self.fields.iter().map(|(name, value)| ((*name).into(), value.clone())).collect();
        let event = |event: &Event| json!({"frame": event.frame, "seconds": self.seconds(event.frame), "name": event.name});
        object.insert("event_markers".into(), self.events.iter().map(event).collect());
        object.insert("rig".into(), rig_json(self.clip, &self.channels));
        if let Some((report, motion)) = &self.compared {
            object.insert("errors".into(), Value::Object(error_text::to_json(report, motion)));
        }
        Value::Object(object)
    }

    /// Prints it as text.
    pub fn print(&self) -> Result<()> {
        for (name, value) in self.fields.iter().filter(|(_, value)| !value.is_null()) {
            let value = match value {
                Value::Array(names) => names.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", "),
                Value::String(text) => text.clone(),
                value => value.to_string(),
            };
            outln!("{:22} {value}", name.replace('_', " "))?;
        }
        if let Some((report, motion)) = &self.compared {
            error_text::to_text(report, motion).lines().try_for_each(|line| outln!("{}", line.trim_start()))?;
        }
        table(self.clip, &self.channels).iter().try_for_each(|line| outln!("{line}"))?;
        self.note_seeks();
        self.print_events()
    }

    /// Suggests an index if seeks pass many segments.
    fn note_seeks(&self) {
        let SegmentCount { count: Some(count), suggested_index_seconds: Some(seconds), .. } = self.segments else { return };
        let ms = count as f64 * facts::SEEK_MS_PER_SEGMENT;
        note!(
            "a seek passes up to {count} segments ({ms:.0} ms on a Cortex-M0 at 48 MHz): `pantin convert --index {seconds}` adds snapshots to seek from"
        );
    }

    fn print_events(&self) -> Result<()> {
        if !self.events.is_empty() {
            outln!("")?;
            outln!("{:>7} {:>9}  event", "frame", "seconds")?;
        }
        for event in &self.events {
            outln!("{:7} {:9.3}  {}", event.frame, self.seconds(event.frame), clean(&event.name))?;
        }
        Ok(())
    }
}
