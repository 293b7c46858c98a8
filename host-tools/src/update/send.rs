//! A clip, sent to a board: one message after the other, each again until it is answered.

use pantin_link::packet::{self, Receiver};
use pantin_store::message::ANSWER;
use pantin_store::{Answer, Ask, BLOCK, Claim, Refusal};
use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// How long, and how often.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// For an answer.
    pub answer: Duration,
    /// Messages without an answer, one after the other, after which the board counts as lost.
    pub tries: u32,
}

impl Default for Patience {
    fn default() -> Self {
        Patience { answer: Duration::from_secs(1), tries: 10 }
    }
}

/// What a transfer took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Bytes of the clip that were sent: none where the board had it already.
    pub sent: u32,
    /// Messages that were said again.
    pub again: u32,
}

/// Why a clip does not play.
#[derive(Debug)]
pub enum Failure {
    /// The board will not have it.
    Refused(Refusal),
    /// It did not answer: the bytes of the clip that it had by then.
    Silent(u32),
    /// The line failed.
    Line(io::Error),
}

impl std::error::Error for Failure {}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Refused(refusal) => write!(f, "refused, the old clip goes on playing: {refusal}"),
            Failure::Silent(0) => f.write_str("no answer: is the firmware built with feature `update`, and is the speed right?"),
            Failure::Silent(bytes) => {
                write!(
                    f,
                    "no more answers after {bytes} bytes; the old clip goes on playing, and the same command takes it up again"
                )
            }
            Failure::Line(error) => write!(f, "the line failed: {error}"),
        }
    }
}

/// Sends it. `told` hears how many bytes the board has. The line's reading must end by itself where nothing comes.
pub fn send(
    line: &mut (impl Read + Write),
    clip: &[u8],
    claim: &Claim,
    patience: Patience,
    told: &mut dyn FnMut(u32),
) -> Result<Outcome, Failure> {
    let mut sender = Sender { line, claim, patience, receiver: Receiver::new(), sequence: 0, at: None, missed: 0 };
    let mut outcome = Outcome { sent: 0, again: 0 };
    loop {
        let ask = match sender.at {
            None => Ask::Begin(*claim),
            Some(offset) if offset < claim.length => {
                let rest = &clip[offset as usize..];
                Ask::Data { id: claim.crc, offset, bytes: &rest[..rest.len().min(BLOCK)] }
            }
            Some(_) => Ask::End { id: claim.crc },
        };
        match sender.ask(&ask)? {
            Some(Answer::Want { offset, .. }) => {
                outcome.sent += offset.saturating_sub(sender.at.unwrap_or(offset));
                sender.at = Some(offset);
                told(offset);
            }
            Some(Answer::Done { .. }) => return Ok(outcome),
            // The board began anew in between.
            Some(Answer::Refused { refusal: Refusal::NotBegun, .. }) => {
                sender.at = None;
                outcome.again += 1;
            }
            Some(Answer::Refused { refusal, .. }) => return Err(Failure::Refused(refusal)),
            None => outcome.again += 1,
        }
    }
}

struct Sender<'a, L> {
    line: &'a mut L,
    claim: &'a Claim,
    patience: Patience,
    receiver: Receiver<ANSWER>,
    sequence: u8,
    /// From where the board wants bytes. None before it was asked.
    at: Option<u32>,
    /// Messages since the last that helped.
    missed: u32,
}

impl<L: Read + Write> Sender<'_, L> {
    /// Says something and waits for what helps: none if that does not come.
    fn ask(&mut self, ask: &Ask) -> Result<Option<Answer>, Failure> {
        if self.missed >= self.patience.tries {
            return Err(Failure::Silent(self.at.unwrap_or(0)));
        }
        let mut out = [0; packet::line_len(8 + BLOCK)];
        let len = ask.write(self.sequence, &mut out).unwrap_or(0);
        self.sequence = self.sequence.wrapping_add(1);
        self.line.write_all(&out[..len]).and_then(|()| self.line.flush()).map_err(Failure::Line)?;
        let answer = self.answer()?;
        let lost = matches!(answer, None | Some(Answer::Refused { refusal: Refusal::NotBegun, .. }));
        self.missed = if lost { self.missed + 1 } else { 0 };
        Ok(answer)
    }

    /// What comes in time and helps. Other bytes on the line, pictures say, are passed over.
    fn answer(&mut self) -> Result<Option<Answer>, Failure> {
        let deadline = Instant::now() + self.patience.answer;
        let mut bytes = [0; 512];
        while Instant::now() < deadline {
            let len = match self.line.read(&mut bytes) {
                Ok(0) => return Err(Failure::Line(ErrorKind::UnexpectedEof.into())),
                Ok(len) => len,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => 0,
                Err(error) => return Err(Failure::Line(error)),
            };
            for &byte in &bytes[..len] {
                let answer = self.receiver.push(byte).and_then(|packet| Answer::read(&packet));
                if let Some(answer) = answer.filter(|answer| self.helps(answer)) {
                    return Ok(Some(answer));
                }
            }
        }
        Ok(None)
    }

    /// Not what another clip's transfer was told, nor what this one was told before.
    fn helps(&self, answer: &Answer) -> bool {
        let id = match *answer {
            Answer::Want { offset, .. } if self.at == Some(offset) => return false,
            Answer::Want { id, offset } => {
                return id == self.claim.crc
                    && (offset == self.claim.length || offset < self.claim.length && offset % BLOCK as u32 == 0);
            }
            Answer::Done { id } | Answer::Refused { id, .. } => id,
        };
        id == self.claim.crc
    }
}
