//! The clip, its figure and its picture.

use crate::actor::Actor;
use crate::arriving::Arriving;
use crate::facts::{Facts, Trouble};
use crate::grey::DISPLAY;
use crate::picture::Picture;
use crate::source::{Source, Table};
use pantin_figure::{Canvas, View};
use pantin_web_module::memory;

/// The whole state of an instance.
pub struct World {
    source: Source,
    actor: Actor,
    file: &'static [u8],
    /// Number of bytes in front of the file that are its rig.
    rig_len: usize,
    canvas: Canvas,
    view: Option<View>,
    /// Number of playable frames when the camera was set up.
    surveyed: u32,
    facts: Facts,
    finished: bool,
}

impl World {
    /// The state without a clip.
    pub const NEW: World = World {
        source: Source::Nothing,
        actor: Actor::NOBODY,
        file: &[],
        rig_len: 0,
        canvas: DISPLAY,
        view: None,
        surveyed: 0,
        facts: Facts::NONE,
        finished: false,
    };

    /// Handles a longer beginning of the file. Camera and scale are those of the frames that are playable: they are computed again whenever these have doubled.
    pub fn arrived(&mut self, file: &'static [u8]) -> Result<(), Trouble> {
        if self.finished {
            return Ok(());
        }
        let (rig, file) = file.split_at_checked(self.rig_len).unwrap_or((&[], &[]));
        self.file = file;
        if matches!(self.source, Source::Nothing)
            && let Some(clip) = Arriving::new(file, rig)?
        {
            self.source = Source::Clip(clip);
        }
        let Source::Clip(clip) = &mut self.source else { return Ok(()) };
        let outcome = clip.extend(file);
        if self.source.playable() > 2 * self.surveyed {
            self.look()?;
        }
        outcome
    }

    /// Takes the first bytes for a rig, and what follows for a file without one.
    pub fn apart(&mut self, rig_len: usize) {
        self.rig_len = rig_len;
    }

    /// Looks an event up by its place; false after the last one.
    pub fn event(&mut self, index: usize) -> bool {
        let Source::Clip(arriving) = &self.source else { return false };
        let clip = arriving.clip();
        let Some(event) = clip.events().nth(index) else { return false };
        let name = clip.event_name(event.id).unwrap_or_default();
        let facts = &mut self.facts;
        (facts.event_frame, facts.event_id) = (event.frame, event.id);
        (facts.event_name_at, facts.event_name_len) = (name.as_ptr() as usize, name.len());
        true
    }

    /// Checks the whole file. If it is damaged, the playable frames stay playable.
    pub fn finish(&mut self) -> Result<(), Trouble> {
        if self.finished {
            return Ok(());
        }
        self.finished = true;
        match &mut self.source {
            Source::Clip(clip) => clip.finish(self.file)?,
            // It ends before its first frame.
            _ => return Err(Trouble::Truncated),
        }
        self.look()
    }

    /// Plays a table instead of a clip.
    pub fn poses(&mut self, rig: usize, frames: usize, frame_time_ns: u32, length_exponent: i8) -> Result<(), Trouble> {
        self.finished = true;
        self.source = Source::Table(Table::new(memory::written(usize::MAX), rig, frames, frame_time_ns, length_exponent)?);
        self.look()
    }

    pub fn aim(&mut self, width: u16, height: u16, orbit: i16, tilt: i16) -> Result<(), Trouble> {
        self.canvas = Canvas { width: width.min(2047), height: height.clamp(1, 2047) };
        self.view = Some(View { orbit, tilt, ..View::default() });
        self.look()
    }

    fn look(&mut self) -> Result<(), Trouble> {
        let Some(view) = self.view else { return Ok(()) };
        match self.actor.aim(&mut self.source, self.canvas, view) {
            Err(Trouble::Nothing) => Ok(()),
            Err(trouble) => Err(trouble),
            Ok(()) => {
                self.surveyed = self.source.playable();
                Ok(())
            }
        }
    }

    pub fn go(&mut self, frame: u32) {
        let pose = self.source.go(frame);
        self.actor.place(pose);
    }

    pub fn facts(&mut self) -> &Facts {
        self.source.tell(&mut self.facts);
        &self.facts
    }

    pub fn strokes(&mut self, picture: &mut Picture) -> usize {
        let pose = self.source.pose().values;
        picture.gather(&mut self.actor, pose)
    }
}
