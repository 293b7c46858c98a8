//! All edits of a motion, in the order in which they apply.

use super::cut::cut;
use super::join::join;
use super::loop_seam;
use super::mirror::mirror;
use super::pick::pick;
use super::resample::resample;
use super::retarget;
use crate::error::{Error, Setting, require};
use crate::events;
use crate::import::{self, Files, ImportOptions, read_from};
use crate::memory::Memory;
use crate::moment::Moment;
use crate::motion::{Event, Motion};
use crate::note::{Note, NoteKind, Remedy};
use crate::number::Number;
use anyhow::{Context, Result};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// A body that motions can be put on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Body {
    /// 15 joints: hips, chest, head, and upper arm, forearm, hand, thigh, shin, foot of both sides.
    Display,
}

/// Changes of a motion between import and conversion. They apply in the order of the fields. The default changes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Edits {
    /// Frames a second that the source's frames have, whatever the source states: all frames stay, and the motion gets slower or faster.
    pub rate: Option<f64>,
    /// Frames a second of the result: the motion is resampled.
    pub fps: Option<f64>,
    /// Event markers to add, by name and moment. Frames count after `fps` and before `from`.
    pub events: Vec<(String, Moment)>,
    /// The first frame to keep, counted after `fps`.
    pub from: Option<Moment>,
    /// The last frame to keep.
    pub to: Option<Moment>,
    /// Globs of joints and scalars to keep, in any case of letters; all if there is none.
    pub joints: Vec<String>,
    /// Globs of joints and scalars to drop.
    pub drop: Vec<String>,
    /// Whether left and right are exchanged.
    pub mirror: bool,
    /// The body that the motion is put on.
    pub retarget: Option<Body>,
    /// A file with the names of joints that `retarget` does not recognize.
    pub map: Option<PathBuf>,
    /// Another file whose scalars are added, such as a face recorded with the body.
    pub with: Option<PathBuf>,
    /// Whether the motion is one cycle, whose first frame follows its last.
    pub close_loop: bool,
    /// The memory that the edits may take; 1 GiB by default.
    pub memory: Memory,
}

/// A motion after its edits.
#[derive(Clone, Debug)]
pub struct Edited {
    /// The motion.
    pub motion: Motion,
    /// What the edits did.
    pub notes: Vec<Note>,
}

impl Edits {
    /// Nothing is changed.
    pub fn new() -> Edits {
        Edits::default()
    }

    /// States the rate of the source's frames.
    pub fn rate(self, fps: impl Into<Option<f64>>) -> Edits {
        Edits { rate: fps.into(), ..self }
    }

    /// Resamples to `fps` frames a second.
    pub fn fps(self, fps: impl Into<Option<f64>>) -> Edits {
        Edits { fps: fps.into(), ..self }
    }

    /// Adds an event marker.
    pub fn event(mut self, name: impl Into<String>, moment: Moment) -> Edits {
        self.events.push((name.into(), moment));
        self
    }

    /// Keeps the frames from `from` on.
    pub fn from(self, from: impl Into<Option<Moment>>) -> Edits {
        Edits { from: from.into(), ..self }
    }

    /// Keeps the frames up to `to`, this one included.
    pub fn to(self, to: impl Into<Option<Moment>>) -> Edits {
        Edits { to: to.into(), ..self }
    }

    /// Keeps only joints and scalars whose names match the glob, or another one that is given.
    pub fn joints(mut self, glob: impl Into<String>) -> Edits {
        self.joints.push(glob.into());
        self
    }

    /// Drops joints and scalars whose names match the glob.
    pub fn drop(mut self, glob: impl Into<String>) -> Edits {
        self.drop.push(glob.into());
        self
    }

    /// Exchanges left and right.
    pub fn mirror(self, mirror: bool) -> Edits {
        Edits { mirror, ..self }
    }

    /// Puts the motion on a body.
    pub fn retarget(self, body: impl Into<Option<Body>>) -> Edits {
        Edits { retarget: body.into(), ..self }
    }

    /// Names joints for [`Edits::retarget`].
    pub fn map(self, file: impl Into<PathBuf>) -> Edits {
        Edits { map: Some(file.into()), ..self }
    }

    /// Adds the scalars of another file.
    pub fn with(self, file: impl Into<PathBuf>) -> Edits {
        Edits { with: Some(file.into()), ..self }
    }

    /// Takes the motion as one cycle.
    pub fn close_loop(self, close_loop: bool) -> Edits {
        Edits { close_loop, ..self }
    }

    /// Limits the memory.
    pub fn memory(self, memory: Memory) -> Edits {
        Edits { memory, ..self }
    }

    /// The frame from which the motion is kept.
    fn first_frame(&self, frame_time: f64) -> usize {
        self.from.map_or(0, |moment| moment.nearest(frame_time))
    }

    /// Changes `motion`. Other motions and names are read from `files`.
    pub fn apply(&self, motion: Motion, files: &dyn Files) -> Result<Edited, Error> {
        let mut edited = Edited { motion, notes: Vec::new() };
        self.apply_all(&mut edited, files).map_err(|error| Error::of(&error, Error::source))?;
        Ok(edited)
    }

    fn apply_all(&self, edited: &mut Edited, files: &dyn Files) -> Result<()> {
        for (setting, rate) in [(Setting::SourceRate, self.rate), (Setting::FrameRate, self.fps)] {
            let wrong = || Error::setting(setting, "expected a number of frames a second above 0");
            require!(rate.is_none_or(|rate| rate.is_finite() && rate > 0.0), wrong());
        }
        self.note_sampled(edited);
        self.change_rate(edited)?;
        self.add_events(edited)?;
        self.cut(edited)?;
        if !self.joints.is_empty() || !self.drop.is_empty() {
            edited.motion = pick(&edited.motion, &self.joints, &self.drop)?;
        }
        if self.mirror {
            edited.motion = mirror(&edited.motion)?;
        }
        if let Some(Body::Display) = self.retarget {
            self.put_on_display(edited, files)?;
        }
        if let Some(path) = &self.with {
            self.add_scalars(path, edited, files)?;
        }
        if self.close_loop {
            close_cycle(edited)?;
        }
        Ok(())
    }

    /// A cycle of a file that is read at its times has no time from its last frame to its first.
    fn note_sampled(&self, edited: &mut Edited) {
        if let Some(fps) = edited.motion.origin.sampled_fps.filter(|_| self.close_loop) {
            let text = format!(
                "loop: the file was read at {} frames a second up to its last time, which one such frame parts from its first; at its own rate, it is one of its own frames",
                Number(fps)
            );
            edited.notes.push(Note::info(NoteKind::Loop, text));
        }
    }

    fn change_rate(&self, Edited { motion, notes }: &mut Edited) -> Result<()> {
        if let Some(rate) = self.rate {
            let text = format!(
                "rate: {} frames, {:.3} a second by the file, are now {} a second",
                motion.frames,
                1.0 / motion.frame_time,
                Number(rate)
            );
            notes.push(Note::info(NoteKind::FrameRate, text));
            motion.frame_time = 1.0 / rate;
        }
        let Some(fps) = self.fps else { return Ok(()) };
        let before = (motion.frames, 1.0 / motion.frame_time);
        let events = distinct(motion);
        // What will be closed to a loop is one from the start: frames at another rate run on from its last frame to its first.
        let whole = self.to.is_none() && self.first_frame(motion.frame_time) == 0;
        let cycle = self.close_loop && !motion.looped && whole;
        if cycle {
            motion.looped = true;
            motion.keys.fill(None);
        }
        *motion = resample(motion, fps, self.memory)?;
        motion.looped &= !cycle;
        let merged = events - distinct(motion);
        if merged > 0 {
            let text = format!("events: {merged} of {events} come to a frame that has one of their name, and are one with it");
            notes.push(Note::info(NoteKind::Events, text));
        }
        if (before.1 / fps - 1.0).abs() > 1e-3 {
            let (frames, rate) = before;
            let text = format!("{frames} frames at {rate:.3} a second became {} at {}", motion.frames, Number(fps));
            notes.push(Note::info(NoteKind::FrameRate, text));
        }
        Ok(())
    }

    fn add_events(&self, Edited { motion, .. }: &mut Edited) -> Result<()> {
        for (name, moment) in &self.events {
            let wrong = |error: anyhow::Error| Error::value(Setting::Event, name, format!("{error:#}"));
            events::check_name(name).map_err(wrong)?;
            let frame = moment.frame(motion.frames as u32, motion.frame_time).map_err(wrong)? as usize;
            motion.add_events([Event { frame, name: name.clone() }]);
        }
        Ok(())
    }

    fn cut(&self, Edited { motion, notes }: &mut Edited) -> Result<()> {
        if self.from.is_none() && self.to.is_none() {
            return Ok(());
        }
        let frame = |moment: Moment| moment.nearest(motion.frame_time);
        let before = motion.events.len();
        let looped = motion.looped;
        *motion = cut(motion, self.from.map(frame), self.to.map(frame))?;
        if looped && !motion.looped && !self.close_loop {
            notes.push(Note::info(NoteKind::Loop, "loop: a part of a loop is no loop").remedy(Remedy::MakeLoop));
        }
        let left_out = before - motion.events.len();
        if left_out > 0 {
            let text = format!("events: {left_out} of {before} are not between the first and the last frame that are kept");
            notes.push(Note::info(NoteKind::Events, text));
        }
        Ok(())
    }

    fn put_on_display(&self, Edited { motion, notes }: &mut Edited, files: &dyn Files) -> Result<()> {
        let read = |path: &PathBuf| {
            String::from_utf8(read_from(files, path)?).with_context(|| format!("{}: expected UTF-8 text", path.display()))
        };
        let map = self.map.as_ref().map(read).transpose()?.unwrap_or_default();
        let done = retarget::display(motion, &map)?;
        let pairs: Vec<String> = done.sources.iter().map(|(display, source)| format!("{display} {source}")).collect();
        notes.push(Note::info(NoteKind::Retarget, format!("display's joints: {}", pairs.join(", "))));
        let (cm, joint, frame) = (done.max_cm, done.joint, done.frame);
        let text = format!("retarget: at most {cm:.2} cm from the source's joints ({joint} at frame {frame})");
        notes.push(Note::info(NoteKind::Retarget, text).of_joint(joint).at_frame(frame));
        *motion = done.motion;
        motion.origin.retarget_max_cm = Some(cm);
        Ok(())
    }

    fn add_scalars(&self, path: &Path, Edited { motion, notes }: &mut Edited, files: &dyn Files) -> Result<()> {
        let options = ImportOptions::new().memory(self.memory);
        let mut imported = import::import(files, path, &options)?;
        if (imported.motion.frame_time / motion.frame_time - 1.0).abs() > 1e-9 {
            // A file that is read at the rate is nearer to what it says than its frames at another are.
            imported = import::import(files, path, &options.fps(1.0 / motion.frame_time))?;
        }
        let of_other = |note: Note| Note { text: format!("with: {}", note.text), ..note }.in_file(path);
        notes.extend(imported.notes.into_iter().filter(Note::is_warning).map(of_other));
        let other = imported.motion;
        let before = motion.clone();
        let joined =
            join(&before, &other, self.memory).map_err(|error| Error::of(&error, |text| Error::setting(Setting::With, text)));
        *motion = joined.map_err(|error| error.in_file(path))?;
        let count = other.rig.scalars.len();
        notes.push(Note::info(NoteKind::Joined, format!("with: {count} scalars more, {} frames", motion.frames)).in_file(path));
        if self.close_loop && motion.frames < before.frames {
            let (left, whole) = (motion.frames, before.frames);
            let text = format!("with: the other file ends before the cycle does: {left} of {whole} frames become the loop");
            notes.push(Note::warning(NoteKind::Loop, text).in_file(path));
        }
        if before.looped && !motion.looped {
            let text = "with: the clip is no loop any more, as the two are not loops of one length";
            notes.push(Note::info(NoteKind::Loop, text).remedy(Remedy::CloseLoop));
        }
        let lost = before.events.len() + other.events.len() - motion.events.len();
        if lost > 0 {
            let text = format!("events: {lost} are behind the end of the shorter of the two, or in both");
            notes.push(Note::info(NoteKind::Events, text));
        }
        Ok(())
    }
}

/// Makes a loop of one cycle.
fn close_cycle(Edited { motion, notes }: &mut Edited) -> Result<()> {
    let mut note = |text: String| notes.push(Note::info(NoteKind::Loop, text));
    if motion.looped {
        note("loop: it is one already".into());
        return Ok(());
    }
    let joined = loop_seam::join_ends(motion)?;
    *motion = joined.motion;
    if let Some([seam, inside]) = joined.joints_cm {
        note(format!(
            "loop: from the last frame to the first, joints go up to {seam:.4} cm; within the clip up to {inside:.4} cm a frame"
        ));
    }
    if let Some([seam, inside]) = joined.scalars.map(|parts| parts.map(|part| 100.0 * part)) {
        note(format!(
            "loop: from the last frame to the first, scalars change by up to {seam:.2} % of full scale; within the clip by up to {inside:.2} % a frame"
        ));
    }
    Ok(())
}

/// How many events a clip of the motion has: those of one name at one frame are one.
fn distinct(motion: &Motion) -> usize {
    motion.events.iter().map(|event| (event.frame, &event.name)).collect::<HashSet<_>>().len()
}
