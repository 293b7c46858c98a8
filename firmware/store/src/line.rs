//! Separates the keys of a terminal from the packets of an update: both share the serial line.

use crate::message::{MAX_REQUEST, SILENCE_FRAMES};
use pantin_link::packet::{Packet, Receiver};

/// What the next byte belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// A byte is a key.
    Keys,
    /// A packet, whose first zero has arrived.
    Start,
    /// A packet, whose bytes are arriving.
    Packet,
    /// Unknown, because something was damaged: bytes are dropped until the next zero.
    Lost,
}

/// What a byte completes.
pub(crate) enum Input<'a> {
    Key(u8),
    Packet(Packet<'a>),
    Nothing,
}

/// The board's end of the line.
#[derive(Debug)]
pub(crate) struct MessageLine {
    receiver: Receiver<MAX_REQUEST>,
    state: State,
    /// Frames shown since the last byte.
    silent_frames: u16,
}

impl MessageLine {
    pub(crate) const fn new() -> MessageLine {
        MessageLine { receiver: Receiver::new(), state: State::Keys, silent_frames: 0 }
    }

    /// Takes one byte and returns the key or the packet that it completes.
    pub(crate) fn push(&mut self, byte: u8) -> Input<'_> {
        self.silent_frames = 0;
        match (self.state, byte) {
            (State::Keys | State::Lost, 0) => {
                // The zero ends whatever came before it, which was not an intact packet.
                self.receiver.push(0);
                self.state = State::Start;
            }
            (State::Keys, b' '..=b'~' | b'\n' | b'\r' | b'\t') => return Input::Key(byte),
            (State::Keys | State::Lost, _) => self.state = State::Lost,
            (State::Start, 0) => {}
            (State::Start | State::Packet, _) => {
                self.state = if byte == 0 { State::Lost } else { State::Packet };
                if let Some(packet) = self.receiver.push(byte) {
                    self.state = State::Keys;
                    return Input::Packet(packet);
                }
            }
        }
        Input::Nothing
    }

    /// Counts a frame that was shown. After [`SILENCE_FRAMES`] without a byte, an incomplete packet is abandoned.
    pub(crate) fn frame_shown(&mut self) {
        self.silent_frames = self.silent_frames.saturating_add(1);
        if self.silent_frames >= SILENCE_FRAMES {
            self.state = State::Keys;
        }
    }
}
