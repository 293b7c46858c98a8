//! Sources of poses: a clip that is being received, or a table.

use crate::arriving::Arriving;
use crate::facts::Facts;
#[cfg(feature = "poses")]
use crate::facts::Trouble;
use pantin::{Form, Pose, Rig};

/// A table of poses, one raw value per channel and frame.
#[cfg(feature = "poses")]
pub struct Table {
    pub rig: Rig<'static>,
    values: &'static [i32],
    frames: u32,
    frame: u32,
    frame_time_ns: u32,
    form: Form,
}

#[cfg(feature = "poses")]
impl Table {
    /// Opens a file that holds a rig and, from the next multiple of 4 on, the values.
    pub fn new(
        file: &'static [u8],
        rig: usize,
        frames: usize,
        frame_time_ns: u32,
        length_exponent: i8,
    ) -> Result<Table, Trouble> {
        let (bytes, rest) = file.split_at_checked(rig.next_multiple_of(4)).ok_or(Trouble::Truncated)?;
        let rig = Rig::new_checked(bytes.get(..rig).ok_or(Trouble::Truncated)?)?;
        // SAFETY: any bits are integers.
        let (_, values, _) = unsafe { rest.align_to::<i32>() };
        let values = frames.checked_mul(rig.channels()).and_then(|count| values.get(..count)).ok_or(Trouble::Truncated)?;
        if frames == 0 {
            return Err(Trouble::Malformed);
        }
        Ok(Table { rig, values, frames: frames as u32, frame: 0, frame_time_ns, form: Form::new(rig.id(), length_exponent, []) })
    }

    fn pose(&self) -> Pose<'_> {
        let channels = self.rig.channels();
        let first = self.frame as usize * channels;
        Pose { values: self.values.get(first..first + channels).unwrap_or(&[]), form: (&self.form).into() }
    }
}

/// A source of poses.
#[allow(clippy::large_enum_variant)]
pub enum Source {
    Nothing,
    Clip(Arriving),
    #[cfg(feature = "poses")]
    Table(Table),
    #[cfg(feature = "character")]
    Character(crate::steered::Steered),
}

impl Source {
    pub fn rig(&self) -> Option<Rig<'static>> {
        match self {
            Source::Nothing => None,
            Source::Clip(clip) => Some(clip.clip().rig()),
            #[cfg(feature = "poses")]
            Source::Table(table) => Some(table.rig),
            #[cfg(feature = "character")]
            Source::Character(character) => Some(character.rig()),
        }
    }

    /// Returns the number of playable frames.
    pub fn playable(&self) -> u32 {
        match self {
            Source::Nothing => 0,
            Source::Clip(clip) => clip.playable,
            #[cfg(feature = "poses")]
            Source::Table(table) => table.frames,
            #[cfg(feature = "character")]
            Source::Character(_) => 1,
        }
    }

    /// Moves to a frame, or to the last playable one.
    pub fn go(&mut self, frame: u32) -> Pose<'_> {
        let frame = frame.min(self.playable().saturating_sub(1));
        match self {
            Source::Nothing => Pose { values: &[], form: (&Form::NONE).into() },
            Source::Clip(clip) => clip.go(frame),
            #[cfg(feature = "poses")]
            Source::Table(table) => {
                table.frame = frame;
                table.pose()
            }
            #[cfg(feature = "character")]
            Source::Character(character) => character.pose(),
        }
    }

    /// Returns the current pose.
    pub fn pose(&self) -> Pose<'_> {
        match self {
            Source::Nothing => Pose { values: &[], form: (&Form::NONE).into() },
            Source::Clip(clip) => clip.player().pose(),
            #[cfg(feature = "poses")]
            Source::Table(table) => table.pose(),
            #[cfg(feature = "character")]
            Source::Character(character) => character.pose(),
        }
    }

    /// Returns the current frame.
    pub fn frame(&self) -> u32 {
        match self {
            Source::Nothing => 0,
            Source::Clip(clip) => clip.player().frame(),
            #[cfg(feature = "poses")]
            Source::Table(table) => table.frame,
            #[cfg(feature = "character")]
            Source::Character(_) => 0,
        }
    }

    /// Fills in the facts.
    pub fn tell(&self, facts: &mut Facts) {
        facts.playable = self.playable();
        facts.frame = self.frame();
        facts.pose = self.pose().values.as_ptr() as usize;
        if let Some(rig) = self.rig() {
            facts.channels = rig.channels() as u32;
            facts.joints = rig.joint_count() as u32;
            facts.scalars = (rig.channels() - rig.joint_channels()) as u32;
            let scalars = rig.scalars().bytes();
            (facts.scalars_at, facts.scalars_len) = (scalars.as_ptr() as usize, scalars.len());
        }
        match self {
            Source::Nothing => {}
            Source::Clip(arriving) => {
                let clip = arriving.clip();
                facts.frames = clip.frames();
                facts.frame_time_ns = clip.frame_time_ns();
                facts.looped = clip.looped().into();
                if arriving.whole {
                    facts.moving = arriving.player().states().len() as u32;
                    facts.rig_bytes = clip.rig_len() as u32;
                    facts.motion_bytes = clip.motion_len() as u32;
                }
            }
            #[cfg(feature = "poses")]
            Source::Table(table) => {
                (facts.frames, facts.frame_time_ns) = (table.frames, table.frame_time_ns);
            }
            #[cfg(feature = "character")]
            Source::Character(character) => character.tell(facts),
        }
    }
}
