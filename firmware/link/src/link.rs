//! The receiver: takes packets, and yields one pose per frame. No input makes it fail, and a state that it reports as exact is exact.

use crate::channel::Channel;
use crate::head::{ChannelKind, Head, read_starts};
use crate::message::Messages;
use crate::packet::{Packet, kind};
use heapless::Vec;
use pantin::{Form, Pose};

/// Most bytes of a MOTION payload.
pub const MAX_PAYLOAD: usize = 96;
/// MOTION packets that can wait for their frames at a receiver: senders assume this number.
pub const QUEUE_PACKETS: usize = 24;
/// Most bytes of a packet, for [`crate::packet::Receiver`], parity and a tag included.
pub const MAX_PACKET: usize = MAX_PAYLOAD + crate::packet::OVERHEAD + crate::packet::PARITY + TAG_MORE;
/// Bytes by which a tag is longer than the CRC that it replaces.
#[cfg(feature = "key")]
const TAG_MORE: usize = crate::packet::TAG - 2;
#[cfg(not(feature = "key"))]
const TAG_MORE: usize = 0;

/// A MOTION packet that waits for its frames.
#[derive(Clone, Debug)]
struct QueuedPacket {
    /// The line frame of its last message.
    last: u32,
    payload: Vec<u8, MAX_PAYLOAD>,
}

/// Statistics of the received packets, modulo 2^32.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// HEAD, STARTS and MOTION packets.
    pub packets: u32,
    /// Gaps in the sequence numbers. Packets that arrive out of order count too.
    pub missing: u32,
    /// Packets of another clip, with a wrong check, that arrived too late, or whose time is not believed.
    pub rejected: u32,
    /// Packets that arrived while the queue was full.
    pub dropped: u32,
    /// How often a channel lost its state.
    pub desyncs: u32,
}

/// Plays the motion that arrives in packets, in memory of the caller. At most `Q` packets wait for their frames; senders assume [`QUEUE_PACKETS`].
#[derive(Debug)]
pub struct Link<'m, const Q: usize> {
    channels: &'m mut [Channel],
    pose: &'m mut [i32],
    form: Form,
    head: Option<Head>,
    /// An announced clip and the sender's line frame: the receiver switches to it with the first other packet of that clip.
    next: Option<(Head, u32)>,
    queue: Vec<QueuedPacket, Q>,
    clock: Option<SenderClock>,
    /// The sender's line frame in the last HEAD.
    heard: u32,
    sequence: Option<u8>,
    counts: Counts,
}

/// The clock of the line, in line frames.
#[derive(Clone, Copy, Debug)]
struct SenderClock {
    /// The frame that is shown.
    now: u32,
    /// Where the sender is.
    sender_frame: u32,
    /// Everything about frames before this one has been received, or is lost.
    received_until: u32,
    /// The sender's frame as the last packet had it whose time was not believed.
    rival_frame: u32,
    /// Packets that agree on the rival, less those that were believed.
    rival_votes: u8,
}

/// Frames by which a packet may set the clock forward at once. A packet that is further ahead, or late, is only a vote for another clock: one packet
/// of a stranger, or one that is replayed, moves time no further than this.
const MAX_LEAD: i32 = 32;
/// Votes that replace the clock: believed packets take votes back, so it takes a majority.
const VOTES: u8 = 4;

impl SenderClock {
    /// Counts a packet's time as a vote for another clock; returns whether that clock now has [`VOTES`].
    fn vote(&mut self, sender_frame: u32) -> bool {
        let apart = sender_frame.wrapping_sub(self.rival_frame) as i32;
        self.rival_votes = if apart.unsigned_abs() <= MAX_LEAD as u32 { self.rival_votes.saturating_add(1) } else { 1 };
        self.rival_frame = sender_frame;
        self.rival_votes >= VOTES
    }
}

/// Frames behind the sender from which the clock advances two frames at once. Smaller differences are the jitter of packets.
const CATCH_UP_FRAMES: i32 = 5;
/// Frames behind the sender (negative: ahead) below which the clock waits.
const HOLD_FRAMES: i32 = -2;
/// Frames behind the sender from which the clock advances all of them at once.
const SKIP_FRAMES: i32 = 12;
/// Frames that are skipped without playing them: all channels lose their state.
const FORGET_FRAMES: u32 = 256;

/// The reason why this receiver cannot play a clip.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ClipMismatch {
    /// The clip has another rig.
    Rig,
    /// The clip has another length exponent, or codes other joints as exponential maps; `pantin convert --rotations euler` avoids the latter.
    Form,
    /// The clip has more channels than the receiver has memory for.
    Channels,
}

impl<'m, const Q: usize> Link<'m, Q> {
    /// Waits for clips of this form. `channels` and `pose` have one element for each channel of the pose; the figure keeps the given pose until
    /// packets arrive.
    pub fn new(form: Form, channels: &'m mut [Channel], pose: &'m mut [i32]) -> Self {
        channels.iter_mut().for_each(|channel| *channel = Channel::default());
        let (queue, counts) = (Vec::new(), Counts::default());
        Link { channels, pose, form, head: None, next: None, queue, clock: None, heard: 0, sequence: None, counts }
    }

    /// Takes a packet; ignores other kinds. Returns an error for a HEAD of a clip that this receiver cannot play; the current clip keeps playing.
    pub fn receive(&mut self, packet: &Packet<'_>) -> Result<(), ClipMismatch> {
        if !matches!(packet.kind, kind::HEAD | kind::STARTS | kind::MOTION) {
            return Ok(());
        }
        self.counts.packets = self.counts.packets.wrapping_add(1);
        let expected = self.sequence.map_or(packet.sequence, |last| last.wrapping_add(1));
        let gap = packet.sequence.wrapping_sub(expected);
        // More than half of the range means a packet that was overtaken.
        if gap < 128 {
            self.counts.missing = self.counts.missing.wrapping_add(u32::from(gap));
            self.sequence = Some(packet.sequence);
        }
        if packet.kind == kind::HEAD {
            return self.take_head(packet.payload);
        }
        // A HEAD alone changes nothing: it may be a stray one of another sender.
        let of_next = |(head, now): (Head, u32)| match packet.kind {
            kind::STARTS => read_starts(packet.payload, head.identity(), |_, _| {}),
            _ => motion_of(packet.payload, &head, now).is_some(),
        };
        if self.next.is_some_and(of_next) {
            self.change();
        }
        let taken = match packet.kind {
            kind::STARTS => self.take_starts(packet.payload),
            _ => self.take_motion(packet.payload),
        };
        if taken.is_none() {
            self.counts.rejected = self.counts.rejected.wrapping_add(1);
        }
        Ok(())
    }

    fn take_head(&mut self, payload: &[u8]) -> Result<(), ClipMismatch> {
        let Some((head, now)) = Head::read(payload) else {
            self.counts.rejected = self.counts.rejected.wrapping_add(1);
            return Ok(());
        };
        if self.head == Some(head) {
            self.heard = now;
            return Ok(());
        }
        if head.form.rig_id() != self.form.rig_id() {
            return Err(ClipMismatch::Rig);
        }
        if head.form != self.form {
            return Err(ClipMismatch::Form);
        }
        if usize::from(head.channels) > self.channels.len().min(self.pose.len()) {
            return Err(ClipMismatch::Channels);
        }
        self.next = Some((head, now));
        if self.head.is_none() {
            self.change();
        }
        Ok(())
    }

    /// Switches to the clip that was announced last.
    fn change(&mut self) {
        let Some((head, now)) = self.next.take() else { return };
        self.channels.iter_mut().for_each(Channel::forget);
        self.queue.clear();
        (self.head, self.heard, self.clock) = (Some(head), now, None);
    }

    fn take_starts(&mut self, payload: &[u8]) -> Option<()> {
        let head = self.head?;
        let channels = self.channels.get_mut(..usize::from(head.channels))?;
        let show = |channel: u16, kind: ChannelKind| {
            if let Some(channel) = channels.get_mut(usize::from(channel)) {
                channel.set_kind(kind);
            }
        };
        read_starts(payload, head.identity(), show).then_some(())
    }

    fn take_motion(&mut self, payload: &[u8]) -> Option<()> {
        let head = self.head?;
        let about = self.clock.map_or(self.heard, |clock| clock.now);
        let (base, last, ahead) = motion_of(payload, &head, about)?;
        if !self.set_clock(base, ahead, last) {
            return None;
        }
        let waiting = QueuedPacket { last, payload: Vec::from_slice(payload).ok()? };
        if self.queue.push(waiting).is_err() {
            self.counts.dropped = self.counts.dropped.wrapping_add(1);
        }
        Some(())
    }

    /// Takes the sender's time from a packet whose messages are at the line frames `base` to `last`. Returns whether the packet can be played: it is not
    /// late, and its time is believed.
    fn set_clock(&mut self, base: u32, ahead: u8, last: u32) -> bool {
        let sender_frame = base.wrapping_sub(u32::from(ahead));
        let fresh =
            SenderClock { now: sender_frame, sender_frame, received_until: base, rival_frame: sender_frame, rival_votes: 0 };
        let clock = self.clock.get_or_insert(fresh);
        let lead = sender_frame.wrapping_sub(clock.sender_frame) as i32;
        if lead > MAX_LEAD || before(last, clock.now) {
            if !clock.vote(sender_frame) {
                return false;
            }
            *clock = fresh;
            self.queue.clear();
            self.channels.iter_mut().for_each(Channel::lose);
        }
        clock.rival_votes = clock.rival_votes.saturating_sub(1);
        // A packet that was overtaken carries an old time, and a sender that has stalled is behind: the clock returns to its time slowly.
        if lead > 0 {
            clock.sender_frame = sender_frame;
        } else if lead < 0 {
            clock.sender_frame = clock.sender_frame.wrapping_sub(1);
        }
        if before(clock.received_until, last) {
            clock.received_until = last;
        }
        true
    }

    /// Advances by one frame's time; then [`Link::pose`] is what to draw. The clock stands still while nothing is received about the next frames.
    pub fn step(&mut self) {
        let steps = self.steps();
        for _ in 0..steps {
            self.play();
        }
        for index in 0..self.channels.len() {
            let leader = |channel: &Channel| self.channels.get(index.wrapping_sub(channel.follows()?)).copied();
            let leader = self.channels.get(index).and_then(leader);
            let Some(channel) = self.channels.get_mut(index) else { break };
            if let Some(leader) = leader {
                channel.follow(&leader);
            }
            if let Some(drawn) = self.pose.get_mut(index) {
                *drawn = channel.draw(*drawn, steps > 0);
            }
        }
    }

    /// Returns by how many frames the clock advances now.
    fn steps(&mut self) -> u32 {
        let Some(clock) = &mut self.clock else { return 0 };
        // The sender is assumed to stand still if nothing more was received.
        if before(clock.sender_frame, clock.received_until) {
            clock.sender_frame = clock.sender_frame.wrapping_add(1);
        }
        let off = clock.sender_frame.wrapping_sub(clock.now) as i32;
        let wanted = match off {
            SKIP_FRAMES.. => off,
            CATCH_UP_FRAMES.. => 2,
            HOLD_FRAMES.. => 1,
            _ => 0,
        };
        let told = clock.received_until.wrapping_sub(clock.now) as i32 - 1;
        let steps = wanted.min(told).max(0) as u32;
        if steps <= FORGET_FRAMES {
            return steps;
        }
        clock.now = clock.now.wrapping_add(steps - 1);
        self.channels.iter_mut().for_each(Channel::lose);
        1
    }

    /// Plays one frame: the additions, then the messages of that frame.
    fn play(&mut self) {
        let Some(clock) = &mut self.clock else { return };
        clock.now = clock.now.wrapping_add(1);
        let now = clock.now;
        for channel in self.channels.iter_mut() {
            channel.advance();
        }
        for waiting in &self.queue {
            for (at, channel, message) in Messages::new(&waiting.payload) {
                if let Some(channel) = self.channels.get_mut(usize::from(channel)).filter(|_| at == now as u16) {
                    channel.apply(at, &message);
                }
            }
        }
        self.queue.retain(|waiting| before(now, waiting.last));
        for channel in self.channels.iter_mut() {
            let lost = channel.check(now as u16);
            self.counts.desyncs = self.counts.desyncs.wrapping_add(u32::from(lost));
        }
    }

    /// One raw value a channel, as it is to be drawn.
    pub fn pose(&self) -> Pose<'_> {
        Pose { values: self.pose, form: (&self.form).into() }
    }

    /// Returns the clip that plays.
    pub fn head(&self) -> Option<&Head> {
        self.head.as_ref()
    }

    /// Returns the line frame that is shown.
    pub fn now(&self) -> Option<u32> {
        self.clock.map(|clock| clock.now)
    }

    /// Returns the clip's frame that is shown.
    pub fn frame(&self) -> Option<u32> {
        let head = self.head?;
        self.now()?.checked_sub(head.begin)?.checked_rem(head.frames)
    }

    /// Returns the number of channels whose state equals the sender's.
    pub fn exact_channels(&self) -> usize {
        let channels = self.head.map_or(0, |head| usize::from(head.channels));
        self.channels.iter().take(channels).filter(|channel| channel.is_exact()).count()
    }

    /// Returns whether the state of every channel equals the sender's.
    pub fn is_synced(&self) -> bool {
        self.clock.is_some() && self.head.is_some_and(|head| usize::from(head.channels) == self.exact_channels())
    }

    /// Returns the channels of the pose.
    pub fn channels(&self) -> &[Channel] {
        self.channels
    }

    /// Returns the statistics.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}

/// Returns the first and the last frame of a MOTION packet and how many frames it was ahead, if it is intact and belongs to this clip.
fn motion_of(payload: &[u8], head: &Head, about: u32) -> Option<(u32, u32, u8)> {
    let mut messages = Messages::new(payload);
    let base = near(messages.base(), about);
    messages.by_ref().for_each(drop);
    let last = base.wrapping_add(u32::from(messages.frame().wrapping_sub(messages.base())));
    messages.whole(head.check(base)).then_some((base, last, messages.ahead()))
}

/// Returns the frame nearest to `about` with these low 16 bits.
fn near(low: u16, about: u32) -> u32 {
    about.wrapping_add(i32::from(low.wrapping_sub(about as u16) as i16) as u32)
}

/// Returns whether `a` comes before `b`; frames may wrap.
pub(crate) fn before(a: u32, b: u32) -> bool {
    (a.wrapping_sub(b) as i32) < 0
}
