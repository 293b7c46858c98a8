//! Messages of a MOTION packet: a segment that starts at a frame, with or without a refresh of the state.

use crate::symbols::{Coder, SymbolReader};
use crate::tables;
use pantin::codec::layout::{DIRECT, GROUPS, LENGTH_CLASSES, MAX_STEP, START_MODE, group, segment_type};
use pantin::codec::{segment, segment_frames, step_size};

/// A segment, and optionally the state from which it starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Message {
    /// Type and length of the segment as in FORMAT.md 9; the length determines the steps of `w` and `k`. The line's `CARRY` has no
    /// slope: where one carries on, the type is `K` with the length that determined its steps.
    pub mode: u8,
    /// Frames until this channel's next message, 1 to 127: the mode's length, unless the sender splits the segment.
    pub run: u8,
    /// New acceleration in steps, for the types `W` and `WK`.
    pub w: i32,
    /// New slope in steps, for the types `K` and `WK`.
    pub k: i32,
    /// The state at this frame, if the message has a refresh.
    pub refresh: Option<Refresh>,
}

/// A state in fractions of the channel step S, each at least 1 raw unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Refresh {
    /// Position in S / 16.
    pub p: i32,
    /// Velocity in S / 256.
    pub v: i32,
    /// Acceleration in S / 4096 for the types `K` and `CARRY`, which keep it; otherwise 0.
    pub w: i32,
}

/// Shifts from a channel step to the units of a [`Refresh`]. After 16 frames, the rounding of v and w has moved p by less than the rounding of p.
const SHIFTS: [u32; 3] = [4, 8, 12];

/// Returns the units of a [`Refresh`] in raw units, for p, v and w.
pub fn units(step: u8) -> [i32; 3] {
    // The largest is 805,306,368.
    SHIFTS.map(|shift| (step_size(step.min(MAX_STEP)) >> shift).max(1) as i32)
}

/// Bits of a far number's count of bits.
const FAR_BITS: u32 = 5;
/// Bits of a run that differs from the mode's length.
const RUN_BITS: u32 = 7;
/// Flags of the first symbol.
const REFRESH: u32 = 1;
const CUT: u32 = 2;

impl Message {
    /// Returns whether the type has a new w, and whether it has a new k.
    pub fn is_new(&self) -> [bool; 2] {
        let kind = self.mode >> 4;
        [kind & 1 == 0, kind == segment_type::K || kind == segment_type::WK]
    }

    /// Writes this message to an encoder, or reads one from a decoder.
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

    /// Returns the state [p, v, w, k] from which a channel with this step index continues.
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

/// Codes a number in steps as in FORMAT.md 9, without a context.
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

/// The smallest magnitude above the groups, plus `more`.
const fn far(more: u32) -> u32 {
    group(GROUPS + 1) + more
}

/// Bits of a MOTION's first frame.
pub const FRAME_BITS: u32 = 16;
/// Bits of how many frames ahead of the sender's clock that was.
pub const AHEAD_BITS: u32 = 8;

/// Place symbol: 30 channels are skipped, and another place follows.
pub const PASS: u32 = 30;
/// Place symbol: the next frame follows.
pub const FRAME: u32 = 31;
/// Place symbol: the packet ends.
pub const END: u32 = 32;

/// Iterates over the messages of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Messages<'a> {
    reader: SymbolReader<'a>,
    /// The low 16 bits of the first frame.
    base: u16,
    ahead: u8,
    frame: u16,
    channel: u16,
    ended: bool,
}

impl<'a> Messages<'a> {
    /// Reads the payload of a MOTION packet.
    pub fn new(payload: &'a [u8]) -> Self {
        let mut reader = SymbolReader::new(payload);
        let base = reader.bits(FRAME_BITS, 0) as u16;
        let ahead = reader.bits(AHEAD_BITS, 0) as u8;
        Messages { reader, base, ahead, frame: base, channel: 0, ended: false }
    }

    /// The first frame, modulo 2^16. Everything about earlier frames was sent in earlier packets.
    pub fn base(&self) -> u16 {
        self.base
    }

    /// How many frames the first frame was ahead of the sender's clock when the packet had been sent.
    pub fn ahead(&self) -> u8 {
        self.ahead
    }

    /// The frame that the iterator has reached, modulo 2^16.
    pub fn frame(&self) -> u16 {
        self.frame
    }

    /// Returns whether the whole payload was read and ends with `check`. Only then are its messages valid.
    pub fn whole(&self, check: u16) -> bool {
        self.ended && self.reader.ends_with(check)
    }
}

impl Iterator for Messages<'_> {
    /// The frame modulo 2^16, the channel of the pose, and the message.
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
