//! Messages put into packets, as many as fit.

use super::refresh::{ScheduledMessage, fields, pass};
use super::writer::Writer;
use pantin_link::Head;
use pantin_link::MAX_PAYLOAD;
use pantin_link::tables::PLACE;
use pantin_link::wire::{AHEAD_BITS, Coder, END, FRAME, FRAME_BITS};

/// A packet of motion that knows all but how far ahead it will be.
#[derive(Clone, Debug)]
pub(crate) struct MotionPacket {
    /// The line's frames of its first and last message.
    pub base: u32,
    pub last: u32,
    body: Writer,
    /// Bits of its refreshes, beside what their segments would have taken.
    pub refresh_bits: f64,
    /// Messages, and refreshes among them.
    pub counts: [u32; 2],
}

/// The bits that a packet may have: the coder's state takes three bytes, and each field less than a byte by rounding.
const ROOM: f64 = 8.0 * (MAX_PAYLOAD as f64 - 3.0) - 12.0;

impl MotionPacket {
    fn new(base: u32) -> MotionPacket {
        MotionPacket { base, last: base, body: Writer::default(), refresh_bits: 0.0, counts: [0; 2] }
    }

    /// One that says no more than that there is nothing up to this frame.
    pub fn empty(base: u32) -> MotionPacket {
        MotionPacket::new(base)
    }

    /// The payload.
    pub fn payload(&self, head: &Head, ahead: u8) -> Vec<u8> {
        let mut writer = Writer::default();
        writer.bits(FRAME_BITS, self.base & 0xffff);
        writer.bits(AHEAD_BITS, u32::from(ahead));
        writer.append(&self.body);
        writer.symbol(&PLACE, END);
        writer.finish(head.check(self.base))
    }
}

/// Packs a round's messages, whose first frame is the line's `begin`.
pub(crate) fn pack(told: &[ScheduledMessage], begin: u32) -> Vec<MotionPacket> {
    let mut batches: Vec<MotionPacket> = vec![];
    let mut next_channel = 0;
    for ScheduledMessage { frame, channel, message } in told {
        let (frame, body) = (begin + frame, fields(message));
        let mut place = Writer::default();
        let open = batches.last().filter(|batch| frame - batch.last <= 8);
        let on = open.map_or(0, |batch| frame - batch.last);
        (0..on).for_each(|_| {
            place.symbol(&PLACE, FRAME);
        });
        let from = if on > 0 { 0 } else { next_channel };
        if open.is_some() {
            pass(&mut place, u32::from(channel - from));
        }
        let fits = open.is_some_and(|batch| {
            batch.body.cost_bits + place.cost_bits + body.cost_bits + f64::from(FRAME_BITS + AHEAD_BITS) < ROOM
        });
        if !fits {
            batches.push(MotionPacket::new(frame));
            place = Writer::default();
            pass(&mut place, u32::from(*channel));
        }
        let Some(batch) = batches.last_mut() else { continue };
        batch.last = frame;
        batch.body.append(&place);
        batch.body.append(&body);
        batch.counts[0] += 1;
        if message.refresh.is_some() {
            let plain = pantin_link::Message { refresh: None, ..*message };
            batch.refresh_bits += body.cost_bits - fields(&plain).cost_bits;
            batch.counts[1] += 1;
        }
        next_channel = channel + 1;
    }
    batches
}
