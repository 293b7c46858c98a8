//! What a packet of kind MOTION says of one channel: a segment that begins at a frame, with or without a refresh of the state there.

use crate::symbols::{Coder, Reader};
use crate::tables;
use pantin::codec::layout::{DIRECT, FAR_BITS, GROUPS, LENGTH_CLASSES, MAX_STEP, START_MODE, group, segment_type};
use pantin::codec::{segment, segment_frames, step_size};

/// A segment from a frame on, and perhaps the state that it starts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Message {
    /// Type and length of the file's segment, as FORMAT.md 9 has them: the steps of `w` and `k` are that length's.
    pub mode: u8,
    /// Frames until this channel is told of again, 1 to 127; the mode's length unless the sender cuts there.
    pub run: u8,
    /// New acceleration in steps, with types `W` and `WK`.
    pub w: i32,
    /// New slope in steps, with types `K` and `WK`.
    pub k: i32,
    /// The state at this frame, with a refresh.
    pub refresh: Option<Refresh>,
}

/// A state in units of the channel step S, each at least 1 raw unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Refresh {
    /// Position in S / 16.
    pub p: i32,
    /// Velocity in S / 256.
    pub v: i32,
    /// Acceleration in S / 4096, with types `K` and `NONE`, which carry it on; else 0.
    pub w: i32,
}

/// Shifts that bring a channel step to the units of a [`Refresh`]: 16 frames at rounding's worst move p by less than its own rounding.
const SHIFTS: [u32; 3] = [4, 8, 12];

/// The units of a [`Refresh`] in raw units: of p, v, w.
pub fn units(step: u8) -> [i32; 3] {
    // At most 805306368.
    SHIFTS.map(|shift| (step_size(step.min(MAX_STEP)) >> shift).max(1) as i32)
}

/// Bits of a run that is not the mode's length.
const RUN_BITS: u32 = 7;
/// Flags of the first symbol.
const REFRESH: u32 = 1;
const CUT: u32 = 2;

impl Message {
    /// Whether the type has a new w, and whether it has a new k.
    pub fn is_new(&self) -> [bool; 2] {
        let kind = self.mode >> 4;
        [kind & 1 == 0, kind == segment_type::K || kind == segment_type::WK]
    }

    /// Reads or writes one.
    pub fn code<C: Coder>(&self, coder: &mut C) -> Message {
        let cut = self.run != segment_frames(self.mode);
        let flags = (u32::from(self.refresh.is_some()) * REFRESH) | (u32::from(cut) * CUT);
        let flags = coder.symbol(&tables::FLAGS, flags);
        let mode = coder.symbol(&tables::MODE, u32::from(self.mode)) as u8;
        let mut message = Message { mode: mode.min(START_MODE - 1), ..Message::default() };
        message.run = segment_frames(message.mode);
        if flags & CUT != 0 {
            message.run = coder.bits(RUN_BITS, u32::from(self.run)).max(1) as u8;
        }
        let [new_w, new_k] = message.is_new();
        let class = LENGTH_CLASSES[usize::from(message.mode & 15)];
        if new_w {
            message.w = number(coder, tables::acceleration(class), self.w);
        }
        if new_k {
            message.k = number(coder, &tables::SLOPE, self.k);
        }
        if flags & REFRESH != 0 {
            let own = self.refresh.unwrap_or_default();
            let p = coder.magnitude(&tables::P, own.p);
            let v = coder.magnitude(&tables::V, own.v);
            let w = if new_w { 0 } else { coder.magnitude(&tables::W, own.w) };
            message.refresh = Some(Refresh { p, v, w });
        }
        message
    }

    /// The state [p, v, w, k] of a channel with this step from here on.
    pub fn apply(&self, state: [i32; 4], step: u8) -> [i32; 4] {
        let [mut p, mut v, mut w, _] = state;
        if let Some(refresh) = self.refresh {
            let unit = units(step);
            p = refresh.p.wrapping_mul(unit[0]);
            v = refresh.v.wrapping_mul(unit[1]);
            w = refresh.w.wrapping_mul(unit[2]);
        }
        let [new_w, new_k] = self.is_new();
        let unit = |which: u8| segment::step(which, step.min(MAX_STEP)) as i32;
        let which = self.mode & 15;
        if new_w {
            w = self.w.wrapping_mul(unit(which));
        }
        let k = if new_k { self.k.wrapping_mul(unit(which | segment::SLOPE)) } else { 0 };
        [p, v, w, k]
    }
}

/// A number in steps, as FORMAT.md 9 has it, without a context.
fn number<C: Coder>(coder: &mut C, table: &[u16], value: i32) -> i32 {
    let size = value.unsigned_abs();
    let last = GROUPS + 1;
    let bits = (1..=GROUPS).rev().find(|&bits| size >= group(bits));
    let index = match bits {
        _ if size <= DIRECT => size,
        _ if size >= far(0) => DIRECT + last,
        bits => DIRECT + bits.unwrap_or(0),
    };
    let symbol = coder.symbol(table, (2 * index).saturating_sub(u32::from(value < 0)));
    let index = (symbol + 1) >> 1;
    let read = match index.saturating_sub(DIRECT) {
        0 => index,
        bits @ 1..=GROUPS => group(bits) + coder.bits(bits, size.wrapping_sub(group(bits))),
        _ => {
            let over = size.wrapping_sub(far(0)).wrapping_add(1).max(1);
            let bits = coder.bits(FAR_BITS, 31 - over.leading_zeros());
            far(0).wrapping_add((1 << bits) - 1).wrapping_add(coder.bits(bits, over & !(1 << bits)))
        }
    };
    if symbol & 1 == 0 { read as i32 } else { (read as i32).wrapping_neg() }
}

/// The first magnitude behind the groups, and more.
const fn far(more: u32) -> u32 {
    group(GROUPS + 1) + more
}

/// Bits of a MOTION's first frame.
pub const FRAME_BITS: u32 = 16;
/// Bits of how many frames ahead of the sender's clock that was.
pub const AHEAD_BITS: u32 = 8;

/// Symbols of a place: so many channels passed over; then, instead of a channel,
pub const PASS: u32 = 30;
/// a frame on, and
pub const FRAME: u32 = 31;
/// the end.
pub const END: u32 = 32;

/// The messages of a packet, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Messages<'a> {
    reader: Reader<'a>,
    /// The first frame's low bits.
    base: u16,
    ahead: u8,
    frame: u16,
    channel: u16,
    ended: bool,
}

impl<'a> Messages<'a> {
    /// Of the payload of a packet of kind MOTION.
    pub fn new(payload: &'a [u8]) -> Self {
        let mut reader = Reader::new(payload);
        let base = reader.bits(FRAME_BITS, 0) as u16;
        let ahead = reader.bits(AHEAD_BITS, 0) as u8;
        Messages { reader, base, ahead, frame: base, channel: 0, ended: false }
    }

    /// The frame of the first message, modulo 2^16: all that is told of frames before it has been sent.
    pub fn base(&self) -> u16 {
        self.base
    }

    /// By how many frames that was ahead of the sender's clock when the packet had left.
    pub fn ahead(&self) -> u8 {
        self.ahead
    }

    /// The frame that has been come to.
    pub fn frame(&self) -> u16 {
        self.frame
    }

    /// Whether all was read and the check is this: only then has any of it been meant.
    pub fn whole(&self, check: u16) -> bool {
        self.ended && self.reader.ends_with(check)
    }
}

impl Iterator for Messages<'_> {
    /// Frame modulo 2^16, channel of the pose, message.
    type Item = (u16, u16, Message);

    fn next(&mut self) -> Option<Self::Item> {
        while !self.ended && !self.reader.past() {
            match self.reader.symbol(&tables::PLACE, 0) {
                PASS => self.channel = self.channel.saturating_add(PASS as u16),
                FRAME => (self.frame, self.channel) = (self.frame.wrapping_add(1), 0),
                END.. => self.ended = true,
                passed => {
                    let channel = self.channel.saturating_add(passed as u16);
                    self.channel = channel.saturating_add(1);
                    return Some((self.frame, channel, Message::default().code(&mut self.reader)));
                }
            }
        }
        None
    }
}
