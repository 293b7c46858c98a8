//! A clip: bytes checked once. Afterwards playing cannot fail.

use crate::blocks::{self, Input, Reader, STRIDE};
use crate::bytes::Bytes;
use crate::entropy::{Cursor, Symbols};
use crate::layout::*;
use crate::rig::{Joint, Rig};
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
    pub(crate) fn split(bytes: &'a [u8]) -> Result<Parts<'a>, OpenError> {
        let mut reader = Bytes(bytes);
        if reader.take(2)? != MAGIC {
            return Err(OpenError::BadMagic);
        }
        let version = reader.byte()?;
        if version != VERSION {
            return Err(OpenError::UnsupportedVersion(version));
        }
        let flags = reader.byte()?;
        if flags & !KNOWN_FLAGS != 0 {
            return Err(OpenError::Malformed);
        }
        let before = reader.0.len();
        let rig = if flags & HAS_RIG != 0 {
            let len = reader.varint()? as usize;
            Some(reader.take(len)?)
        } else {
            None
        };
        let rig_len = before - reader.0.len();
        let motion_len = reader.varint()? as usize;
        let seed = crc::of_prefix(flags, motion_len as u32);
        Ok(Parts { flags, rig, rig_len, seed, rest: reader.0, motion_len })
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

/// Whether a clip may code the joint's rotation as an exponential map in place of its three Euler angles.
pub fn has_choice(joint: &Joint<'_>) -> bool {
    joint.kinds.filter(|kind| kind.is_rotation()).count() == 3
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
        if flags & HAS_EXPONENTIALS != 0 {
            let choices = rig.joints().filter(has_choice).count();
            for _ in 0..choices.div_ceil(8) {
                reader.byte();
            }
        }
        let event_count = if flags & HAS_EVENTS != 0 { reader.varint() } else { 0 };
        let events = reader.position as u8;
        Ok(Head { flags, length_exponent, frames, frame_time_ns, event_count, events, exponentials })
    }

    /// Whether the clip codes this joint's three rotation channels as the x, y and z of an exponential map. `input` holds the
    /// motion's first block.
    pub(crate) fn is_exponential(&self, input: &Input<'_>, rig: &Rig<'_>, joint: usize) -> bool {
        if self.flags & HAS_EXPONENTIALS == 0 || !rig.joint(joint).is_some_and(|joint| has_choice(&joint)) {
            return false;
        }
        let choice = rig.joints().take(joint).filter(has_choice).count();
        let mut reader = Reader { input, position: u32::from(self.exponentials) };
        let mut byte = 0;
        for _ in 0..=choice / 8 {
            byte = reader.byte();
        }
        byte >> (choice % 8) & 1 != 0
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
            if reader.position as usize > motion.len() {
                return Err(short);
            }
            event(&mut reader, 0);
        }
        let symbols = reader.position;
        Ok(Clip { rig, motion, rig_len: parts.rig_len, head, symbols, index: &[] })
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

    /// Whether the clip codes this joint's three rotation channels as the x, y and z of an exponential map.
    pub fn is_exponential(&self, joint: usize) -> bool {
        self.head.is_exponential(&self.input(), &self.rig, joint)
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
