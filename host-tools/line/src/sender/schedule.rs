//! When each packet leaves: no earlier than its look-ahead, no later than its frame needs, and never more than the line carries.

use super::announce::{write_head, write_starts};
use super::pack::{MotionPacket, pack};
use super::refresh::round;
use super::source::Source;
use pantin_link::packet::{self, TagKey, kind};
use pantin_link::{Head, LineEvent};
use pantin_link::{MAX_PAYLOAD, QUEUE_PACKETS};
use std::collections::VecDeque;

/// What the sender may do with the line.
#[derive(Clone, Copy, Debug)]
pub struct LineSettings {
    /// Bytes that it carries a second.
    pub rate: f64,
    /// Frames that messages are sent ahead of their time at most: so long nothing is shown at first, and as much has to wait at the receiver.
    pub ahead: u32,
    /// Part of the line that refreshes may take.
    pub share: f64,
    /// Frames after which a channel is refreshed again at the latest.
    pub cycle: u32,
    /// Packets have parity.
    pub parity: bool,
    /// The key of the packets' tags, if they have tags in place of CRCs.
    pub key: Option<TagKey>,
}

/// Part of the line for heads and starts, once they have been told at first.
const ANNOUNCED: f64 = 0.05;
/// Frames that a packet has to be there before its first message is played.
const MARGIN: f64 = 2.0;
/// Packets that wait at the receiver at most: jitter of its clock may take the other places.
const SENT: usize = QUEUE_PACKETS - 4;
/// How often HEAD and STARTS are sent before a clip starts.
const AT_FIRST: usize = 2;

/// What went over the line, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ByteCounts {
    /// All.
    pub line: f64,
    /// Zeros, stuffing, kind, sequence, CRC or tag.
    pub framing: f64,
    /// Parity.
    pub parity: f64,
    /// Heads and starts.
    pub announced: f64,
    /// What refreshes took beside the segments that they came with.
    pub refresh: f64,
    /// The rest: segments, and the frames of packets.
    pub motion: f64,
    /// Packets.
    pub packets: u32,
    /// Messages, and refreshes among them.
    pub messages: [u32; 2],
}

impl core::ops::Add for ByteCounts {
    type Output = ByteCounts;

    fn add(self, other: ByteCounts) -> ByteCounts {
        ByteCounts {
            line: self.line + other.line,
            framing: self.framing + other.framing,
            parity: self.parity + other.parity,
            announced: self.announced + other.announced,
            refresh: self.refresh + other.refresh,
            motion: self.motion + other.motion,
            packets: self.packets + other.packets,
            messages: [0, 1].map(|i| self.messages[i] + other.messages[i]),
        }
    }
}

/// A packet on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedPacket {
    /// When it leaves: seconds after the first frame of the session's first clip is shown; negative before.
    pub at: f64,
    /// What goes over the line.
    pub bytes: Vec<u8>,
}

/// A clip on its way.
#[derive(Clone, Debug)]
pub struct Schedule<'s> {
    source: &'s Source,
    head: Head,
    line: LineSettings,
    /// Seconds of a frame.
    frame: f64,
    batches: VecDeque<MotionPacket>,
    /// Events, each with the line frame of the motion that it goes before.
    events: VecDeque<(u32, LineEvent)>,
    /// The last frames of packets that may still wait at the receiver.
    waiting: VecDeque<u32>,
    rounds: u32,
    /// Rounds of the clip that are left, none for ever.
    left: Option<u32>,
    /// When the line is free again.
    free: f64,
    /// Payloads of the clip's starts, in turn with the head.
    starts: Vec<Vec<u8>>,
    /// Bytes that heads and starts may still take, and which of them is next.
    credit: f64,
    turn: usize,
    sequence: u8,
    bytes: ByteCounts,
}

impl<'s> Schedule<'s> {
    /// A clip that begins at the line's frame `head.begin`, which is shown at `begin.0` seconds; the line is free from `begin.1` on.
    pub(crate) fn new(source: &'s Source, head: Head, line: LineSettings, rounds: Option<u32>, sequence: u8, free: f64) -> Self {
        let mut schedule = Schedule {
            source,
            head,
            line,
            frame: f64::from(head.frame_time_ns) / 1e9,
            batches: VecDeque::new(),
            events: VecDeque::new(),
            waiting: VecDeque::new(),
            rounds: 0,
            left: rounds,
            free,
            starts: vec![],
            credit: 0.0,
            turn: 0,
            sequence,
            bytes: ByteCounts::default(),
        };
        let mut first = 0;
        while first < source.starts.len() {
            let (payload, count) = write_starts(first as u16, &source.starts[first..], head.identity(), MAX_PAYLOAD);
            schedule.starts.push(payload);
            first += count.max(1);
        }
        schedule
    }

    /// Packets of a round more, if there is one.
    fn refill(&mut self) {
        if self.left == Some(0) {
            return;
        }
        let begin = self.head.begin + self.rounds * self.head.frames;
        self.batches.extend(pack(&round(self.source, self.line.cycle), begin));
        // Twice: packets are lost.
        let again = (self.line.ahead / 2).max(1);
        let mut events: Vec<(u32, LineEvent)> = self.events.drain(..).collect();
        for (frame, id, name) in &self.source.events {
            let event = LineEvent::new(begin + frame, *id, name);
            events.extend([(event.frame, event.clone()), (event.frame + again, event)]);
        }
        events.sort_by_key(|(before, _)| *before);
        self.events = events.into();
        self.rounds += 1;
        self.left = self.left.map(|left| left - 1);
        if self.left == Some(0) {
            // The last frames are sent only if something follows them.
            self.batches.push_back(MotionPacket::empty(begin + self.head.frames));
        }
    }

    /// The line's frame at a time.
    fn frame_at(&self, time: f64) -> f64 {
        f64::from(self.head.begin) + time / self.frame
    }

    /// When one of the line's frames is shown.
    fn time_of(&self, frame: u32) -> f64 {
        (f64::from(frame) - f64::from(self.head.begin)) * self.frame
    }

    /// Seconds of a frame.
    pub(crate) fn frame_seconds(&self) -> f64 {
        self.frame
    }

    /// Nothing leaves before this time; by how much the line is behind it.
    pub(crate) fn idle_until(&mut self, now: f64) -> f64 {
        self.free = self.free.max(now);
        self.free - now
    }

    /// Takes packets that were not planned.
    pub(crate) fn add(&mut self, batches: Vec<MotionPacket>) {
        self.batches.extend(batches);
    }

    /// What the line has carried so far.
    pub fn bytes(&self) -> ByteCounts {
        self.bytes
    }

    /// The number that the next packet has.
    pub(crate) fn sequence(&self) -> u8 {
        self.sequence
    }

    fn leave(&mut self, at: f64, kind: u8, payload: &[u8]) -> TimedPacket {
        let mut bytes = vec![0; packet::tagged_line_len(payload.len())];
        // Events do not count: receivers that do not know them would miss a packet.
        let sequence = self.sequence.wrapping_sub(u8::from(kind == kind::EVENT));
        let len = match (&self.line.key, self.line.parity) {
            (Some(key), parity) => packet::encode_with_tag(kind, sequence, payload, key, parity, &mut bytes),
            (None, true) => packet::encode_with_parity(kind, sequence, payload, &mut bytes),
            (None, false) => packet::encode(kind, sequence, payload, &mut bytes),
        };
        let len = len.unwrap_or(0);
        let parity = if self.line.parity { packet::PARITY as f64 } else { 0.0 };
        bytes.truncate(len);
        if at == self.free && self.bytes.packets > 0 {
            // The zero before it has just been sent.
            bytes.remove(0);
        }
        self.sequence = self.sequence.wrapping_add(u8::from(kind != kind::EVENT));
        self.free = at + bytes.len() as f64 / self.line.rate;
        self.bytes.line += bytes.len() as f64;
        self.bytes.framing += (bytes.len() - payload.len()) as f64 - parity;
        self.bytes.parity += parity;
        self.bytes.packets += 1;
        TimedPacket { at, bytes }
    }

    fn leave_event(&mut self, at: f64) -> Option<TimedPacket> {
        let (_, event) = self.events.pop_front()?;
        let payload = event.payload(&self.head);
        let timed = self.leave(at, kind::EVENT, &payload);
        self.bytes.announced += payload.len() as f64;
        Some(timed)
    }

    fn announce(&mut self, at: f64) -> TimedPacket {
        let turn = self.turn % (self.starts.len() + 1);
        self.turn += 1;
        let (kind, payload) = match turn.checked_sub(1).and_then(|part| self.starts.get(part)) {
            Some(part) => (kind::STARTS, part.clone()),
            None => (kind::HEAD, write_head(&self.head, self.frame_at(at).floor().max(0.0) as u32)),
        };
        let timed = self.leave(at, kind, &payload);
        self.credit -= timed.bytes.len() as f64;
        self.bytes.announced += payload.len() as f64;
        timed
    }
}

impl Iterator for Schedule<'_> {
    type Item = TimedPacket;

    fn next(&mut self) -> Option<TimedPacket> {
        if self.turn < AT_FIRST * (self.starts.len() + 1) {
            self.credit = 0.0;
            return Some(self.announce(self.free));
        }
        if self.batches.is_empty() {
            self.refill();
        }
        let Some(base) = self.batches.front().map(|batch| batch.base) else {
            // Second copies of the last events.
            return self.leave_event(self.free);
        };
        let due = self.time_of(base) - f64::from(self.line.ahead) * self.frame;
        let mut at = self.free.max(due);
        if let Some(&last) = self.waiting.len().checked_sub(SENT).and_then(|first| self.waiting.get(first)) {
            at = at.max(self.time_of(last + 1));
        }
        if self.credit > 0.0 {
            return Some(self.announce(self.free));
        }
        if self.events.front().is_some_and(|(before, _)| *before <= base) {
            return self.leave_event(at);
        }
        let batch = self.batches.pop_front()?;
        self.waiting.push_back(batch.last);
        if self.waiting.len() > SENT {
            self.waiting.pop_front();
        }
        let arrived = at + packet::line_len(MAX_PAYLOAD) as f64 / self.line.rate;
        let ahead = (f64::from(base) - self.frame_at(arrived)).floor();
        let payload = batch.payload(&self.head, ahead.clamp(0.0, 255.0) as u8);
        let before = self.free;
        let timed = self.leave(at, kind::MOTION, &payload);
        self.credit += (self.free - before) * self.line.rate * ANNOUNCED;
        self.bytes.refresh += batch.refresh_bits / 8.0;
        self.bytes.motion += payload.len() as f64 - batch.refresh_bits / 8.0;
        self.bytes.messages[0] += batch.counts[0];
        self.bytes.messages[1] += batch.counts[1];
        Some(timed)
    }
}

/// How a clip fits a line with this cycle: whether all is there in time, and the part of the line that refreshes take.
pub(crate) fn fits(source: &Source, line: LineSettings) -> bool {
    let head = Head { begin: 1 << 8, ..source.head };
    let start = -f64::from(line.ahead) * f64::from(head.frame_time_ns) / 1e9;
    // Twice around: the seam is the hardest place.
    let mut schedule = Schedule::new(source, head, line, Some(2), 0, start);
    let mut in_time = true;
    loop {
        let base = schedule.batches.front().map(|batch| batch.base);
        let batches = schedule.batches.len();
        if schedule.next().is_none() {
            break;
        }
        let sent = schedule.batches.len() < batches;
        if let Some(base) = base.filter(|_| sent) {
            in_time &= f64::from(base) - schedule.frame_at(schedule.free) >= MARGIN;
        }
    }
    let seconds = schedule.free - start;
    in_time && schedule.bytes.refresh <= line.share * line.rate * seconds
}
