//! A clip: bytes checked once. Afterwards playing cannot fail.

use crate::blocks::{self, Input, STRIDE, behind_crc};
use crate::bytes::Reader;
use crate::channel::ChannelState;
use crate::entropy::{Cursor, Symbols};
use crate::form::{CodedKinds, Form, FormRef};
use crate::joint::JointRef;
#[cfg(feature = "keys")]
use crate::keys::layout::{KEY_FLAGS, KEY_VERSION, KEYS, MAX_KEY_FRAMES, MAX_STATES};
use crate::layout::*;
use crate::rig::Rig;
use crate::scalar::ScalarRef;
use crate::start::ChannelStarts;
use crate::{OpenError, crc};

/// A checked clip.
#[derive(Clone, Copy, Debug)]
pub struct Clip<'a> {
    rig: Rig<'a>,
    pub(crate) motion: &'a [u8],
    /// Bytes of the rig in the file, with those of its length.
    rig_len: usize,
    head: Head,
    /// Where the symbols begin.
    symbols: u32,
    /// Snapshots; empty if there are none.
    index: &'a [u8],
    /// Names of events, without their CRC.
    pub(crate) names: &'a [u8],
}

/// The fields in front of a motion's symbols.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Head {
    pub(crate) flags: u8,
    pub(crate) length_exponent: i8,
    /// Where the exponential-map bits are: at 15 at most, so that all are in the first block.
    exponentials: u8,
    exponential_bytes: u8,
    /// Where the events begin.
    pub(crate) events: u8,
    pub(crate) frames: u32,
    pub(crate) frame_time_ns: u32,
    pub(crate) event_count: u32,
    /// States that a key clip needs.
    #[cfg(feature = "keys")]
    states: u16,
}

/// The fields of a file in front of the motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts<'a> {
    pub(crate) flags: u8,
    /// The rig, and how many bytes of the file are its and its length's.
    pub(crate) rig: &'a [u8],
    pub(crate) rig_len: usize,
    /// Reads what follows: the motion's length.
    pub(crate) reader: Reader<'a>,
}

impl<'a> Parts<'a> {
    /// Before the first field.
    pub(crate) fn new(file: &'a [u8]) -> Parts<'a> {
        Parts { flags: 0, rig: &[], rig_len: 0, reader: Reader::new(file) }
    }

    /// Reads the fields.
    #[inline(never)]
    pub(crate) fn read(&mut self) -> Result<(), OpenError> {
        let fixed = self.reader.u32().to_le_bytes();
        self.reader.check()?;
        self.flags = check_fixed(fixed)?;
        if self.flags & HAS_RIG != 0 {
            self.rig = self.reader.name();
            self.rig_len = self.reader.position as usize - fixed.len();
        }
        self.reader.check()
    }

    /// Reads a length, then that many bytes of blocks, and checks them; `crc` is what their first CRC continues, behind the length.
    #[inline(never)]
    fn blocks(&mut self, crc: u16) -> Result<&'a [u8], OpenError> {
        let len = self.reader.varint();
        let bytes = self.reader.take(len);
        self.reader.check()?;
        blocks::check(bytes, crc::update(crc, &len.to_le_bytes()))?;
        Ok(bytes)
    }

    /// Checks what follows the motion: snapshots and names of events, if there are any. Behind them the file ends, or sections follow that
    /// this version does not define.
    pub(crate) fn tail(&mut self, motion: &[u8]) -> Result<[&'a [u8]; 2], OpenError> {
        let (mut index, mut names) = (&[][..], &[][..]);
        if self.flags & HAS_INDEX != 0 {
            let last_crc = motion.last_chunk().copied().map_or(0, u16::from_le_bytes);
            index = without_last_crc(self.blocks(last_crc)?)?;
        }
        if self.flags & HAS_EVENT_NAMES != 0 {
            names = self.reader.name();
            self.reader.check()?;
            if !blocks::is_intact(names, crc::INITIAL) {
                return Err(OpenError::BadCrc);
            }
            names = without_last_crc(names)?;
            let mut walk = Reader::new(names);
            while !walk.rest().is_empty() {
                walk.name();
            }
            walk.check()?;
        }
        let ends = self.flags & HAS_SECTIONS != 0 || self.reader.rest().is_empty();
        if ends { Ok([index, names]) } else { Err(OpenError::Malformed) }
    }
}

/// Checks the magic, the version and the flags, which it returns; those of a key clip with [`KEYS`](crate::keys::layout::KEYS).
pub(crate) fn check_fixed([magic0, magic1, version, flags]: [u8; 4]) -> Result<u8, OpenError> {
    #[cfg(feature = "keys")]
    if ([magic0, magic1], version) == (MAGIC, KEY_VERSION) {
        return if flags & !KEY_FLAGS == 0 { Ok(flags | KEYS) } else { Err(OpenError::Malformed) };
    }
    if [magic0, magic1] != MAGIC {
        Err(if [magic0, magic1] == BANK_MAGIC { OpenError::IsBank } else { OpenError::BadMagic })
    } else if version != VERSION {
        Err(OpenError::UnsupportedVersion(version))
    } else if flags & !KNOWN_FLAGS != 0 {
        Err(OpenError::Malformed)
    } else {
        Ok(flags)
    }
}

/// Checked blocks without the last CRC: what a decoder reads past the end is zeros.
fn without_last_crc(blocks: &[u8]) -> Result<&[u8], OpenError> {
    blocks.split_last_chunk::<CRC_BYTES>().map(|(blocks, _)| blocks).ok_or(OpenError::Malformed)
}

impl Head {
    pub(crate) const NONE: Head = Head {
        flags: 0,
        length_exponent: 0,
        exponentials: 0,
        exponential_bytes: 0,
        events: 0,
        frames: 0,
        frame_time_ns: 0,
        event_count: 0,
        #[cfg(feature = "keys")]
        states: 0,
    };

    /// Reads the head of a motion that was made for `rig`, up to its events.
    #[inline(never)]
    pub(crate) fn read(&mut self, input: &Input<'_>, rig: &Rig<'_>) -> Result<(), OpenError> {
        let mut reader = Reader::of_blocks(input, 0);
        let rate = reader.byte();
        // 0 where there is none of this index, and where the time follows.
        self.frame_time_ns = FRAME_TIMES_NS.get(usize::from(rate)).copied().unwrap_or(0);
        if rate == 0 {
            self.frame_time_ns = reader.u32();
        }
        self.frames = reader.varint();
        self.length_exponent = reader.byte() as i8;
        if self.frame_time_ns == 0 || self.frames.wrapping_sub(1) >= MAX_FRAMES || !(-63..=31).contains(&self.length_exponent) {
            return Err(OpenError::Malformed);
        }
        if self.flags & HAS_RIG == 0 && reader.u32() != rig.id() {
            return Err(OpenError::WrongRig);
        }
        self.exponentials = reader.position as u8;
        if self.flags & HAS_EXPONENTIALS != 0 {
            // A joint with a choice has three channels: 43 bytes at most.
            self.exponential_bytes = rig.choices().div_ceil(8) as u8;
            reader.position += u32::from(self.exponential_bytes);
        }
        #[cfg(feature = "keys")]
        if self.flags & KEYS != 0 {
            let states = reader.varint();
            if self.frames > MAX_KEY_FRAMES || states > MAX_STATES {
                return Err(OpenError::Malformed);
            }
            self.states = states as u16;
        }
        if self.flags & HAS_EVENTS != 0 {
            self.event_count = reader.varint();
        }
        self.events = reader.position as u8;
        Ok(())
    }

    /// What the values of the clip's poses mean. `input` holds the motion's first block.
    pub(crate) fn form<'a>(&self, input: &Input<'a>, rig_id: u32) -> FormRef<'a> {
        let first = usize::from(self.exponentials);
        let bits = input.0.get(first..).unwrap_or(&[]);
        let bits = bits.get(..usize::from(self.exponential_bytes)).unwrap_or(bits);
        FormRef { rig_id, length_exponent: self.length_exponent, exponentials: bits }
    }
}

/// The name of the events at which the left foot begins to bear weight.
pub const LEFT_FOOT_DOWN: &str = "left_foot_down";
/// The name of the events at which the right foot begins to bear weight.
pub const RIGHT_FOOT_DOWN: &str = "right_foot_down";

/// A marker of a moment that a program may react to: a footfall, a sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Event {
    /// The frame it stands at.
    pub frame: u32,
    /// Selects its name, if it has one ([`Clip::event_name`]); otherwise the application defines what it means.
    pub id: u32,
}

impl<'a> Clip<'a> {
    /// Checks a file that holds its rig.
    pub fn new_checked(file: &'a [u8]) -> Result<Clip<'a>, OpenError> {
        Clip::with_rig(file, &[])
    }

    /// Checks a file without a rig (`pantin convert --rig-out`), with the rig that it was made for.
    /// A file that holds its own is opened with that.
    pub fn with_rig(file: &'a [u8], rig: &'a [u8]) -> Result<Clip<'a>, OpenError> {
        let mut clip = Clip::NONE;
        clip.open(file, rig)?;
        Ok(clip)
    }

    pub(crate) const NONE: Clip<'a> =
        Clip { rig: Rig::NONE, motion: &[], rig_len: 0, head: Head::NONE, symbols: 0, index: &[], names: &[] };

    /// Checks a file without a rig, with the rig that it was made for, which is checked already: many clips of one rig open faster than with
    /// [`Clip::with_rig`]. A file that holds its own rig is [`OpenError::Malformed`].
    pub fn with_checked_rig(file: &'a [u8], rig: Rig<'a>) -> Result<Clip<'a>, OpenError> {
        let mut clip = Clip { rig, ..Clip::NONE };
        let mut parts = Parts::new(file);
        parts.read()?;
        if parts.flags & HAS_RIG != 0 {
            return Err(OpenError::Malformed);
        }
        let motion = clip.check_rest(&mut parts)?;
        clip.head.flags = parts.flags;
        clip.read_front(motion, OpenError::Malformed)?;
        Ok(clip)
    }

    #[inline(never)]
    fn open(&mut self, file: &'a [u8], rig: &'a [u8]) -> Result<(), OpenError> {
        let mut parts = Parts::new(file);
        parts.read()?;
        let motion = self.check_rest(&mut parts)?;
        self.read(&parts, rig, motion, OpenError::Malformed)
    }

    /// Checks what follows the rig: the motion, whose blocks it returns, the index and the names of events.
    #[inline(always)]
    fn check_rest(&mut self, parts: &mut Parts<'a>) -> Result<&'a [u8], OpenError> {
        let motion = parts.blocks(crc::of_front(parts.flags))?;
        [self.index, self.names] = parts.tail(motion)?;
        Ok(motion)
    }

    /// Reads the rig, and the front of a motion before its symbols: `motion` is of checked blocks. `short` is what it means that the events
    /// go on past them.
    #[inline(never)]
    pub(crate) fn read(&mut self, parts: &Parts<'a>, rig: &'a [u8], motion: &'a [u8], short: OpenError) -> Result<(), OpenError> {
        (self.head.flags, self.rig_len) = (parts.flags, parts.rig_len);
        let rig = if parts.flags & HAS_RIG != 0 { parts.rig } else { rig };
        if rig.is_empty() {
            return Err(OpenError::WrongRig);
        }
        self.rig.read(rig)?;
        self.read_front(motion, short)
    }

    /// [`Clip::read`] behind the rig.
    #[inline(always)]
    fn read_front(&mut self, motion: &'a [u8], short: OpenError) -> Result<(), OpenError> {
        self.motion = without_last_crc(motion)?;
        let input = self.input();
        self.head.read(&input, &self.rig)?;
        let mut reader = Reader::of_blocks(&input, u32::from(self.head.events));
        for _ in 0..self.head.event_count {
            event(&mut reader, 0);
            if reader.position > behind_crc(input.0.len() as u32) {
                return Err(short);
            }
        }
        self.symbols = reader.position;
        Ok(())
    }

    /// All but the bytes.
    pub(crate) fn without_bytes(&self) -> Clip<'static> {
        Clip {
            rig: self.rig.with_bytes(&[]),
            motion: &[],
            index: &[],
            names: &[],
            rig_len: self.rig_len,
            head: self.head,
            symbols: self.symbols,
        }
    }

    /// The same clip in other bytes, of which those of the motion and an index are not there yet.
    pub(crate) fn with_bytes<'b>(&self, rig: &'b [u8]) -> Clip<'b> {
        let body = rig.split_last_chunk::<CRC_BYTES>().map_or(&[][..], |(body, _)| body);
        Clip {
            rig: self.rig.with_bytes(body),
            motion: &[],
            index: &[],
            names: &[],
            rig_len: self.rig_len,
            head: self.head,
            symbols: self.symbols,
        }
    }

    /// The figure.
    pub fn rig(&self) -> Rig<'a> {
        self.rig
    }

    /// Number of frames, at least 1.
    pub fn frames(&self) -> u32 {
        self.head.frames
    }

    /// Time from one frame to the next.
    pub fn frame_time_ns(&self) -> u32 {
        self.head.frame_time_ns
    }

    /// Whether frame 0 follows the last frame.
    pub fn looped(&self) -> bool {
        self.head.flags & LOOPED != 0
    }

    /// The raw value of a position channel times 2^`length_exponent` is in units of the source.
    pub fn length_exponent(&self) -> i8 {
        self.head.length_exponent
    }

    /// Bytes of the file that the rig takes, 0 if it stands apart.
    pub fn rig_len(&self) -> usize {
        self.rig_len
    }

    /// Bytes of the motion with its CRCs: the file without its rig and its first few bytes.
    pub fn motion_len(&self) -> usize {
        self.motion.len() + CRC_BYTES
    }

    /// Bytes of CRCs.
    pub fn crc_len(&self) -> usize {
        self.motion.len().div_ceil(STRIDE) * CRC_BYTES
    }

    /// Bytes in front of the first channel's symbols.
    pub fn head_len(&self) -> usize {
        self.symbols as usize
    }

    /// What the raw values of the clip's poses mean. Clips of one rig can have different forms.
    pub fn form(&self) -> Form {
        self.form_ref().to_form()
    }

    /// [`Clip::form`] where it stands.
    pub fn form_ref(&self) -> FormRef<'a> {
        self.head.form(&self.input(), self.rig.id())
    }

    /// Whether the clip codes this joint's three rotation channels as the x, y and z of an exponential map.
    pub fn is_exponential(&self, joint: usize) -> bool {
        self.form_ref().is_exponential(&self.rig, joint)
    }

    /// The kinds of a joint's channels as the clip codes them; none for a joint that the rig lacks. They differ from the rig's
    /// where three Euler angles are coded as an exponential map.
    pub fn kinds(&self, joint: usize) -> CodedKinds<'a> {
        let kinds = self.rig.joint(joint).map_or(crate::Kinds::NONE, |joint| joint.kinds);
        CodedKinds { kinds, exponential: self.is_exponential(joint), turned: 0 }
    }

    /// Finds a joint by its name: [`Rig::find`].
    pub fn find(&self, joint: &str) -> Option<JointRef<'a>> {
        self.rig.find(joint)
    }

    /// Finds a scalar by its name: [`Rig::find_scalar`].
    pub fn find_scalar(&self, scalar: &str) -> Option<ScalarRef> {
        self.rig.find_scalar(scalar)
    }

    /// Time from frame 0 to the end: of a loop until frame 0 comes again, else until the last frame.
    pub fn duration_ns(&self) -> u64 {
        let steps = if self.looped() { self.frames() } else { self.frames() - 1 };
        u64::from(steps) * u64::from(self.frame_time_ns())
    }

    /// The frame that is shown at a time after frame 0. A loop goes on for ever; another clip stays at its last frame.
    pub fn frame_at(&self, elapsed_us: u64) -> u32 {
        let frame = elapsed_us.saturating_mul(1000).checked_div(self.frame_time_ns().into()).unwrap_or(0);
        let frames = u64::from(self.frames());
        let shown = if self.looped() { frame.checked_rem(frames).unwrap_or(0) } else { frame.min(frames - 1) };
        shown as u32
    }

    /// Number of event markers.
    pub fn event_count(&self) -> usize {
        self.head.event_count as usize
    }

    /// The name of the events with this id; `None` if they have none, or one that is not UTF-8.
    pub fn event_name(&self, id: u32) -> Option<&'a str> {
        let name = self.event_names().nth(id as usize)?;
        core::str::from_utf8(name).ok().filter(|name| !name.is_empty())
    }

    /// The id of the events with this name; `None` if the clip has none.
    ///
    /// ```
    /// # fn find(clip: pantin::Clip) -> Option<()> {
    /// let left = clip.event_id(pantin::LEFT_FOOT_DOWN)?;
    /// let steps = clip.events().filter(|event| event.id == left).count();
    /// # Some(())
    /// # }
    /// ```
    pub fn event_id(&self, name: &str) -> Option<u32> {
        let id = self.event_names().position(|other| other == name.as_bytes()).filter(|_| !name.is_empty())?;
        Some(id as u32)
    }

    /// The names of events as they stand, from id 0 on; those that are empty name nothing.
    pub fn event_names(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let mut reader = Reader::new(self.names);
        core::iter::from_fn(move || if reader.rest().is_empty() { None } else { Some(reader.name()) })
    }

    /// Bytes of the names of events in the file, their CRC included; 0 if there are none.
    pub fn event_names_len(&self) -> usize {
        if self.head.flags & HAS_EVENT_NAMES != 0 { self.names.len() + CRC_BYTES } else { 0 }
    }

    /// The event markers, in time order.
    pub fn events(&self) -> impl Iterator<Item = Event> + '_ {
        let mut position = u32::from(self.head.events);
        let mut frame = 0;
        (0..self.head.event_count).map(move |_| {
            let input = self.input();
            let mut reader = Reader::of_blocks(&input, position);
            let event = event(&mut reader, frame);
            (position, frame) = (reader.position, event.frame);
            event
        })
    }

    /// Number of [`crate::ChannelState`]s that a player of this clip needs.
    #[inline(never)]
    pub fn moving(&self) -> usize {
        #[cfg(feature = "keys")]
        if self.has_keys() {
            return self.head.states.into();
        }
        self.starts(u32::MAX, &mut [], &mut []).1
    }

    /// Whether it is a key clip, which has no segments but keys: FORMAT.md, version 2.
    #[cfg(feature = "keys")]
    pub fn has_keys(&self) -> bool {
        self.head.flags & KEYS != 0
    }

    /// Reads how the channels start, up to the last position at which a start is sure to be whole: where the segments begin, and how many
    /// channels move, of which as many as fit are in `states`; as many as `usize` holds if not all of them are there.
    #[inline(never)]
    pub(crate) fn starts(&self, dry_at: u32, states: &mut [ChannelState], pose: &mut [i32]) -> (Cursor, usize) {
        let input = self.input();
        let mut starts = ChannelStarts::new(&self.rig, self.head.length_exponent);
        let mut symbols = Symbols { at: Cursor::start(&input, self.symbols), input };
        let done = starts.read(&mut symbols, dry_at, states, pose);
        (symbols.at, if done { usize::from(starts.moving) } else { usize::MAX })
    }

    /// Bytes of the snapshots in the file, their CRCs included; 0 if there are none.
    pub fn index_len(&self) -> usize {
        if self.index.is_empty() { 0 } else { self.index.len() + CRC_BYTES }
    }

    pub(crate) fn symbols(&self) -> u32 {
        self.symbols
    }

    pub(crate) fn index(&self) -> Option<Input<'a>> {
        if self.index.is_empty() { None } else { Some(Input(self.index)) }
    }

    pub(crate) fn input(&self) -> Input<'a> {
        Input(self.motion)
    }
}

/// What the CRC of an index's first block goes on from: `motion_crc` is the motion's last.
pub fn index_seed(motion_crc: u16, len: u32) -> u16 {
    crc::update(motion_crc, &len.to_le_bytes())
}

/// The event that follows one at frame `before`.
pub(crate) fn event(reader: &mut Reader<'_>, before: u32) -> Event {
    let frame = before.wrapping_add(reader.varint());
    Event { frame, id: reader.varint() }
}
