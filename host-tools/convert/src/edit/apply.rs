//! The edits of a motion applied, one after the other.

use super::append::append;
use super::between::between;
use super::body;
use super::cut::cut;
use super::edits::{Body, Edited, Edits};
use super::freed::freed;
use super::in_place::in_place;
use super::join::join;
use super::loop_seam;
use super::mirror::mirror;
use super::pace::{Pace, pace};
use super::pick::pick;
use super::rename::rename;
use super::resample::resample;
use super::retarget;
use super::reverse::reverse;
use super::scale::scale;
use super::smooth::smooth;
use super::turn::turn;
use crate::error::{Error, Setting, require};
use crate::events;
use crate::expand::expand_within;
use crate::import::{self, Files, ImportOptions, read_from, scales};
use crate::moment::Moment;
use crate::motion::{Event, Motion};
use crate::note::{Note, NoteKind, Remedy};
use crate::number::Number;
use anyhow::{Context, Result};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// How long a motion goes over to the next one.
const BLEND_SECONDS: f64 = 0.25;

/// Degrees to the side that a figure faces before it is noted.
const ASIDE_DEG: f64 = 30.0;

impl Edits {
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
        for (setting, number) in [(Setting::Speed, self.speed), (Setting::Scale, self.scale), (Setting::Smooth, self.smooth)] {
            let wrong = || Error::setting(setting, "expected a number above 0");
            require!(number.is_none_or(|number| number.is_finite() && number > 0.0), wrong());
        }
        let wrong = || Error::setting(Setting::Blend, "expected seconds, 0 or more");
        require!(self.blend.is_none_or(|seconds| seconds.is_finite() && seconds >= 0.0), wrong());
        self.note_sampled(edited);
        self.change_rate(edited)?;
        self.add_events(edited)?;
        self.cut(edited)?;
        if let Some((first, last)) = &self.between {
            edited.motion = between(&edited.motion, first, last)?;
        }
        if !self.joints.is_empty() || !self.drop.is_empty() {
            edited.motion = pick(&edited.motion, &self.joints, &self.drop)?;
        }
        rename(&mut edited.motion, &self.rename)?;
        if self.mirror {
            edited.motion = mirror(&edited.motion)?;
        }
        match &self.retarget {
            Some(Body::Display) => self.put_on_display(edited, files)?,
            Some(Body::Of(path)) => self.put_on_body(path, edited, files)?,
            None => {}
        }
        self.change_motion(edited)?;
        for path in &self.append {
            self.append_motion(path, edited, files)?;
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
        motion.frame_time /= self.speed.unwrap_or(1.0);
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

    /// The text of the map file; empty without one.
    fn map_text(&self, files: &dyn Files) -> Result<String> {
        let read = |path: &PathBuf| {
            String::from_utf8(read_from(files, path)?).with_context(|| format!("{}: expected UTF-8 text", path.display()))
        };
        Ok(self.map.as_ref().map(read).transpose()?.unwrap_or_default())
    }

    fn put_on_body(&self, path: &Path, Edited { motion, notes }: &mut Edited, files: &dyn Files) -> Result<()> {
        let body = self.read_body(path, files).map_err(|error| error.in_file(path))?;
        notes.extend(scales_left_out(motion, "body"));
        let done = body::onto(motion, &body, &self.map_text(files)?)?;
        let text = format!(
            "body: arms point at most {:.2} degrees from the source's, legs in the air {:.2}; near the ground ankles are at most {:.2} cm higher or lower than the source's in the body's scale",
            done.arms_deg, done.legs_deg, done.ankles_cm
        );
        notes.push(Note::info(NoteKind::Retarget, text).in_file(path));
        if done.turned_deg != 0 {
            let text = format!(
                "body: the rest pose faces another way than the body's, so the motion was turned by {} degrees to the left",
                done.turned_deg
            );
            notes.push(Note::info(NoteKind::Retarget, text).in_file(path));
        }
        if let Some(facing) = done.facing_deg.filter(|facing| facing.abs() > ASIDE_DEG && self.turn.is_none()) {
            let side = if facing > 0.0 { "left" } else { "right" };
            let text = format!(
                "body: in the mean the figure faces {:.0} degrees to the {side} of where the body faces at rest; a turn by {:.0} degrees takes it there",
                facing.abs(),
                -facing
            );
            notes.push(Note::info(NoteKind::Retarget, text).remedy(Remedy::TurnMotion).in_file(path));
        }
        if done.uneven_deg > body::UNEVEN_DEG {
            let text = format!(
                "body: the figure does not stand with all turns at 0, so its first frame counts as its rest, and there one foot points {:.0} degrees higher than \
                 the other: so do the feet of what is put on it; take a body whose first frame has both feet flat on the ground",
                done.uneven_deg
            );
            notes.push(Note::warning(NoteKind::Retarget, text).in_file(path));
        }
        if !done.limited.is_empty() {
            let text =
                format!("body: joints that cannot turn in all directions turn as far as they can: {}", done.limited.join(", "));
            notes.push(Note::warning(NoteKind::Retarget, text).in_file(path));
        }
        *motion = done.motion;
        Ok(())
    }

    /// The figure of a file: a clip's, the one of a bank's first clip, or a motion's.
    fn read_body(&self, path: &Path, files: &dyn Files) -> Result<Motion, Error> {
        let wrong = |error: anyhow::Error| Error::of(&error, |text| Error::setting(Setting::Body, text));
        let bytes = read_from(files, path).map_err(wrong)?;
        let clip = match pantin::Bank::new_checked(&bytes) {
            Ok(bank) => bank.entries().next().and_then(|entry| bank.open(&entry).ok()),
            Err(_) => pantin::Clip::new_checked(&bytes).ok(),
        };
        match clip {
            Some(clip) => expand_within(&clip, self.memory).map_err(wrong),
            None => {
                let motion = import::import(files, path, &ImportOptions::new().memory(self.memory))?.motion;
                // A file of animations has the channels of one of them.
                if import::format(files, path)?.has_animations { freed(&motion).map_err(wrong) } else { Ok(motion) }
            }
        }
    }

    /// Edits that need no other file.
    fn change_motion(&self, Edited { motion, notes }: &mut Edited) -> Result<()> {
        if self.reverse {
            let before = motion.events.len();
            *motion = reverse(motion);
            if motion.events.len() < before {
                let text = "events: footsteps are left out of a motion that goes backwards";
                notes.push(Note::info(NoteKind::Events, text).remedy(Remedy::FindFootsteps));
            }
        }
        if let Some(factor) = self.scale {
            *motion = scale(motion, factor);
        }
        if let Some(hertz) = self.smooth {
            *motion = smooth(motion, hertz);
        }
        if let Some(what) = self.in_place {
            *motion = in_place(motion, what)?;
        }
        if let Some(degrees) = self.turn {
            *motion = turn(motion, degrees)?;
        }
        if let Some(wanted) = self.pace {
            let (walking, speed) = pace(motion, wanted, self.memory)?;
            *motion = walking;
            let text = if speed == 0.0 && wanted == Pace::Feet {
                "pace: its feet stand on the ground as it goes, so the figure gets no other way".into()
            } else {
                format!("pace: the figure goes {speed:.1} cm a second")
            };
            notes.push(Note::info(NoteKind::Travel, text));
        }
        Ok(())
    }

    fn append_motion(&self, path: &Path, Edited { motion, notes }: &mut Edited, files: &dyn Files) -> Result<()> {
        let options = ImportOptions::new().memory(self.memory);
        let mut imported = import::import(files, path, &options)?;
        // Frames at another rate end with its last one, and do not lead back to its first.
        imported.motion.looped = false;
        let of_other = |note: Note| Note { text: format!("append: {}", note.text), ..note }.in_file(path);
        notes.extend(imported.notes.into_iter().filter(Note::is_warning).map(of_other));
        // What is said of the figure holds for all; what is said of a stretch, its speed and its events for the first alone.
        let figure = Edits {
            joints: self.joints.clone(),
            drop: self.drop.clone(),
            rename: self.rename.clone(),
            mirror: self.mirror,
            retarget: self.retarget.clone(),
            map: self.map.clone(),
            scale: self.scale,
            smooth: self.smooth,
            in_place: self.in_place,
            turn: self.turn,
            fps: Some(1.0 / motion.frame_time),
            memory: self.memory,
            ..Edits::default()
        };
        let next = figure.apply(imported.motion, files)?.motion;
        let blend = (self.blend.unwrap_or(BLEND_SECONDS) / motion.frame_time).round() as usize;
        *motion = append(motion, &next, blend).map_err(|error| Error::of(&error, Error::source).in_file(path))?;
        let text = format!("append: {} frames more, the first {blend} of them blended; {} frames", next.frames, motion.frames);
        notes.push(Note::info(NoteKind::Joined, text).in_file(path));
        Ok(())
    }

    fn put_on_display(&self, Edited { motion, notes }: &mut Edited, files: &dyn Files) -> Result<()> {
        let map = self.map_text(files)?;
        notes.extend(scales_left_out(motion, "retarget"));
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

/// Leaves out the scalars of scales, which belong to joints that another body does not have. `edit` is what the note begins with.
fn scales_left_out(motion: &mut Motion, edit: &str) -> Option<Note> {
    let joints = scales::leave_out(motion);
    let text = format!("{edit}: the scales of {joints} joints are left out");
    (joints > 0).then(|| Note::info(NoteKind::Retarget, text))
}
