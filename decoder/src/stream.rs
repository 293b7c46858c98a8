//! Plays bytes that are still coming: each block is checked before it is used, and running dry is no error.

use crate::blocks::{Input, Reader, STRIDE, is_intact};
use crate::channel::ChannelState;
use crate::clip::{Event, Head, event};
use crate::crc;
use crate::entropy::{Cursor, Symbols};
use crate::error::{Memory, OpenError, TooSmall};
use crate::form::{Form, Pose, WrongForm};
use crate::joint::JointRef;
use crate::layout::*;
use crate::play_state::{Channels, PlayState};
use crate::player::values;
use crate::prefix::Prefix;
use crate::rig::Rig;
use crate::segment::MAX_SEGMENT_BYTES;
use crate::start::{ChannelStarts, Opened};
use crate::turn::Turn;

/// What a step of a [`Stream`] came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    Events { left: u32, position: u32, frame: u32 },
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
    /// Where it begins, counted from the motion's first byte.
    base: u32,
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
            self.damaged = !is_intact(block, self.seed);
            if !self.damaged {
                self.checked += block.len();
                self.seed = crc::INITIAL;
            }
        }
    }

    /// Drops the blocks before the one that holds `position`.
    fn drop_before(&mut self, position: u32) {
        let drop = (position - self.base) as usize & !(STRIDE - 1);
        let drop = drop.min(self.checked);
        if drop > 0 {
            for place in 0..self.len - drop {
                let byte = self.buffer.get(place + drop).copied();
                if let (Some(byte), Some(place)) = (byte, self.buffer.get_mut(place)) {
                    *place = byte;
                }
            }
            self.len -= drop;
            self.checked -= drop;
            self.base += drop as u32;
        }
    }

    fn whole(&self) -> bool {
        self.left == 0 && self.checked == self.len
    }

    fn input(&self) -> Input<'_> {
        let end = if self.whole() { self.len.saturating_sub(CRC_BYTES) } else { self.checked };
        Input { bytes: self.buffer.get(..end).unwrap_or(&[]), base: self.base }
    }

    /// The last position at which a segment or a start is sure to be whole.
    fn dry_at(&self) -> u32 {
        if self.whole() { u32::MAX } else { (self.base + self.checked as u32).saturating_sub(MAX_SEGMENT_BYTES) }
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
        let window = Window { buffer, len: 0, checked: 0, base: 0, left: 0, seed: 0, damaged: false };
        let phase = Phase::Prefix(prefix);
        Ok(Stream {
            rig,
            states,
            pose,
            window,
            phase,
            head: Head::default(),
            form: Form::default(),
            position: PlayState::default(),
        })
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
            let Some(&byte) = bytes.get(taken) else { return taken };
            taken += 1;
            match prefix.push(byte, Some(self.rig.id())) {
                Ok(None) => {}
                Ok(Some(motion_len)) => {
                    (self.window.left, self.window.seed) = (motion_len, prefix.seed(motion_len));
                    self.head.flags = prefix.flags;
                    self.phase = Phase::Head;
                }
                Err(error) => self.phase = Phase::Failed(Progress::Damaged(error)),
            }
        }
        taken
    }

    /// Drops the blocks that have been played.
    fn make_space(&mut self) {
        let reading = match &self.phase {
            Phase::Events { position, .. } => *position,
            Phase::Starts(_) | Phase::Frames => self.position.cursor.position,
            Phase::Prefix(_) | Phase::Head | Phase::Failed(_) => 0,
        };
        self.window.drop_before(reading.max(self.window.base));
    }

    /// Goes on as far as one answer.
    pub fn step(&mut self) -> Progress {
        match self.phase {
            Phase::Prefix(_) => Progress::NeedMore,
            Phase::Head => self.head(),
            Phase::Events { left, position, frame } => self.event(left, position, frame),
            Phase::Starts(_) => self.starts(),
            Phase::Frames => self.frame_on(),
            Phase::Failed(step) => step,
        }
    }

    /// What it means that the window ran dry.
    fn dry(&mut self) -> Progress {
        if self.window.damaged { self.fail(Progress::Damaged(OpenError::BadCrc)) } else { Progress::NeedMore }
    }

    fn fail(&mut self, step: Progress) -> Progress {
        self.phase = Phase::Failed(step);
        step
    }

    fn head(&mut self) -> Progress {
        if self.window.checked == 0 {
            let step = if self.window.left == 0 { Progress::Damaged(OpenError::Malformed) } else { Progress::NeedMore };
            return if self.window.damaged { self.dry() } else { step };
        }
        let flags = self.head.flags;
        let rig_id = if flags & HAS_RIG == 0 { Some(self.rig.id()) } else { None };
        match Head::read(&self.window.input(), flags, &self.rig, rig_id) {
            Err(error) => self.fail(Progress::Damaged(error)),
            Ok(head) => {
                self.head = head;
                self.form = head.form(&self.window.input(), self.rig.id());
                self.phase = Phase::Events { left: head.event_count, position: u32::from(head.events), frame: 0 };
                Progress::Opened
            }
        }
    }

    fn event(&mut self, left: u32, position: u32, frame: u32) -> Progress {
        if position > self.window.dry_at() {
            return self.dry();
        }
        let input = self.window.input();
        if left == 0 {
            self.position = PlayState { cursor: Cursor::start(&input, position), ..PlayState::default() };
            self.phase = Phase::Starts(ChannelStarts::new(&self.rig, self.head.length_exponent));
            return self.starts();
        }
        let mut reader = Reader { input: &input, position };
        let event = event(&mut reader, frame);
        if reader.position > input.end() {
            return self.fail(Progress::Damaged(OpenError::Malformed));
        }
        self.phase = Phase::Events { left: left - 1, position: reader.position, frame: event.frame };
        Progress::Event(event)
    }

    fn starts(&mut self) -> Progress {
        let Phase::Starts(starts) = &mut self.phase else { return Progress::NeedMore };
        let (input, dry_at) = (self.window.input(), self.window.dry_at());
        let mut symbols = Symbols { at: self.position.cursor, input };
        let opened = starts.read(&mut symbols, dry_at, self.states, self.pose);
        self.position.cursor = symbols.at;
        match opened {
            Opened::NeedMore => self.dry(),
            Opened::Full => self.fail(Progress::TooSmall),
            Opened::Done => {
                let states = core::mem::take(&mut self.states);
                self.states = states.get_mut(..usize::from(starts.moving)).unwrap_or(&mut []);
                self.phase = Phase::Frames;
                Progress::Frame
            }
        }
    }

    fn frame_on(&mut self) -> Progress {
        let frame = self.position.frame;
        if frame + 1 >= self.head.frames {
            return Progress::End;
        }
        let (input, dry_at) = (self.window.input(), self.window.dry_at());
        let mut channels = Channels { states: &mut *self.states, pose: &mut *self.pose };
        if self.position.try_step(&mut channels, &input, self.head.frames, dry_at, None) { Progress::Frame } else { self.dry() }
    }

    /// The frame that the pose shows.
    pub fn frame(&self) -> u32 {
        self.position.frame
    }

    /// The pose, with its form. It is of one frame also while bytes are missing; before [`Progress::Opened`] it is of no rig's form.
    pub fn pose(&self) -> Pose<'_> {
        Pose { values: self.pose, form: &self.form }
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
