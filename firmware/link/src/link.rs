//! The receiver: packets in, a pose a frame out. Nothing that comes can make it fail; what it says of itself is true.

use crate::channel::Channel;
use crate::head::{ChannelKind, Head, read_starts};
use crate::message::Messages;
use crate::packet::{Packet, kind};
use heapless::Vec;
use pantin::{Form, Pose};

/// Bytes of a motion's payload that a sender makes at most.
pub const MAX_PAYLOAD: usize = 96;
/// Packets of motion that wait for their frames at a receiver at most: a sender counts on as many places.
pub const QUEUE_PACKETS: usize = 24;
/// Bytes of any packet of this crate, for [`crate::packet::Receiver`]: with parity.
pub const MAX_PACKET: usize = MAX_PAYLOAD + crate::packet::OVERHEAD + crate::packet::PARITY;

/// A packet of motion that waits for its frames.
#[derive(Clone, Debug)]
struct QueuedPacket {
    /// The line's frame of its last message.
    last: u32,
    payload: Vec<u8, MAX_PAYLOAD>,
}

/// What has come, modulo 2^32.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Packets of this crate's kinds.
    pub packets: u32,
    /// Packets that are missing by their sequence; such as come later than others are counted here too.
    pub missing: u32,
    /// Packets of another clip, with a check that is not right, or too late.
    pub rejected: u32,
    /// Packets that found the queue full.
    pub dropped: u32,
    /// Times that a channel's state was lost.
    pub desyncs: u32,
}

/// Plays what comes over a line in memory of the caller's. `Q` packets wait for their frames: [`QUEUE_PACKETS`] is
/// what senders count on.
#[derive(Debug)]
pub struct Link<'m, const Q: usize> {
    channels: &'m mut [Channel],
    pose: &'m mut [i32],
    form: Form,
    head: Option<Head>,
    /// A clip that was told of, with where the sender was: it begins with the first other packet of it.
    next: Option<(Head, u32)>,
    queue: Vec<QueuedPacket, Q>,
    clock: Option<Clock>,
    /// Where the sender was when it told of the clip.
    heard: u32,
    sequence: Option<u8>,
    counts: Counts,
}

/// The line's frames.
#[derive(Clone, Copy, Debug)]
struct Clock {
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

impl Clock {
    /// Counts a packet's time as a vote for another clock; returns whether that clock now has [`VOTES`].
    fn vote(&mut self, sender_frame: u32) -> bool {
        let apart = sender_frame.wrapping_sub(self.rival_frame) as i32;
        self.rival_votes = if apart.unsigned_abs() <= MAX_LEAD as u32 { self.rival_votes.saturating_add(1) } else { 1 };
        self.rival_frame = sender_frame;
        self.rival_votes >= VOTES
    }
}

/// Frames that the clock may be behind the sender's before it takes two at once, and ahead (negative) before it waits: the jitter of packets.
const CATCH_UP_FRAMES: i32 = 5;
const HOLD_FRAMES: i32 = -2;
/// Frames behind from which it takes all at once,
const SKIP_FRAMES: i32 = 12;
/// and from which it no longer follows what has gone on since.
const FORGET_FRAMES: u32 = 256;

/// A clip that this receiver cannot play.
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipMismatch {
    /// It is of another rig.
    Rig,
    /// Its positions or its rotations are coded in another way; `pantin convert --rotations euler` leaves no choice.
    Form,
    /// There are more channels than memory for them.
    Channels,
}

impl<'m, const Q: usize> Link<'m, Q> {
    /// Waits for clips of this form, in memory for the channels of its pose. The pose as it is is where the figure stands until
    /// more is known.
    pub fn new(form: Form, channels: &'m mut [Channel], pose: &'m mut [i32]) -> Self {
        channels.iter_mut().for_each(|channel| *channel = Channel::default());
        let (queue, counts) = (Vec::new(), Counts::default());
        Link { channels, pose, form, head: None, next: None, queue, clock: None, heard: 0, sequence: None, counts }
    }

    /// Takes a packet. Those of other kinds are passed over.
    pub fn receive(&mut self, packet: &Packet<'_>) -> Result<(), ClipMismatch> {
        if !matches!(packet.kind, kind::HEAD | kind::STARTS | kind::MOTION) {
            return Ok(());
        }
        self.counts.packets = self.counts.packets.wrapping_add(1);
        let expected = self.sequence.map_or(packet.sequence, |last| last.wrapping_add(1));
        let gap = packet.sequence.wrapping_sub(expected);
        // Half of what a byte holds is a packet that comes later than its successors.
        if gap < 128 {
            self.counts.missing = self.counts.missing.wrapping_add(u32::from(gap));
            self.sequence = Some(packet.sequence);
        }
        if packet.kind == kind::HEAD {
            return self.take_head(packet.payload);
        }
        // A head alone changes nothing: it may be another sender's that came by chance.
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

    /// Goes over to the clip that was told of last.
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
        let fresh = Clock { now: sender_frame, sender_frame, received_until: base, rival_frame: sender_frame, rival_votes: 0 };
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

    /// Goes on by the time of a frame: [`Link::pose`] is what to draw then. Time stands still while nothing is told of the frames to come.
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

    /// How many frames time goes on by now.
    fn steps(&mut self) -> u32 {
        let Some(clock) = &mut self.clock else { return 0 };
        // No sender is further than what it has told of.
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

    /// A frame on: the additions, then what begins there.
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
        Pose { values: self.pose, form: &self.form }
    }

    /// The clip that plays.
    pub fn head(&self) -> Option<&Head> {
        self.head.as_ref()
    }

    /// The line's frame that is shown.
    pub fn now(&self) -> Option<u32> {
        self.clock.map(|clock| clock.now)
    }

    /// The frame of the clip that is shown.
    pub fn frame(&self) -> Option<u32> {
        let head = self.head?;
        self.now()?.checked_sub(head.begin)?.checked_rem(head.frames)
    }

    /// How many of the clip's channels are exactly what the sender has of them.
    pub fn exact_channels(&self) -> usize {
        let channels = self.head.map_or(0, |head| usize::from(head.channels));
        self.channels.iter().take(channels).filter(|channel| channel.is_exact()).count()
    }

    /// Whether every channel is.
    pub fn is_synced(&self) -> bool {
        self.clock.is_some() && self.head.is_some_and(|head| usize::from(head.channels) == self.exact_channels())
    }

    /// The states of the pose's channels.
    pub fn channels(&self) -> &[Channel] {
        self.channels
    }

    /// What has come.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}

/// First and last frame of a packet of motion, and how far ahead it was, if it is of this clip and whole.
fn motion_of(payload: &[u8], head: &Head, about: u32) -> Option<(u32, u32, u8)> {
    let mut messages = Messages::new(payload);
    let base = near(messages.base(), about);
    messages.by_ref().for_each(drop);
    let last = base.wrapping_add(u32::from(messages.frame().wrapping_sub(messages.base())));
    messages.whole(head.check(base)).then_some((base, last, messages.ahead()))
}

/// The frame nearest to `about` with these low bits.
fn near(low: u16, about: u32) -> u32 {
    about.wrapping_add(i32::from(low.wrapping_sub(about as u16) as i16) as u32)
}

/// Whether `a` comes before `b`; frames may wrap.
fn before(a: u32, b: u32) -> bool {
    (a.wrapping_sub(b) as i32) < 0
}
