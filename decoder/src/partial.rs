//! A file that is still coming, kept as a whole: its blocks are checked as they come, and played where they lie.

use crate::blocks::{STRIDE, is_intact};
use crate::channel::ChannelState;
use crate::clip::{Clip, Parts};
use crate::layout::CRC_BYTES;
use crate::play_state::PlayState;
use crate::player::{Player, SeekCache};
use crate::segment::MAX_SEGMENT_BYTES;
use crate::{OpenError, TooSmall, crc};

/// The front of a file: as much of a [`Clip`] as is there. For bytes that are not kept there is [`crate::Stream`].
#[derive(Clone, Copy, Debug)]
pub struct PartialClip<'a> {
    clip: Clip<'a>,
    /// Bytes of the motion's blocks that were checked, their CRCs included.
    checked: usize,
    /// The last position at which a segment or a start is sure to be whole.
    dry_at: u32,
}

impl<'a> PartialClip<'a> {
    /// Reads the head of what has come of a file. After [`OpenError::Truncated`] it may be tried again with more. That a later block is damaged,
    /// [`PartialClip::extend`] tells.
    pub fn new(file: &'a [u8]) -> Result<PartialClip<'a>, OpenError> {
        PartialClip::with_rig(file, &[])
    }

    /// Reads the head of what has come of a file without a rig, such as one of a bank, with the rig that it was made for. A file that holds its own is
    /// opened with that. It cannot be paused.
    #[inline(never)]
    pub fn with_rig(file: &'a [u8], rig: &'a [u8]) -> Result<PartialClip<'a>, OpenError> {
        let file = Arrived::split(file)?;
        let (checked, outcome) = file.check(0);
        if checked == 0 {
            outcome?;
            return Err(OpenError::Truncated);
        }
        let short = if checked < file.motion_len { OpenError::Truncated } else { OpenError::Malformed };
        let mut clip = Clip::NONE;
        clip.read(&file.parts, rig, file.rest.get(..checked).unwrap_or(&[]), short)?;
        let dry_at = file.dry_at(checked);
        if clip.symbols() > dry_at {
            return Err(OpenError::Truncated);
        }
        Ok(PartialClip { clip, checked, dry_at })
    }

    /// Takes a longer beginning of the same file. A damaged block is reported by every call, and the frames before it stay playable.
    pub fn extend(&mut self, file: &'a [u8]) -> Result<(), OpenError> {
        let file = Arrived::split(file)?;
        let (checked, outcome) = file.check(self.checked);
        // What a decoder reads past the end is zeros, not the last CRC.
        if let Some(motion) = checked.checked_sub(CRC_BYTES).and_then(|end| file.rest.get(..end)) {
            self.clip.motion = motion;
        }
        (self.checked, self.dry_at) = (checked, file.dry_at(checked));
        outcome
    }

    /// Checks that `file`, which it was extended by, is whole. From then on, events have their names.
    pub fn finish(&mut self, file: &'a [u8]) -> Result<(), OpenError> {
        let mut parts = Parts::new(file);
        parts.read()?;
        let motion = parts.reader.name();
        parts.reader.check()?;
        if self.checked != motion.len() {
            return Err(OpenError::BadCrc);
        }
        let [_, names] = parts.tail(motion)?;
        self.clip.names = names;
        Ok(())
    }

    /// What is known of the clip.
    pub fn clip(&self) -> &Clip<'a> {
        &self.clip
    }

    /// A player at frame 0; `None` while that has not come. `states` and `pose` need [`crate::Rig::channels`] elements.
    pub fn player<'m>(&self, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Option<Player<'a, 'm>>, TooSmall> {
        Player::from_partial(self.clip, self.dry_at, states, pose)
    }

    /// Goes on by one frame with a player of it; false if not all of that has come, or at the last frame. Then the player may have read some of the next
    /// segments: it may go on by this, or back.
    pub fn step(&self, player: &mut Player<'a, '_>) -> bool {
        player.step_partial(&self.clip, self.dry_at)
    }

    /// Goes with a player of it to a frame that [`PartialClip::step`] has come to, as [`Player::seek_with`] does, but not by snapshots in the file.
    pub fn seek(&self, player: &mut Player<'a, '_>, frame: u32, memory: &mut SeekCache<'_>) {
        player.seek_partial(&self.clip, frame, memory);
    }
}

/// The beginning of a file.
struct Arrived<'a> {
    parts: Parts<'a>,
    /// What has come behind the motion's length, and that length.
    rest: &'a [u8],
    motion_len: usize,
}

impl<'a> Arrived<'a> {
    fn split(file: &'a [u8]) -> Result<Arrived<'a>, OpenError> {
        let mut parts = Parts::new(file);
        parts.read()?;
        let motion_len = parts.reader.varint() as usize;
        parts.reader.check()?;
        Ok(Arrived { rest: parts.reader.rest(), parts, motion_len })
    }

    /// Checks the motion's whole blocks from the first one that was not: how many bytes of them are good.
    fn check(&self, mut checked: usize) -> (usize, Result<(), OpenError>) {
        let motion = self.rest.get(..self.motion_len).unwrap_or(self.rest);
        for block in motion.get(checked..).unwrap_or(&[]).chunks(STRIDE) {
            if block.len() < STRIDE && motion.len() < self.motion_len {
                break;
            }
            let seed = if checked == 0 { crc::of_prefix(self.parts.flags, self.motion_len as u32) } else { crc::INITIAL };
            if !is_intact(block, seed) {
                return (checked, Err(OpenError::BadCrc));
            }
            checked += block.len();
        }
        (checked, Ok(()))
    }

    fn dry_at(&self, checked: usize) -> u32 {
        if checked < self.motion_len { (checked as u32).saturating_sub(MAX_SEGMENT_BYTES) } else { u32::MAX }
    }
}

/// A [`PartialClip`] and its player without the bytes: while the buffer that holds them grows, nothing borrows it.
///
/// ```
/// # fn read(_: &mut Vec<u8>) -> bool { false }
/// # fn play(mut file: Vec<u8>) -> Result<(), Box<dyn std::error::Error>> {
/// use pantin::{ChannelState, PartialClip};
/// let (mut states, mut values) = ([ChannelState::NEW; 144], [0; 144]);
/// let partial = PartialClip::new(&file)?;
/// let Some(player) = partial.player(&mut states, &mut values)? else { return Ok(()) };
/// let mut paused = partial.pause(player);
/// while read(&mut file) {
///     let (partial, mut player) = paused.resume(&file, &mut states, &mut values)?;
///     while partial.step(&mut player) {
///         let _pose = player.pose();
///     }
///     paused = partial.pause(player);
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PausedClip {
    clip: Clip<'static>,
    checked: usize,
    moving: usize,
    position: PlayState,
}

impl PartialClip<'_> {
    /// Gives the borrowed bytes and memory back, which must stay as they are until [`PausedClip::resume`].
    pub fn pause(self, player: Player<'_, '_>) -> PausedClip {
        let (moving, position) = player.pause();
        PausedClip { clip: self.clip.without_bytes(), checked: self.checked, moving, position }
    }
}

impl PausedClip {
    /// Continues with `file`, which begins with the bytes that were there before: they are not checked again. `states` and `values`
    /// are those of the player. A damaged block among the new bytes is an error each time; what stands before it stays playable
    /// with the shorter front.
    pub fn resume<'a, 'm>(
        &self,
        file: &'a [u8],
        states: &'m mut [ChannelState],
        values: &'m mut [i32],
    ) -> Result<(PartialClip<'a>, Player<'a, 'm>), OpenError> {
        let clip = self.clip.with_bytes(Arrived::split(file)?.parts.rig);
        let mut partial = PartialClip { clip, checked: self.checked, dry_at: 0 };
        partial.extend(file)?;
        let player = Player::resume(partial.clip, self.moving, self.position, states, values).ok_or(OpenError::Truncated)?;
        Ok((partial, player))
    }
}
