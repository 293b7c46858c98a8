//! The board's side of a clip update.

use crate::BLOCK_BYTES;
use crate::header::ClipInfo;
use crate::inactive_slot::InactiveSlot;
use crate::line::{Input, MessageLine};
use crate::message::{IDLE_FRAMES, MAX_RESPONSE, MAX_STARTS, Refusal, Request, Response};
use crate::slot::Slot;
use crate::store::{Store, StoredClip};
use pantin_link::packet;

/// Receives a clip while another plays.
#[derive(Debug)]
pub struct Update<'a, S> {
    line: MessageLine,
    sequence: u8,
    transfer: Transfer<'a, S>,
}

/// The transfer of a clip.
#[derive(Debug)]
struct Transfer<'a, S> {
    inactive: InactiveSlot<'a, S>,
    /// The clip that the store plays.
    current: Option<ClipInfo>,
    /// The clip that is being received.
    incoming: Option<ClipInfo>,
    /// The number of its bytes that are in the flash.
    next: u32,
    /// Whether all of it is there, to be checked and sealed.
    complete: bool,
    /// Frames shown since the last message.
    idle: u16,
    /// Transfers that have brought data, at most [`MAX_STARTS`].
    starts: u8,
}

impl<'a, S: Slot> Update<'a, S> {
    /// Returns the clip to play, if the store holds one, and the receiver of the next one.
    pub fn open(store: &'a mut Store<S>) -> (Option<StoredClip<'a>>, Self) {
        let (stored, inactive) = store.open();
        let current = stored.map(|stored| stored.info);
        let transfer = Transfer { inactive, current, incoming: None, next: 0, complete: false, idle: 0, starts: 0 };
        (stored, Update { line: MessageLine::new(), sequence: 0, transfer })
    }

    /// Takes a byte from the line, and passes the answer to `send` if the byte completes a message. Returns the byte if it is a key and not part of a packet.
    pub fn receive(&mut self, byte: u8, send: impl FnMut(&[u8])) -> Option<u8> {
        let request = match self.line.push(byte) {
            Input::Key(letter) => return Some(letter),
            Input::Nothing => return None,
            Input::Packet(packet) => Request::read(&packet)?,
        };
        self.transfer.idle = 0;
        if let Some(answer) = self.transfer.receive(&request) {
            self.answer(&answer, send);
        }
        None
    }

    /// Counts a frame that was shown: a transfer without a message for [`IDLE_FRAMES`] is abandoned.
    pub fn frame_shown(&mut self) {
        self.line.frame_shown();
        self.transfer.idle = self.transfer.idle.saturating_add(1);
        if self.transfer.idle >= IDLE_FRAMES {
            self.transfer.incoming = None;
        }
    }

    /// Returns whether a clip is complete: then try [`candidate`](Update::candidate), and call [`finish`](Update::finish).
    pub fn is_complete(&self) -> bool {
        self.transfer.complete
    }

    /// Returns the received clip, if its bytes are right and the decoder can open it.
    pub fn candidate(&self) -> Option<StoredClip<'_>> {
        let info = self.transfer.incoming?;
        let bytes = self.transfer.inactive.check(&info).ok()?;
        Some(StoredClip { bytes, info })
    }

    /// Seals the clip if the board can play it, and answers the host. Returns whether the clip is sealed: then open the store again.
    pub fn finish(&mut self, playable: bool, send: impl FnMut(&[u8])) -> bool {
        self.transfer.complete = false;
        let Some(info) = self.transfer.incoming.take() else { return false };
        let sealed = match self.transfer.inactive.check(&info) {
            Ok(_) if !playable => Err(Refusal::TooBig),
            Ok(_) => self.transfer.inactive.seal(&info),
            Err(refusal) => Err(refusal),
        };
        let answer = match sealed {
            Ok(()) => Response::Done { id: info.crc },
            Err(refusal) => Response::Refused { id: info.crc, refusal },
        };
        self.answer(&answer, send);
        sealed.is_ok()
    }

    fn answer(&mut self, answer: &Response, mut send: impl FnMut(&[u8])) {
        let mut out = [0; packet::line_len(MAX_RESPONSE)];
        self.sequence = self.sequence.wrapping_add(1);
        if let Some(line) = answer.write(self.sequence, &mut out).and_then(|len| out.get(..len)) {
            send(line);
        }
    }
}

impl<S: Slot> Transfer<'_, S> {
    /// Takes a message. Returns `None` if the answer has to wait for the check.
    fn receive(&mut self, request: &Request) -> Option<Response> {
        let (id, done) = match *request {
            Request::Begin(info) => (info.crc, self.begin(info)),
            Request::Data { id, offset, bytes } => (id, self.data(id, offset, bytes)),
            Request::End { id } => (id, self.end(id)),
        };
        match done {
            Ok(()) if self.complete => None,
            Ok(()) if self.incoming.is_none() => Some(Response::Done { id }),
            Ok(()) => Some(Response::Next { id, offset: self.next }),
            Err(refusal) => {
                if !matches!(refusal, Refusal::NotBegun) {
                    self.incoming = None;
                }
                Some(Response::Refused { id, refusal })
            }
        }
    }

    fn begin(&mut self, info: ClipInfo) -> Result<(), Refusal> {
        if self.incoming == Some(info) {
            return Ok(());
        }
        self.incoming = None;
        if self.current == Some(info) {
            return Ok(());
        }
        self.inactive.begin(&info)?;
        (self.incoming, self.next) = (Some(info), 0);
        Ok(())
    }

    /// Writes the bytes that are expected next; ignores others, which the answer corrects.
    fn data(&mut self, id: u32, offset: u32, bytes: &[u8]) -> Result<(), Refusal> {
        let info = self.incoming.filter(|info| info.crc == id).ok_or(Refusal::NotBegun)?;
        let left = info.length.saturating_sub(self.next);
        if offset == self.next && bytes.len() == left.min(BLOCK_BYTES as u32) as usize {
            if offset == 0 {
                self.starts = self.starts.checked_add(1).filter(|&starts| starts <= MAX_STARTS).ok_or(Refusal::TooManyStarts)?;
            }
            self.inactive.write(offset, bytes)?;
            self.next += bytes.len() as u32;
        }
        Ok(())
    }

    fn end(&mut self, id: u32) -> Result<(), Refusal> {
        match self.incoming {
            Some(info) if info.crc == id => self.complete = self.next == info.length,
            // A repeated `end`: the first answer was lost.
            None if self.current.is_some_and(|current| current.crc == id) => {}
            _ => return Err(Refusal::NotBegun),
        }
        Ok(())
    }
}
