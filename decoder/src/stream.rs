//! Plays bytes that are still coming: each block is checked before it is used, and running dry is no error.

use crate::blocks::{Input, STRIDE, behind_crc, is_intact};
use crate::bytes::Reader;
use crate::channel::ChannelState;
use crate::clip::{Event, Head, event};
use crate::crc;
use crate::entropy::{Cursor, Symbols};
use crate::error::{Memory, OpenError, TooSmall};
use crate::form::{Form, WrongForm};
use crate::joint::JointRef;
use crate::layout::*;
use crate::play_state::{Channels, PlayState};
use crate::player::values;
use crate::pose::Pose;
use crate::prefix::Prefix;
use crate::rig::Rig;
use crate::segment::MAX_SEGMENT_BYTES;
use crate::start::ChannelStarts;
use crate::turn::Turn;

/// What a step of a [`Stream`] came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Progress {
    /// Feed more bytes. The pose is to be shown again only after the next `Frame`.
    NeedMore,
    /// The clip's head has been read: what the clip says of itself is known from here on.
    Opened,
    /// An event marker; they come all before the first frame.
    Event(Event),
    /// The pose shows the next frame.
    Frame,
    /// The last frame was the clip's last.
    End,
    /// The bytes that follow are damaged, or no clip for this rig. It stays so.
    Damaged(OpenError),
    /// More channels move than there are states. It stays so.
    TooSmall,
}

/// What is read next.
#[derive(Debug)]
enum Phase<'a> {
    Prefix(Prefix),
    Head,
    Events { left: u32, frame: u32 },
    Starts(ChannelStarts<'a>),
    Frames,
    Failed(Progress),
}

/// The bytes of the motion that are at hand, in the caller's memory: whole blocks, and the part of one.
#[derive(Debug)]
struct Window<'m> {
    buffer: &'m mut [u8],
    /// Bytes in it, and how many of them are of blocks that were checked.
    len: usize,
    checked: usize,
    /// Bytes of the motion that are not yet in it.
    left: u32,
    /// What the next block's CRC goes on from.
    seed: u16,
    damaged: bool,
}

impl Window<'_> {
    /// The part of the buffer that bytes can be written to.
    fn space(&mut self) -> &mut [u8] {
        let room = self.buffer.len().saturating_sub(self.len).min(self.left as usize);
        self.buffer.get_mut(self.len..self.len + room).unwrap_or(&mut [])
    }

    /// Copies what fits, and returns how much.
    fn fill(&mut self, bytes: &[u8]) -> usize {
        let mut count = 0;
        for (place, byte) in self.space().iter_mut().zip(bytes) {
            *place = *byte;
            count += 1;
        }
        self.filled(count);
        count
    }

    /// Takes bytes that stand in [`Window::space`], and checks the blocks that are whole.
    fn filled(&mut self, count: usize) {
        self.len += count;
        self.left -= count as u32;
        while !self.damaged && self.checked < self.len {
            let rest = self.buffer.get(self.checked..self.len).unwrap_or(&[]);
            let block = rest.get(..STRIDE).unwrap_or(rest);
            if block.len() < STRIDE && self.left > 0 {
                break;
            }
            if is_intact(block, self.seed) {
                self.checked += block.len();
                self.seed = crc::INITIAL;
            } else {
                self.damaged = true;
            }
        }
    }

    /// Drops the blocks before the one that holds `position`, which moves with the bytes.
    fn drop_before(&mut self, position: &mut u32) {
        let drop = (*position as usize & !(STRIDE - 1)).min(self.checked);
        if drop > 0 {
            for place in 0..self.len - drop {
                let byte = self.buffer.get(place + drop).copied();
                if let (Some(byte), Some(place)) = (byte, self.buffer.get_mut(place)) {
                    *place = byte;
                }
            }
            self.len -= drop;
            self.checked -= drop;
            *position -= drop as u32;
        }
    }

    /// The blocks that can be read, and the last position at which a segment or a start is sure to be whole.
    fn at_hand(&self) -> (Input<'_>, u32) {
        let whole = self.left == 0 && self.checked == self.len;
        let (end, dry_at) = if whole {
            (self.len.saturating_sub(CRC_BYTES), u32::MAX)
        } else {
            (self.checked, (self.checked as u32).saturating_sub(MAX_SEGMENT_BYTES))
        };
        (Input(self.buffer.get(..end).unwrap_or(&[])), dry_at)
    }
}

/// Plays a clip of a known rig from pieces of any size: a file (its own rig is passed over if it is the known one) from its
/// first byte on. Bit for bit the poses of a [`crate::Player`].
///
/// Call [`Stream::step`] until it answers [`Progress::NeedMore`], then [`Stream::feed`].
#[derive(Debug)]
pub struct Stream<'a, 'm> {
    rig: Rig<'a>,
    states: &'m mut [ChannelState],
    pose: &'m mut [i32],
    window: Window<'m>,
    phase: Phase<'a>,
    head: Head,
    form: Form,
    position: PlayState,
}

impl<'a, 'm> Stream<'a, 'm> {
    /// Bytes that `buffer` needs at least. It holds what has come and has not been played.
    pub const BUFFER: usize = 2 * STRIDE;

    /// Waits for the first byte. `states` needs an element a moving channel ([`crate::Rig::channels`] always suffice), `pose`
    /// one a channel of the rig.
    pub fn new(
        rig: Rig<'a>,
        buffer: &'m mut [u8],
        states: &'m mut [ChannelState],
        pose: &'m mut [i32],
    ) -> Result<Self, TooSmall> {
        Self::behind(Prefix::default(), rig, buffer, states, pose)
    }

    /// A stream that continues behind the fields that `prefix` has seen.
    pub(crate) fn behind(
        prefix: Prefix,
        rig: Rig<'a>,
        buffer: &'m mut [u8],
        states: &'m mut [ChannelState],
        pose: &'m mut [i32],
    ) -> Result<Self, TooSmall> {
        let pose = values(pose, rig.channels())?;
        if buffer.len() < Self::BUFFER {
            return Err(TooSmall { memory: Memory::Buffer, needed: Self::BUFFER, given: buffer.len() });
        }
        let window = Window { buffer, len: 0, checked: 0, left: 0, seed: 0, damaged: false };
        let phase = Phase::Prefix(prefix);
        Ok(Stream { rig, states, pose, window, phase, head: Head::NONE, form: Form::NONE, position: PlayState::default() })
    }

    /// Takes bytes and returns how many: fewer than all if the buffer is full (then step, and feed the rest) or the motion is
    /// complete (what follows is not the stream's).
    #[must_use = "the bytes that were not taken must be fed again"]
    pub fn feed(&mut self, bytes: &[u8]) -> usize {
        let taken = self.take_prefix(bytes);
        self.make_space();
        taken + self.window.fill(bytes.get(taken..).unwrap_or(&[]))
    }

    /// The free part of the buffer, for a UART or DMA that writes to memory itself: write to its front, then call
    /// [`Stream::filled`]. It is empty if the buffer is full (then step) or the motion is complete.
    pub fn space(&mut self) -> &mut [u8] {
        if let Phase::Prefix(_) = self.phase {
            return self.window.buffer;
        }
        self.make_space();
        self.window.space()
    }

    /// Takes the first `count` bytes of [`Stream::space`]. Bytes behind the motion are dropped.
    pub fn filled(&mut self, count: usize) {
        let Phase::Prefix(_) = self.phase else {
            let count = count.min(self.window.space().len());
            return self.window.filled(count);
        };
        // The motion begins behind the prefix: it moves to the buffer's front.
        let buffer = core::mem::take(&mut self.window.buffer);
        let taken = self.take_prefix(buffer.get(..count).unwrap_or(buffer));
        buffer.copy_within(taken..count.min(buffer.len()).max(taken), 0);
        self.window.buffer = buffer;
        let count = count.saturating_sub(taken).min(self.window.space().len());
        self.window.filled(count);
    }

    /// Goes on through the fields before the motion, and returns how many bytes they took.
    fn take_prefix(&mut self, bytes: &[u8]) -> usize {
        let mut taken = 0;
        while let Phase::Prefix(prefix) = &mut self.phase {
            let Some(&byte) = bytes.get(taken) else { break };
            taken += 1;
            match prefix.push(byte, Some(self.rig.id())) {
                Ok(false) => {}
                #[cfg(feature = "keys")]
                Ok(true) if prefix.flags() & crate::codec::keys::KEYS != 0 => {
                    let version = crate::codec::keys::KEY_VERSION;
                    self.phase = Phase::Failed(Progress::Damaged(OpenError::UnsupportedVersion(version)));
                }
                Ok(true) => {
                    (self.window.left, self.window.seed) = (prefix.motion_len(), prefix.seed());
                    self.head.flags = prefix.flags();
                    self.phase = Phase::Head;
                }
                Err(error) => self.phase = Phase::Failed(Progress::Damaged(error)),
            }
        }
        taken
    }

    /// Drops the blocks that have been played.
    fn make_space(&mut self) {
        self.window.drop_before(&mut self.position.cursor.position);
    }

    /// Goes on as far as one answer.
    pub fn step(&mut self) -> Progress {
        let mut progress = self.try_step();
        if self.window.damaged && matches!(progress, Progress::NeedMore) {
            progress = Progress::Damaged(OpenError::BadCrc);
        }
        if let Progress::Damaged(_) | Progress::TooSmall = progress {
            self.phase = Phase::Failed(progress);
        }
        progress
    }

    /// [`Stream::step`] up to where the window ran dry.
    fn try_step(&mut self) -> Progress {
        let (input, dry_at) = self.window.at_hand();
        let position = &mut self.position;
        if let Phase::Events { left, frame } = &mut self.phase {
            if position.cursor.position > dry_at {
                return Progress::NeedMore;
            }
            if *left > 0 {
                let mut reader = Reader::of_blocks(&input, position.cursor.position);
                let event = event(&mut reader, *frame);
                if reader.position > behind_crc(input.0.len() as u32) {
                    return Progress::Damaged(OpenError::Malformed);
                }
                (*left, *frame) = (*left - 1, event.frame);
                position.cursor.position = reader.position;
                return Progress::Event(event);
            }
            position.cursor = Cursor::start(&input, position.cursor.position);
            self.phase = Phase::Starts(ChannelStarts::new(&self.rig, self.head.length_exponent));
        }
        match &mut self.phase {
            Phase::Failed(progress) => return *progress,
            Phase::Head if self.window.checked > 0 => {
                if let Err(error) = self.head.read(&input, &self.rig) {
                    return Progress::Damaged(error);
                }
                self.form = self.head.form(&input, self.rig.id()).to_form();
                position.cursor.position = u32::from(self.head.events);
                self.phase = Phase::Events { left: self.head.event_count, frame: 0 };
                return Progress::Opened;
            }
            Phase::Head if self.window.left == 0 && !self.window.damaged => return Progress::Damaged(OpenError::Malformed),
            Phase::Starts(starts) => {
                let mut symbols = Symbols { at: position.cursor, input };
                let done = starts.read(&mut symbols, dry_at, self.states, self.pose);
                position.cursor = symbols.at;
                if done {
                    let states = core::mem::take(&mut self.states);
                    let Some(states) = states.get_mut(..usize::from(starts.moving)) else { return Progress::TooSmall };
                    self.states = states;
                    self.phase = Phase::Frames;
                    return Progress::Frame;
                }
            }
            Phase::Frames => {
                if position.frame + 1 >= self.head.frames {
                    return Progress::End;
                }
                let mut channels = Channels { states: &mut *self.states, pose: &mut *self.pose };
                if position.try_step(&mut channels, &input, self.head.frames, dry_at, None) {
                    return Progress::Frame;
                }
            }
            Phase::Prefix(_) | Phase::Head | Phase::Events { .. } => {}
        }
        Progress::NeedMore
    }

    /// The frame that the pose shows.
    pub fn frame(&self) -> u32 {
        self.position.frame
    }

    /// The pose, with its form. It is of one frame also while bytes are missing; before [`Progress::Opened`] it is of no rig's form.
    pub fn pose(&self) -> Pose<'_> {
        Pose { values: self.pose, form: (&self.form).into() }
    }

    /// The rotation of a joint, however the clip codes it: [`Pose::turn`].
    pub fn turn(&self, joint: &JointRef<'_>) -> Result<Turn, WrongForm> {
        self.pose().turn(joint)
    }

    /// Number of frames; 0 before [`Progress::Opened`].
    pub fn frames(&self) -> u32 {
        self.head.frames
    }

    /// Time from one frame to the next; 0 before [`Progress::Opened`].
    pub fn frame_time_ns(&self) -> u32 {
        self.head.frame_time_ns
    }

    /// Whether frame 0 follows the last frame.
    pub fn looped(&self) -> bool {
        self.head.flags & LOOPED != 0
    }
}
