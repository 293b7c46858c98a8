//! EVENT packets: an event of the clip, sent ahead of its frame.
//!
//! ```text
//! check of the line frame u16, line frame u32, id u32, name
//! ```
//! Numbers are little-endian.

use crate::head::Head;
use crate::link::before;
use crate::packet::{Packet, kind};
use heapless::Vec;

/// Most bytes of a name that a receiver keeps.
pub const EVENT_NAME_BYTES: usize = 32;
/// Most bytes of an EVENT payload.
pub const MAX_EVENT: usize = HEAD_BYTES + EVENT_NAME_BYTES;
/// Events that can wait for their frames.
const QUEUE_EVENTS: usize = 16;
const HEAD_BYTES: usize = 10;

/// An event and the line frame at which it is heard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineEvent {
    /// The line frame.
    pub frame: u32,
    /// Its id in the sender's clip.
    pub id: u32,
    name: Vec<u8, EVENT_NAME_BYTES>,
}

impl LineEvent {
    /// Describes an event; of the name it keeps as many whole characters as fit [`EVENT_NAME_BYTES`].
    pub fn new(frame: u32, id: u32, name: &str) -> LineEvent {
        let end = (0..=EVENT_NAME_BYTES.min(name.len())).rev().find(|&end| name.is_char_boundary(end)).unwrap_or(0);
        let name = Vec::from_slice(name.as_bytes().get(..end).unwrap_or_default()).unwrap_or_default();
        LineEvent { frame, id, name }
    }

    /// Its name, if it has one.
    pub fn name(&self) -> Option<&str> {
        core::str::from_utf8(&self.name).ok().filter(|name| !name.is_empty())
    }

    /// The payload of its packet. It is one of the clip that `head` describes.
    pub fn payload(&self, head: &Head) -> Vec<u8, MAX_EVENT> {
        let mut out = Vec::new();
        // There is room for all of it.
        let _ = out.extend_from_slice(&head.check(self.frame).to_le_bytes());
        let _ = out.extend_from_slice(&self.frame.to_le_bytes());
        let _ = out.extend_from_slice(&self.id.to_le_bytes());
        let _ = out.extend_from_slice(&self.name);
        out
    }

    /// Reads an EVENT packet of the clip that `head` describes. Returns `None` for other packets.
    pub fn read(packet: &Packet<'_>, head: &Head) -> Option<LineEvent> {
        let (check, rest) = packet.payload.split_first_chunk()?;
        let (frame, rest) = rest.split_first_chunk()?;
        let (id, name) = rest.split_first_chunk()?;
        let frame = u32::from_le_bytes(*frame);
        let own = packet.kind == kind::EVENT && u16::from_le_bytes(*check) == head.check(frame);
        let name = Vec::from_slice(name).ok()?;
        own.then_some(LineEvent { frame, id: u32::from_le_bytes(*id), name })
    }
}

/// Events that wait for their frames.
#[derive(Clone, Debug, Default)]
pub struct EventQueue {
    waiting: Vec<LineEvent, QUEUE_EVENTS>,
}

impl EventQueue {
    /// Takes an event; drops it if it is there already, if its frame has been shown (`now` is the last one), or if the queue is full.
    pub fn push(&mut self, event: LineEvent, now: u32) {
        if before(now, event.frame) && !self.waiting.contains(&event) {
            let _ = self.waiting.push(event);
        }
    }

    /// Returns an event whose frame has come.
    pub fn take(&mut self, now: u32) -> Option<LineEvent> {
        let due = self.waiting.iter().position(|event| !before(now, event.frame))?;
        Some(self.waiting.remove(due))
    }

    /// Drops all events: the sender plays another clip.
    pub fn clear(&mut self) {
        self.waiting.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packet_comes_back_and_is_of_its_clip_alone() {
        let (head, other) = (Head { session: 7, ..Head::default() }, Head { session: 8, ..Head::default() });
        let event = LineEvent::new(70_000, 3, "left foot down, and a name that is too löng");
        assert_eq!(event.name(), Some("left foot down, and a name that "));
        let payload = event.payload(&head);
        let packet = |kind| Packet { kind, sequence: 0, payload: &payload };
        assert_eq!(LineEvent::read(&packet(kind::EVENT), &head), Some(event));
        assert_eq!(LineEvent::read(&packet(kind::EVENT), &other), None);
        assert_eq!(LineEvent::read(&packet(kind::MOTION), &head), None);
        for len in 0..payload.len() {
            let short = LineEvent::read(&Packet { kind: kind::EVENT, sequence: 0, payload: &payload[..len] }, &head);
            assert_eq!(short.is_some(), len >= HEAD_BYTES);
        }
    }

    #[test]
    fn an_event_is_heard_once_and_at_its_frame() {
        let mut queue = EventQueue::default();
        for event in
            [LineEvent::new(12, 1, ""), LineEvent::new(10, 0, "a"), LineEvent::new(10, 0, "a"), LineEvent::new(9, 0, "late")]
        {
            queue.push(event, 9);
        }
        assert_eq!(queue.take(9), None);
        assert_eq!(queue.take(10).unwrap().name(), Some("a"));
        assert_eq!(queue.take(11), None);
        queue.push(LineEvent::new(10, 0, "a"), 11);
        assert_eq!(queue.take(13).unwrap().frame, 12);
        assert_eq!(queue.take(13), None);
    }
}
