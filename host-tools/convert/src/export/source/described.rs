//! What source text says about a clip or a bank before its bytes.

use super::names::plain;
use crate::facts::{FileKind, MemoryNeeds};
use anyhow::Result;
use pantin::codec::keys::KEY_VERSION;
use pantin::{Bank, Clip};

/// Bytes a line of a C header and of a Rust module.
const PER_LINE: usize = 20;

/// A clip or a bank with all that its source text states.
#[derive(Clone, Debug)]
pub struct Described<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) content: Content,
    pub(super) memory: MemoryNeeds,
    /// The first sentence.
    pub(super) title: String,
    /// What follows it, a line each.
    pub(super) lines: Vec<String>,
}

fn has_keys(bytes: &[u8]) -> bool {
    bytes.get(2) == Some(&KEY_VERSION)
}

/// What the bytes hold.
#[derive(Clone, Debug)]
pub(super) enum Content {
    Clip {
        frames: u32,
        frame_time_ns: u32,
        /// `LeftKnee.Xexponential`, or a scalar's name: one for each channel of a pose.
        channels: Vec<String>,
    },
    Bank {
        /// The names of the clips, in their order.
        clips: Vec<String>,
    },
}

impl<'a> Described<'a> {
    /// Describes the file `bytes`, a clip with its rig or a bank. Fails for other files and damaged ones.
    pub fn of(bytes: &'a [u8]) -> Result<Described<'a>> {
        if FileKind::of(bytes) == Some(FileKind::Bank) {
            return Described::of_bank(&Bank::new_checked(bytes)?, bytes);
        }
        Described::of_clip(&Clip::new_checked(bytes)?, bytes)
    }

    /// Describes `clip`, whose file has `bytes`.
    pub fn of_clip(clip: &Clip, bytes: &'a [u8]) -> Result<Described<'a>> {
        let rig = clip.rig();
        let (frames, frame_time_ns) = (clip.frames(), clip.frame_time_ns());
        let apart = if clip.rig_len() == 0 { "; its rig is apart" } else { "" };
        let what = if clip.has_keys() { "key clip" } else { "clip" };
        let title = format!("A pantin {what}: {} bytes, {}{apart}.", bytes.len(), length(clip));
        let mut lines = vec!["Channels, in the order of a pose, as the clip codes them:".into()];
        let mut channels = Vec::new();
        for (index, joint) in rig.joints().enumerate() {
            let kinds: Vec<String> = clip.kinds(index).map(|kind| format!("{kind:?}")).collect();
            if !kinds.is_empty() {
                lines.push(format!("{:4} {}: {}", channels.len(), plain(joint.name()), kinds.join(", ")));
            }
            channels.extend(kinds.iter().map(|kind| format!("{}.{kind}", joint.name())));
        }
        for scalar in rig.scalars() {
            lines.push(format!("{:4} {}", channels.len(), plain(scalar.name())));
            channels.push(scalar.name().into());
        }
        let content = Content::Clip { frames, frame_time_ns, channels };
        Ok(Described { bytes, content, memory: MemoryNeeds::of(clip)?, title, lines })
    }

    /// Describes `bank`, whose file has `bytes`. Its memory is the most that any clip takes. Fails for a bank with a damaged clip.
    pub fn of_bank(bank: &Bank, bytes: &'a [u8]) -> Result<Described<'a>> {
        let what = if has_keys(bytes) { "bank with key clips" } else { "bank" };
        let title = format!("A pantin {what}: {} bytes, {} clips.", bytes.len(), bank.len());
        let mut lines = vec!["Clips, in their order:".into()];
        let mut clips = Vec::new();
        for entry in bank.entries() {
            let clip = bank.open(&entry)?;
            lines.push(format!("{:4} {}: {} bytes, {}", clips.len(), plain(entry.name()), entry.bytes().len(), length(&clip)));
            clips.push(entry.name().to_string());
        }
        Ok(Described { bytes, content: Content::Bank { clips }, memory: MemoryNeeds::of_bank(bank)?, title, lines })
    }

    /// The memory that it takes: that of a clip, or the most of any clip of a bank.
    pub fn memory(&self) -> MemoryNeeds {
        self.memory
    }

    /// Whether it is a key clip or a bank with one, which players without key clips refuse.
    pub fn has_keys(&self) -> bool {
        has_keys(self.bytes)
    }

    /// Whether it is a bank.
    pub fn is_bank(&self) -> bool {
        matches!(self.content, Content::Bank { .. })
    }

    /// All comment lines.
    pub(super) fn comments(&self) -> impl Iterator<Item = &str> {
        [self.title.as_str()].into_iter().chain(self.lines.iter().map(String::as_str))
    }

    /// The bytes as numbers, in rows.
    pub(super) fn rows(&self) -> String {
        let row = |row: &[u8]| format!("    {},\n", row.iter().map(u8::to_string).collect::<Vec<_>>().join(", "));
        self.bytes.chunks(PER_LINE).map(row).collect()
    }
}

/// `160 frames at 120.000 frames a second`.
fn length(clip: &Clip) -> String {
    format!("{} frames at {:.3} frames a second", clip.frames(), 1e9 / f64::from(clip.frame_time_ns()))
}
