//! A clip's replacement, as the board does its part.

use crate::BLOCK;
use crate::header::Claim;
use crate::line::{Heard, Line};
use crate::message::{ANSWER, Answer, Ask, IDLE, Refusal};
use crate::slot::Slot;
use crate::spare::Spare;
use crate::store::{Store, Stored};
use pantin_link::packet;

/// Listens for a clip while another plays.
#[derive(Debug)]
pub struct Update<'a, S> {
    line: Line,
    sequence: u8,
    transfer: Transfer<'a, S>,
}

/// The clip that comes.
#[derive(Debug)]
struct Transfer<'a, S> {
    spare: Spare<'a, S>,
    /// The clip that the store plays.
    current: Option<Claim>,
    /// The one that comes.
    coming: Option<Claim>,
    /// How much of it is there.
    next: u32,
    /// It is to be checked and sealed.
    whole: bool,
    /// Pictures since the last message.
    idle: u16,
}

impl<'a, S: Slot> Update<'a, S> {
    /// The clip to play, if the store holds one, and who listens for the next.
    pub fn open(store: &'a mut Store<S>) -> (Option<Stored<'a>>, Self) {
        let (stored, spare) = store.open();
        let current = stored.map(|stored| stored.claim);
        let transfer = Transfer { spare, current, coming: None, next: 0, whole: false, idle: 0 };
        (stored, Update { line: Line::new(), sequence: 0, transfer })
    }

    /// Takes a byte from the line, and answers if it ends a message. What is no part of a packet is a letter, and handed on.
    pub fn take(&mut self, byte: u8, send: impl FnMut(&[u8])) -> Option<u8> {
        let ask = match self.line.take(byte) {
            Heard::Letter(letter) => return Some(letter),
            Heard::Nothing => return None,
            Heard::Packet(packet) => Ask::read(&packet)?,
        };
        self.transfer.idle = 0;
        if let Some(answer) = self.transfer.take(&ask) {
            self.answer(&answer, send);
        }
        None
    }

    /// A picture was shown.
    pub fn picture(&mut self) {
        self.line.picture();
        self.transfer.idle = self.transfer.idle.saturating_add(1);
        if self.transfer.idle >= IDLE {
            self.transfer.coming = None;
        }
    }

    /// Whether a clip came whole: then [`candidate`](Update::candidate) is to be tried, and [`finish`](Update::finish) called.
    pub fn is_whole(&self) -> bool {
        self.transfer.whole
    }

    /// The clip that came, if it is what was claimed and can be opened.
    pub fn candidate(&self) -> Option<Stored<'_>> {
        let claim = self.transfer.coming?;
        let bytes = self.transfer.spare.check(&claim).ok()?;
        Some(Stored { bytes, claim })
    }

    /// Seals the clip if the board can play it, and tells the other end. Whether it is sealed: then the store is to be opened anew.
    pub fn finish(&mut self, playable: bool, send: impl FnMut(&[u8])) -> bool {
        self.transfer.whole = false;
        let Some(claim) = self.transfer.coming.take() else { return false };
        let sealed = match self.transfer.spare.check(&claim) {
            Ok(_) if !playable => Err(Refusal::TooBig),
            Ok(_) => self.transfer.spare.seal(&claim),
            Err(refusal) => Err(refusal),
        };
        let answer = match sealed {
            Ok(()) => Answer::Done { id: claim.crc },
            Err(refusal) => Answer::Refused { id: claim.crc, refusal },
        };
        self.answer(&answer, send);
        sealed.is_ok()
    }

    fn answer(&mut self, answer: &Answer, mut send: impl FnMut(&[u8])) {
        let mut out = [0; packet::line_len(ANSWER)];
        self.sequence = self.sequence.wrapping_add(1);
        if let Some(line) = answer.write(self.sequence, &mut out).and_then(|len| out.get(..len)) {
            send(line);
        }
    }
}

impl<S: Slot> Transfer<'_, S> {
    /// Takes a message. None where the answer must wait for the check.
    fn take(&mut self, ask: &Ask) -> Option<Answer> {
        let (id, done) = match *ask {
            Ask::Begin(claim) => (claim.crc, self.begin(claim)),
            Ask::Data { id, offset, bytes } => (id, self.data(id, offset, bytes)),
            Ask::End { id } => (id, self.end(id)),
        };
        match done {
            Ok(()) if self.whole => None,
            Ok(()) if self.coming.is_none() => Some(Answer::Done { id }),
            Ok(()) => Some(Answer::Want { id, offset: self.next }),
            Err(refusal) => {
                if !matches!(refusal, Refusal::NotBegun) {
                    self.coming = None;
                }
                Some(Answer::Refused { id, refusal })
            }
        }
    }

    fn begin(&mut self, claim: Claim) -> Result<(), Refusal> {
        if self.coming == Some(claim) {
            return Ok(());
        }
        self.coming = None;
        if self.current == Some(claim) {
            return Ok(());
        }
        self.spare.begin(&claim)?;
        (self.coming, self.next) = (Some(claim), 0);
        Ok(())
    }

    /// What is not wanted now is answered with what is.
    fn data(&mut self, id: u32, offset: u32, bytes: &[u8]) -> Result<(), Refusal> {
        let claim = self.coming.filter(|claim| claim.crc == id).ok_or(Refusal::NotBegun)?;
        let left = claim.length.saturating_sub(self.next);
        if offset == self.next && bytes.len() == left.min(BLOCK as u32) as usize {
            self.spare.write(offset, bytes)?;
            self.next += bytes.len() as u32;
        }
        Ok(())
    }

    fn end(&mut self, id: u32) -> Result<(), Refusal> {
        match self.coming {
            Some(claim) if claim.crc == id => self.whole = self.next == claim.length,
            // Said twice: the first answer was lost.
            None if self.current.is_some_and(|current| current.crc == id) => {}
            _ => return Err(Refusal::NotBegun),
        }
        Ok(())
    }
}
