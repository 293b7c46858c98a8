//! The events that a stretch of play passes, in order, in a bounded queue.

use crate::track::Passage;
use heapless::Deque;
use pantin::Clip;

/// Events that a queue holds before they are taken.
pub const EVENTS: usize = 16;

/// An event marker that was passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fired {
    /// The event's id in its clip: [`Clip::event_name`].
    pub id: u32,
    /// The frame of the clip at which it stands.
    pub frame: u32,
}

/// More events were passed than the queue holds; as many as this were lost since the queue was last empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EventsLost(pub u32);

impl core::fmt::Display for EventsLost {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} events were lost: take them more often", self.0)
    }
}

impl core::error::Error for EventsLost {}

/// Events in the order in which play passed them.
#[derive(Clone, Debug, Default)]
pub struct EventQueue {
    fired: Deque<Fired, EVENTS>,
    lost: u32,
}

impl EventQueue {
    /// No events.
    pub const fn new() -> EventQueue {
        EventQueue { fired: Deque::new(), lost: 0 }
    }

    /// Takes the oldest event.
    pub fn take(&mut self) -> Option<Fired> {
        self.fired.pop_front()
    }

    /// The events that wait, oldest first.
    pub fn iter(&self) -> impl Iterator<Item = Fired> + '_ {
        self.fired.iter().copied()
    }

    /// Drops the events that wait and the count of lost ones.
    pub fn clear(&mut self) {
        self.fired.clear();
        self.lost = 0;
    }

    /// How many events found the queue full since it was last cleared.
    pub fn lost(&self) -> u32 {
        self.lost
    }

    pub(crate) fn check(&self, lost_before: u32) -> Result<(), EventsLost> {
        if self.lost == lost_before { Ok(()) } else { Err(EventsLost(self.lost)) }
    }

    fn push(&mut self, fired: Fired) {
        if self.fired.push_back(fired).is_err() {
            self.lost = self.lost.saturating_add(1);
        }
    }

    /// Adds the events at one frame: that of a start.
    pub(crate) fn at(&mut self, clip: &Clip<'_>, frame: u32) {
        self.forward(clip, frame, frame + 1);
    }

    /// Adds the events that a stretch of play passes, each as often as it is passed.
    pub(crate) fn pass(&mut self, clip: &Clip<'_>, passage: &Passage) {
        if clip.event_count() == 0 {
            return;
        }
        // An event fires when its instant is reached, and not again when play goes on from there.
        let (start, end) = if passage.forward {
            (passage.from + 1, passage.to + 1)
        } else {
            (passage.from + u32::from(passage.from_rest), passage.to + u32::from(passage.to_rest))
        };
        let laps = passage.laps.unsigned_abs();
        let run = |queue: &mut EventQueue, from: u32, to: u32| {
            if passage.forward { queue.forward(clip, from, to) } else { queue.backward(clip, to, from) }
        };
        if laps == 0 {
            return run(self, start, end);
        }
        let (first, last) = if passage.forward { (0, clip.frames()) } else { (clip.frames(), 0) };
        run(self, start, last);
        for _ in 1..laps {
            run(self, first, last);
        }
        run(self, first, end);
    }

    /// Events of frames `from..to`.
    fn forward(&mut self, clip: &Clip<'_>, from: u32, to: u32) {
        for event in clip.events().skip_while(|event| event.frame < from).take_while(|event| event.frame < to) {
            self.push(Fired { id: event.id, frame: event.frame });
        }
    }

    /// Events of frames `from..to`, last first. A clip lists them forwards, so that each is searched for.
    fn backward(&mut self, clip: &Clip<'_>, from: u32, to: u32) {
        let within = |event: &pantin::Event| (from..to).contains(&event.frame);
        let (before, count) =
            (clip.events().take_while(|event| event.frame < from).count(), clip.events().filter(within).count());
        // What finds the queue full is counted without a search.
        let room = EVENTS - self.fired.len();
        for back in 0..count.min(room) {
            if let Some(event) = clip.events().nth(before + count - 1 - back) {
                self.push(Fired { id: event.id, frame: event.frame });
            }
        }
        self.lost = self.lost.saturating_add(count.saturating_sub(room) as u32);
    }
}
