//! Poses that arrive over the serial line in packets. The clip that the program was built with gives the rig and the camera.
//!
//! In [`Mode::Sync`](crate::Mode::Sync) the sender asks for a frame with [`NEXT`](crate::NEXT) between two zero bytes; the letters of
//! commands arrive in the same way.

use super::{LinkStatus, Source, Status};
use crate::board::{Board, Exit};
use crate::capacity::Capacity;
use crate::log::{error, info};
#[cfg(feature = "key")]
use crate::options::Key;
use crate::session::Outcome;
use pantin::{Player, Pose};
#[cfg(feature = "events")]
use pantin_link::packet::Packet;
use pantin_link::packet::Receiver;
use pantin_link::{ClipMismatch, Link, MAX_PACKET, QUEUE_PACKETS, fits};
#[cfg(feature = "events")]
use pantin_link::{EventQueue, Head, LineEvent};

/// What the packets of a line have.
pub(crate) struct LineSettings {
    pub parity: bool,
    #[cfg(feature = "key")]
    pub key: Key,
    /// Letters are requests of a test.
    #[cfg(feature = "key")]
    pub sync: bool,
}

/// The receiving end of a link.
pub(crate) struct LinkSource<'m, 'p, 'c, 'b> {
    player: &'p mut Player<'c, 'b>,
    receiver: Receiver<MAX_PACKET>,
    link: Link<'m, QUEUE_PACKETS>,
    refusal: Option<ClipMismatch>,
    #[cfg(feature = "events")]
    events: EventQueue,
    /// Whether letters are commands: they have no tag, so that with a key anybody could send them.
    #[cfg(feature = "key")]
    letters: bool,
}

/// Opens a link and hands it to `then`. The buffers are here, so that only a program that plays a link has them on its stack.
#[inline(never)]
pub(crate) fn open<B: Board>(player: &mut Player, line: LineSettings, then: impl FnOnce(&mut LinkSource) -> Outcome) -> Outcome {
    let mut channels = B::Capacity::link_channels();
    let mut pose = B::Capacity::pose();
    let form = player.clip().form();
    if !fits(&form) {
        error!("the rig is too big for the link");
        return Outcome::Exit(Exit::BadClip);
    }
    pose.as_mut().iter_mut().zip(player.pose().values).for_each(|(value, own)| *value = *own);
    let link = Link::new(form, channels.as_mut(), pose.as_mut());
    let receiver = if line.parity { Receiver::with_parity() } else { Receiver::new() };
    #[cfg(feature = "key")]
    let receiver = match line.key {
        Key::None => receiver,
        Key::Tag(key) => receiver.with_tag_key(key),
        Key::Invalid => {
            error!("the option key is not 32 hexadecimal digits");
            return Outcome::Exit(Exit::BadClip);
        }
    };
    then(&mut LinkSource {
        player,
        receiver,
        link,
        refusal: None,
        #[cfg(feature = "events")]
        events: EventQueue::default(),
        #[cfg(feature = "key")]
        letters: line.sync || line.key == Key::None,
    })
}

/// Keeps an event for its frame; `before` is the clip that played before this packet.
#[cfg(feature = "events")]
fn keep_event(events: &mut EventQueue, link: &Link<'_, QUEUE_PACKETS>, before: Option<Head>, packet: &Packet<'_>) {
    if before.as_ref() != link.head() {
        events.clear();
    }
    let now = link.now().or(link.head().map(|head| head.begin.wrapping_sub(1)));
    let event = link.head().and_then(|head| LineEvent::read(packet, head));
    if let (Some(event), Some(now)) = (event, now) {
        events.push(event, now);
    }
}

impl LinkSource<'_, '_, '_, '_> {
    fn link_status(&self) -> LinkStatus {
        LinkStatus {
            counts: self.link.counts(),
            damaged: self.receiver.damaged(),
            exact: self.link.exact_channels() as u16,
            channels: self.link.head().map_or(0, |head| head.channels),
            refusal: self.refusal,
        }
    }
}

impl Source for LinkSource<'_, '_, '_, '_> {
    const LIVE: bool = true;

    fn advance(&mut self, frames: i32) {
        if frames == 0 {
            return;
        }
        let exact = self.link.exact_channels();
        self.link.step();
        if exact != self.link.exact_channels() {
            self.log();
        }
    }

    fn pose(&self) -> Pose<'_> {
        self.link.pose()
    }

    fn frame(&self) -> u32 {
        self.link.frame().unwrap_or(0)
    }

    fn frame_time_ns(&self) -> u32 {
        self.link.head().map_or(self.player.clip().frame_time_ns(), |head| head.frame_time_ns)
    }

    #[cfg(feature = "events")]
    fn hear(&mut self, _since: crate::events::Since, _frames: i32, heard: &mut dyn FnMut(crate::HeardEvent)) {
        let Some(now) = self.link.now() else { return };
        while let Some(event) = self.events.take(now) {
            heard(crate::HeardEvent { frame: self.link.frame().unwrap_or(0), id: event.id, name: event.name() });
        }
    }

    fn status(&self) -> Status {
        Status::Link(self.link_status())
    }

    fn with_player(&mut self, then: impl FnOnce(&mut Player)) {
        then(self.player)
    }

    fn receive(&mut self, byte: u8) -> Option<u8> {
        if let Some(packet) = self.receiver.push(byte) {
            #[cfg(feature = "events")]
            let before = self.link.head().copied();
            self.refusal = self.link.receive(&packet).err();
            #[cfg(feature = "events")]
            keep_event(&mut self.events, &self.link, before, &packet);
        }
        let letter = self.receiver.take_key();
        #[cfg(feature = "key")]
        return letter.filter(|_| self.letters);
        #[cfg(not(feature = "key"))]
        letter
    }

    fn receive_nothing(&mut self) -> Option<u8> {
        let letter = self.receiver.take_key_after_timeout();
        #[cfg(feature = "key")]
        return letter.filter(|_| self.letters);
        #[cfg(not(feature = "key"))]
        letter
    }

    fn log(&self) {
        let LinkStatus { counts, damaged, exact, channels, refusal } = self.link_status();
        info!(
            "{} packets, {} missing, {} damaged, {} foreign, {} crowded; {} states lost; {} of {} channels exact",
            counts.packets, counts.missing, damaged, counts.rejected, counts.dropped, counts.desyncs, exact, channels
        );
        if let Some(refusal) = refusal {
            error!("the line's clip cannot be played: {}", refusal);
        }
        let _ = (counts, damaged, exact, channels);
    }
}
