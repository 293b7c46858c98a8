//! Where poses come from: bytes that arrive, a whole clip, or a table.

use crate::arriving::Arriving;
use crate::facts::{Facts, Trouble};
use crate::memory::{Who, past, seat};
use pantin::{Clip, Memory, Player, Rig};

/// Poses as they are, a raw value a channel a frame.
pub struct Table {
    pub rig: Rig<'static>,
    values: &'static [i32],
    frames: u32,
    frame: u32,
    frame_time_ns: u32,
    length_exponent: i8,
}

impl Table {
    /// Of a file that holds a rig and, from the next multiple of 4 on, the values.
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
        Ok(Table { rig, values, frames: frames as u32, frame: 0, frame_time_ns, length_exponent })
    }

    fn pose(&self) -> &[i32] {
        let channels = self.rig.channels();
        let first = self.frame as usize * channels;
        self.values.get(first..first + channels).unwrap_or(&[])
    }
}

/// One of them.
#[allow(clippy::large_enum_variant)]
pub enum Source {
    Nothing,
    Arriving(Arriving),
    Whole(Player<'static, 'static>, Memory<'static>, [u32; 3]),
    Table(Table),
}

impl Source {
    /// A whole file. To be called once.
    pub fn whole(file: &'static [u8]) -> Result<Source, Trouble> {
        let clip = Clip::new_checked(file)?;
        // SAFETY: this is called once.
        let (seat, past) = unsafe { (seat(Who::Whole), past()) };
        let player = Player::new(clip, &mut seat.states, &mut seat.pose)?;
        let memory = Memory::new(&player, &mut [], &mut past.marks, &mut past.states, &mut past.values);
        let sizes = [clip.moving(), clip.rig_len(), clip.motion_len()].map(|size| size as u32);
        Ok(Source::Whole(player, memory, sizes))
    }

    pub fn rig(&self) -> Option<Rig<'static>> {
        match self {
            Source::Nothing => None,
            Source::Arriving(arriving) => Some(arriving.rig),
            Source::Whole(player, ..) => Some(player.clip().rig()),
            Source::Table(table) => Some(table.rig),
        }
    }

    /// Frames that can be shown.
    pub fn playable(&self) -> u32 {
        match self {
            Source::Nothing => 0,
            Source::Arriving(arriving) => arriving.playable(),
            Source::Whole(player, ..) => player.clip().frames(),
            Source::Table(table) => table.frames,
        }
    }

    /// Shows a frame, or the last one that is playable.
    pub fn go(&mut self, frame: u32) -> &[i32] {
        let frame = frame.min(self.playable().saturating_sub(1));
        match self {
            Source::Nothing => &[],
            Source::Arriving(arriving) => arriving.go(frame),
            Source::Whole(player, memory, _) => {
                // Steps are seeks of one frame, and those back start from a snapshot near by: without records of each step.
                player.seek_with(frame, memory);
                player.pose()
            }
            Source::Table(table) => {
                table.frame = frame;
                table.pose()
            }
        }
    }

    /// The pose that is shown.
    pub fn pose(&self) -> &[i32] {
        match self {
            Source::Nothing => &[],
            Source::Arriving(arriving) => arriving.pose(),
            Source::Whole(player, ..) => player.pose(),
            Source::Table(table) => table.pose(),
        }
    }

    pub fn length_exponent(&self) -> i8 {
        match self {
            Source::Nothing => 0,
            Source::Arriving(arriving) => arriving.head().length_exponent(),
            Source::Whole(player, ..) => player.clip().length_exponent(),
            Source::Table(table) => table.length_exponent,
        }
    }

    pub fn is_exponential(&self, joint: usize) -> bool {
        match self {
            Source::Arriving(arriving) => arriving.is_exponential(joint),
            Source::Whole(player, ..) => player.clip().is_exponential(joint),
            Source::Nothing | Source::Table(_) => false,
        }
    }

    /// All but the kind.
    pub fn facts(&self) -> Facts {
        let facts =
            Facts { playable: self.playable(), channels: self.rig().map_or(0, |rig| rig.channels() as u32), ..Facts::NONE };
        match self {
            Source::Nothing => facts,
            Source::Arriving(arriving) => {
                let head = arriving.head();
                let (frames, frame_time_ns, looped) = (head.frames(), head.frame_time_ns(), head.looped().into());
                Facts { frames, frame: arriving.frame(), frame_time_ns, looped, ..facts }
            }
            Source::Whole(player, _, [moving, rig_bytes, motion_bytes]) => Facts {
                frames: player.clip().frames(),
                frame: player.frame(),
                frame_time_ns: player.clip().frame_time_ns(),
                looped: player.clip().looped().into(),
                moving: *moving,
                rig_bytes: *rig_bytes,
                motion_bytes: *motion_bytes,
                ..facts
            },
            Source::Table(Table { frames, frame, frame_time_ns, .. }) => {
                Facts { frames: *frames, frame: *frame, frame_time_ns: *frame_time_ns, ..facts }
            }
        }
    }
}
