//! A clip, sent to a board: one message after the other, each again until it is answered.

use pantin_link::packet::{self, Receiver};
use pantin_store::message::MAX_RESPONSE;
use pantin_store::{BLOCK_BYTES, ClipInfo, Refusal, Request, Response};
use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// How long, and how often.
#[derive(Clone, Copy, Debug)]
pub struct RetryPolicy {
    /// For an answer.
    pub answer: Duration,
    /// Messages without an answer, one after the other, after which the board counts as lost.
    pub tries: u32,
}

impl Default for RetryPolicy {
    fn default() -> Self {
        RetryPolicy { answer: Duration::from_secs(1), tries: 10 }
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
pub enum TransferError {
    /// The board will not have it.
    Refused(Refusal),
    /// It did not answer: the bytes of the clip that it had by then.
    NoResponse(u32),
    /// The line failed.
    Line(io::Error),
}

impl std::error::Error for TransferError {}

impl fmt::Display for TransferError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TransferError::Refused(refusal) => write!(f, "refused, the old clip goes on playing: {refusal}"),
            TransferError::NoResponse(0) => {
                f.write_str("no answer: is the firmware built with feature `update`, and is the speed right?")
            }
            TransferError::NoResponse(bytes) => {
                write!(
                    f,
                    "no more answers after {bytes} bytes; the old clip goes on playing, and the same command takes it up again"
                )
            }
            TransferError::Line(error) => write!(f, "the line failed: {error}"),
        }
    }
}

/// Sends it. `told` hears how many bytes the board has. The line's reading must end by itself where nothing comes.
pub fn send(
    line: &mut (impl Read + Write),
    clip: &[u8],
    info: &ClipInfo,
    patience: RetryPolicy,
    told: &mut dyn FnMut(u32),
) -> Result<Outcome, TransferError> {
    let mut sender = Sender { line, info, patience, receiver: Receiver::new(), sequence: 0, at: None, missed: 0 };
    let mut outcome = Outcome { sent: 0, again: 0 };
    loop {
        let request = match sender.at {
            None => Request::Begin(*info),
            Some(offset) if offset < info.length => {
                let rest = &clip[offset as usize..];
                Request::Data { id: info.crc, offset, bytes: &rest[..rest.len().min(BLOCK_BYTES)] }
            }
            Some(_) => Request::End { id: info.crc },
        };
        match sender.request(&request)? {
            Some(Response::Next { offset, .. }) => {
                outcome.sent += offset.saturating_sub(sender.at.unwrap_or(offset));
                sender.at = Some(offset);
                told(offset);
            }
            Some(Response::Done { .. }) => return Ok(outcome),
            // The board restarted in between.
            Some(Response::Refused { refusal: Refusal::NotBegun, .. }) => {
                sender.at = None;
                outcome.again += 1;
            }
            Some(Response::Refused { refusal, .. }) => return Err(TransferError::Refused(refusal)),
            None => outcome.again += 1,
        }
    }
}

struct Sender<'a, L> {
    line: &'a mut L,
    info: &'a ClipInfo,
    patience: RetryPolicy,
    receiver: Receiver<MAX_RESPONSE>,
    sequence: u8,
    /// From where the board wants bytes. None before it was asked.
    at: Option<u32>,
    /// Messages since the last that helped.
    missed: u32,
}

impl<L: Read + Write> Sender<'_, L> {
    /// Says something and waits for what helps: none if that does not come.
    fn request(&mut self, request: &Request) -> Result<Option<Response>, TransferError> {
        if self.missed >= self.patience.tries {
            return Err(TransferError::NoResponse(self.at.unwrap_or(0)));
        }
        let mut out = [0; packet::line_len(8 + BLOCK_BYTES)];
        let len = request.write(self.sequence, &mut out).unwrap_or(0);
        self.sequence = self.sequence.wrapping_add(1);
        self.line.write_all(&out[..len]).and_then(|()| self.line.flush()).map_err(TransferError::Line)?;
        let answer = self.answer()?;
        let lost = matches!(answer, None | Some(Response::Refused { refusal: Refusal::NotBegun, .. }));
        self.missed = if lost { self.missed + 1 } else { 0 };
        Ok(answer)
    }

    /// What comes in time and helps. Other bytes on the line, pictures say, are passed over.
    fn answer(&mut self) -> Result<Option<Response>, TransferError> {
        let deadline = Instant::now() + self.patience.answer;
        let mut bytes = [0; 512];
        while Instant::now() < deadline {
            let len = match self.line.read(&mut bytes) {
                Ok(0) => return Err(TransferError::Line(ErrorKind::UnexpectedEof.into())),
                Ok(len) => len,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => 0,
                Err(error) => return Err(TransferError::Line(error)),
            };
            for &byte in &bytes[..len] {
                let answer = self.receiver.push(byte).and_then(|packet| Response::read(&packet));
                if let Some(answer) = answer.filter(|answer| self.helps(answer)) {
                    return Ok(Some(answer));
                }
            }
        }
        Ok(None)
    }

    /// Not what another clip's transfer was told, nor what this one was told before.
    fn helps(&self, answer: &Response) -> bool {
        let id = match *answer {
            Response::Next { offset, .. } if self.at == Some(offset) => return false,
            Response::Next { id, offset } => {
                return id == self.info.crc
                    && (offset == self.info.length || offset < self.info.length && offset % BLOCK_BYTES as u32 == 0);
            }
            Response::Done { id } | Response::Refused { id, .. } => id,
        };
        id == self.info.crc
    }
}
