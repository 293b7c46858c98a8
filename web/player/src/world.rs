//! The clip, its figure and its picture.

use crate::actor::Actor;
use crate::arriving::Arriving;
use crate::facts::{Facts, Trouble};
use crate::grey::DISPLAY;
use crate::memory::Buffers;
use crate::picture::Picture;
use crate::source::Source;
use pantin::Up;
use pantin_figure::camera::CameraTarget;
use pantin_figure::{Canvas, View};

/// The whole state of a player.
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

    /// Handles a longer beginning of the file, which may have moved. Camera and scale are those of the frames that are playable: they are computed again
    /// whenever these have doubled.
    pub fn arrived(&mut self, file: &'static [u8], buffers: *mut Buffers) -> Result<(), Trouble> {
        if self.finished {
            return Ok(());
        }
        let shown = self.source.frame();
        let (rig, file) = file.split_at_checked(self.rig_len).unwrap_or((&[], &[]));
        if self.file.as_ptr() != file.as_ptr() {
            self.source = Source::Nothing;
        }
        self.file = file;
        if matches!(self.source, Source::Nothing) {
            // SAFETY: the slot's buffers; the player that had them is gone.
            let buffers = unsafe { &mut *buffers };
            if let Some(clip) = Arriving::new(file, rig, buffers)? {
                self.source = Source::Clip(clip);
            }
        }
        let Source::Clip(clip) = &mut self.source else { return Ok(()) };
        let outcome = clip.extend(file);
        self.go(shown);
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
    #[cfg(feature = "poses")]
    pub fn poses(
        &mut self,
        file: &'static [u8],
        rig: usize,
        frames: usize,
        frame_time_ns: u32,
        length_exponent: i8,
    ) -> Result<(), Trouble> {
        self.finished = true;
        self.source = Source::Table(crate::source::Table::new(file, rig, frames, frame_time_ns, length_exponent)?);
        self.look()
    }

    /// Plays the state machine of a bank instead of a clip.
    #[cfg(feature = "character")]
    pub fn machine(&mut self, bank: &'static [u8], buffers: &'static mut crate::steered::Buffers) -> Result<(), Trouble> {
        self.finished = true;
        self.source = Source::Character(crate::steered::Steered::new(bank, buffers)?);
        self.look()
    }

    /// Acts on the character, if there is one.
    #[cfg(feature = "character")]
    pub fn steer<T: Default>(&mut self, act: impl FnOnce(&mut crate::steered::Steered, &mut Facts) -> T) -> T {
        match &mut self.source {
            Source::Character(character) => act(character, &mut self.facts),
            _ => T::default(),
        }
    }

    /// Lets the character's time pass.
    #[cfg(feature = "character")]
    pub fn update(&mut self, elapsed_us: u32) -> u32 {
        let Source::Character(character) = &mut self.source else { return 0 };
        let state = character.update(elapsed_us);
        self.actor.place_at(character.pose(), character.stand());
        state
    }

    pub fn aim(&mut self, width: u16, height: u16, orbit: i16, tilt: i16, how: u32) -> Result<(), Trouble> {
        self.canvas = Canvas { width: width.min(2047), height: height.clamp(1, 2047) };
        let track = if how & 1 == 0 { CameraTarget::Follow } else { CameraTarget::Fixed };
        let up = (how >> 1).checked_sub(1).and_then(|axis| Up::new(axis as usize, false));
        self.view = Some(View { orbit, tilt, track, up });
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
        #[cfg(feature = "character")]
        if let Source::Character(_) = self.source {
            return;
        }
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
