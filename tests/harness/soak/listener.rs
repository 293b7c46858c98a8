//! A receiver whose every frame is checked.

use pantin_line::sender::{LineSettings, Source};
use pantin_link::packet::Receiver;
use pantin_link::{Channel, Link, MAX_PACKET, QUEUE_PACKETS};

use super::Seen;

/// Frames in a row that may stand still while the clock waits for the sender's.
const MAX_STILL: u32 = 2;

/// A receiver from its start to its restart.
pub(super) struct Listener<'m> {
    link: Link<'m, QUEUE_PACKETS>,
    receiver: Receiver<MAX_PACKET>,
    /// The clip's time at the frame before, and for how many frames it has stood still.
    before: Option<u32>,
    still: u32,
}

impl<'m> Listener<'m> {
    /// A receiver that waits for clips of the source's form.
    pub fn new(source: &Source, settings: LineSettings, memory: &'m mut [Channel], pose: &'m mut [i32]) -> Listener<'m> {
        let receiver = if settings.parity { Receiver::with_parity() } else { Receiver::new() };
        Listener { link: Link::new(source.form(), memory, pose), receiver, before: None, still: 0 }
    }

    pub fn push(&mut self, byte: u8) {
        if let Some(packet) = self.receiver.push(byte) {
            // Chance may make a packet of another rig's clip.
            let _ = self.link.receive(&packet);
        }
    }

    /// Shows a frame and compares its channels with the states that they should have; all must be exact if the line is `whole`.
    pub fn step(&mut self, states: &[(u16, Vec<[i32; 4]>)], whole: bool, seen: &mut Seen) {
        let link = &mut self.link;
        link.step();
        seen.frames += 1;
        let agrees = link.frame().is_none_or(|frame| {
            states.iter().all(|(channel, states)| {
                let state = link.channels().get(usize::from(*channel)).and_then(Channel::state);
                state.is_none_or(|state| states.get(frame as usize) == Some(&state))
            })
        });
        seen.wrong += u64::from(!agrees);
        seen.exact += u64::from(link.is_synced());
        self.still = if link.now() == self.before { self.still + 1 } else { 0 };
        self.before = link.now();
        seen.late += u64::from(whole && !(link.is_synced() && self.still <= MAX_STILL));
    }
}
