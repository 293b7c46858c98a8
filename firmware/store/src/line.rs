//! Letters and packets, which share the line.

use crate::message::{ASK, SILENCE};
use pantin_link::packet::{Packet, Receiver};

/// What bytes belong to now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum At {
    /// Letters.
    Letters,
    /// A packet, of which the first zero was there.
    Begun,
    /// A packet.
    Packet,
    /// Nobody knows: something was damaged.
    Lost,
}

/// A byte's meaning.
pub(crate) enum Heard<'a> {
    Letter(u8),
    Packet(Packet<'a>),
    Nothing,
}

/// The line, as the board hears it.
#[derive(Debug)]
pub(crate) struct Line {
    receiver: Receiver<ASK>,
    at: At,
    /// Pictures since the last byte.
    silent: u16,
}

impl Line {
    pub(crate) const fn new() -> Line {
        Line { receiver: Receiver::new(), at: At::Letters, silent: 0 }
    }

    /// Takes a byte.
    pub(crate) fn take(&mut self, byte: u8) -> Heard<'_> {
        self.silent = 0;
        match (self.at, byte) {
            (At::Letters | At::Lost, 0) => {
                // Ends whatever was before it; no packet of ours does so.
                self.receiver.push(0);
                self.at = At::Begun;
            }
            (At::Letters, b' '..=b'~' | b'\n' | b'\r' | b'\t') => return Heard::Letter(byte),
            (At::Letters | At::Lost, _) => self.at = At::Lost,
            (At::Begun, 0) => {}
            (At::Begun | At::Packet, _) => {
                self.at = if byte == 0 { At::Lost } else { At::Packet };
                if let Some(packet) = self.receiver.push(byte) {
                    self.at = At::Letters;
                    return Heard::Packet(packet);
                }
            }
        }
        Heard::Nothing
    }

    /// A picture was shown: what was begun and does not go on was not a packet.
    pub(crate) fn picture(&mut self) {
        self.silent = self.silent.saturating_add(1);
        if self.silent >= SILENCE {
            self.at = At::Letters;
        }
    }
}
