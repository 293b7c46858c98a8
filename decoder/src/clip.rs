//! A clip: bytes checked once. Afterwards playing cannot fail.

use crate::blocks::{self, Input, Reader, STRIDE};
use crate::bytes::Bytes;
use crate::entropy::{Cursor, Symbols};
use crate::form::{CodedKinds, Form};
use crate::joint::{JointRef, has_choice};
use crate::layout::*;
use crate::prefix::Prefix;
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
}

/// The fields in front of a motion's symbols.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Head {
    pub(crate) flags: u8,
    pub(crate) length_exponent: i8,
    pub(crate) frames: u32,
    pub(crate) frame_time_ns: u32,
    pub(crate) event_count: u32,
    /// Where the events begin: at 148 at most. Exponential-map bits stand before them.
    pub(crate) events: u8,
    exponentials: u8,
    exponential_bytes: u8,
}

/// The parts of a file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts<'a> {
    pub(crate) flags: u8,
    pub(crate) rig: Option<&'a [u8]>,
    pub(crate) rig_len: usize,
    /// CRC of the magic, version, flags and the motion's length: the first block's CRC goes on from it.
    pub(crate) seed: u16,
    /// All that follows, of which `motion_len` bytes are the motion.
    pub(crate) rest: &'a [u8],
    pub(crate) motion_len: usize,
}

impl<'a> Parts<'a> {
    /// Reads the fields in front of the motion.
    pub(crate) fn split(bytes: &'a [u8]) -> Result<Parts<'a>, OpenError> {
        let mut reader = Bytes(bytes);
        let (mut prefix, mut rig, mut rig_len) = (Prefix::default(), None, 0);
        loop {
            if let Some(motion_len) = prefix.push(reader.byte()?, None)? {
                let seed = prefix.seed(motion_len);
                return Ok(Parts { flags: prefix.flags, rig, rig_len, seed, rest: reader.0, motion_len: motion_len as usize });
            }
            if let Some(len) = prefix.rig_len() {
                rig = Some(reader.take(len as usize)?);
                prefix.skip_rig();
                // Behind magic, version and flags.
                rig_len = bytes.len() - reader.0.len() - 4;
            }
        }
    }
}

impl<'a> Parts<'a> {
    /// Checks what follows the motion, whose last CRC is `last_crc`: snapshots, or nothing.
    pub(crate) fn index(&self, rest: &'a [u8], last_crc: u16) -> Result<&'a [u8], OpenError> {
        let mut index = &[][..];
        let mut reader = Bytes(rest);
        if self.flags & HAS_INDEX != 0 {
            let len = reader.varint()?;
            index = blocks::check(reader.take(len as usize)?, index_seed(last_crc, len))?.0;
        }
        if reader.0.is_empty() { Ok(index) } else { Err(OpenError::Malformed) }
    }
}

impl Head {
    /// Reads the head of a motion that was made for `rig`.
    pub(crate) fn read(input: &Input<'_>, flags: u8, rig: &Rig<'_>, rig_id: Option<u32>) -> Result<Head, OpenError> {
        let mut reader = Reader { input, position: 0 };
        let rate = reader.byte();
        let frame_time_ns = match FRAME_TIMES_NS.get(usize::from(rate)) {
            Some(&0) => reader.u32(),
            Some(&time) => time,
            None => return Err(OpenError::Malformed),
        };
        let frames = reader.varint();
        let length_exponent = reader.byte() as i8;
        if frame_time_ns == 0 || frames == 0 || frames > MAX_FRAMES || !(-63..=31).contains(&length_exponent) {
            return Err(OpenError::Malformed);
        }
        if let Some(id) = rig_id
            && reader.u32() != id
        {
            return Err(OpenError::WrongRig);
        }
        let exponentials = reader.position as u8;
        // A joint with a choice has three channels: 43 bytes at most.
        let choices = if flags & HAS_EXPONENTIALS != 0 { rig.joints().filter(has_choice).count() } else { 0 };
        let exponential_bytes = choices.div_ceil(8) as u8;
        (0..exponential_bytes).for_each(|_| _ = reader.byte());
        let event_count = if flags & HAS_EVENTS != 0 { reader.varint() } else { 0 };
        let events = reader.position as u8;
        Ok(Head { flags, length_exponent, frames, frame_time_ns, event_count, events, exponentials, exponential_bytes })
    }

    /// What the values of the clip's poses mean. `input` holds the motion's first block.
    pub(crate) fn form(&self, input: &Input<'_>, rig_id: u32) -> Form {
        let mut reader = Reader { input, position: u32::from(self.exponentials) };
        Form::new(rig_id, self.length_exponent, (0..self.exponential_bytes).map(|_| reader.byte()))
    }
}

/// A mark in time that a program may react to: a footfall, a sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// The frame it stands at.
    pub frame: u32,
    /// What it means is the program's own affair.
    pub id: u32,
}

impl<'a> Clip<'a> {
    /// Checks a file that holds its rig.
    #[inline(never)]
    pub fn new_checked(bytes: &'a [u8]) -> Result<Clip<'a>, OpenError> {
        let parts = Parts::split(bytes)?;
        let rig = Rig::new_checked(parts.rig.ok_or(OpenError::WrongRig)?)?;
        Clip::assemble(&parts, rig, None)
    }

    /// Checks a file without a rig (`pantin convert --rig-out`), with the rig that it was made for.
    /// A file that holds its own is opened with that.
    pub fn with_rig(bytes: &'a [u8], rig_bytes: &'a [u8]) -> Result<Clip<'a>, OpenError> {
        let parts = Parts::split(bytes)?;
        if let Some(own) = parts.rig {
            return Clip::assemble(&parts, Rig::new_checked(own)?, None);
        }
        let rig = Rig::new_checked(rig_bytes)?;
        Clip::assemble(&parts, rig, Some(rig.id()))
    }

    #[inline(never)]
    fn assemble(parts: &Parts<'a>, rig: Rig<'a>, rig_id: Option<u32>) -> Result<Clip<'a>, OpenError> {
        let (motion, rest) = parts.rest.split_at_checked(parts.motion_len).ok_or(OpenError::Truncated)?;
        let (motion, last_crc) = blocks::check(motion, parts.seed)?;
        let index = parts.index(rest, last_crc)?;
        Ok(Clip { index, ..Clip::read(parts, rig, rig_id, motion, OpenError::Malformed)? })
    }

    /// Reads what stands before the symbols in the front of a motion, without the last CRC; `short` is what it means that its events go on past
    /// that.
    pub(crate) fn read(
        parts: &Parts<'a>,
        rig: Rig<'a>,
        rig_id: Option<u32>,
        motion: &'a [u8],
        short: OpenError,
    ) -> Result<Clip<'a>, OpenError> {
        let input = Input { bytes: motion, base: 0 };
        let head = Head::read(&input, parts.flags, &rig, rig_id)?;
        let mut reader = Reader { input: &input, position: u32::from(head.events) };
        for _ in 0..head.event_count {
            event(&mut reader, 0);
            if reader.position > input.end() {
                return Err(short);
            }
        }
        let symbols = reader.position;
        Ok(Clip { rig, motion, rig_len: parts.rig_len, head, symbols, index: &[] })
    }

    /// All but the bytes.
    pub(crate) fn without_bytes(&self) -> Clip<'static> {
        Clip {
            rig: self.rig.with_bytes(&[]),
            motion: &[],
            rig_len: self.rig_len,
            head: self.head,
            symbols: self.symbols,
            index: &[],
        }
    }

    /// The same clip in other bytes, of which those of the motion and an index are not there yet.
    pub(crate) fn with_bytes<'b>(&self, rig: &'b [u8]) -> Clip<'b> {
        let body = rig.split_last_chunk::<CRC_BYTES>().map_or(&[][..], |(body, _)| body);
        Clip {
            rig: self.rig.with_bytes(body),
            motion: &[],
            rig_len: self.rig_len,
            head: self.head,
            symbols: self.symbols,
            index: &[],
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
    #[inline(never)]
    pub fn form(&self) -> Form {
        self.head.form(&self.input(), self.rig.id())
    }

    /// Whether the clip codes this joint's three rotation channels as the x, y and z of an exponential map.
    pub fn is_exponential(&self, joint: usize) -> bool {
        self.form().is_exponential(&self.rig, joint)
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

    /// The event markers, in time order.
    pub fn events(&self) -> impl Iterator<Item = Event> + '_ {
        let mut position = u32::from(self.head.events);
        let mut frame = 0;
        (0..self.head.event_count).map(move |_| {
            let input = self.input();
            let mut reader = Reader { input: &input, position };
            let event = event(&mut reader, frame);
            (position, frame) = (reader.position, event.frame);
            event
        })
    }

    /// Number of [`crate::ChannelState`]s that a player of this clip needs.
    #[inline(never)]
    pub fn moving(&self) -> usize {
        let input = self.input();
        ChannelStarts::new(&self.rig, self.head.length_exponent)
            .count(&mut Symbols { at: Cursor::start(&input, self.symbols), input })
    }

    /// Bytes of the snapshots in the file, their CRCs included; 0 if there are none.
    pub fn index_len(&self) -> usize {
        if self.index.is_empty() { 0 } else { self.index.len() + CRC_BYTES }
    }

    pub(crate) fn symbols(&self) -> u32 {
        self.symbols
    }

    pub(crate) fn index(&self) -> Option<Input<'a>> {
        if self.index.is_empty() { None } else { Some(Input { bytes: self.index, base: 0 }) }
    }

    pub(crate) fn input(&self) -> Input<'a> {
        Input { bytes: self.motion, base: 0 }
    }
}

/// What the CRC of an index's first block goes on from: `motion_crc` is the motion's last.
pub fn index_seed(motion_crc: u16, len: u32) -> u16 {
    crc::update(motion_crc, &len.to_le_bytes())
}

/// The event that follows one at frame `before`.
pub(crate) fn event(reader: &mut Reader<'_, '_>, before: u32) -> Event {
    let frame = before.wrapping_add(reader.varint());
    Event { frame, id: reader.varint() }
}
