//! Sends a clip to a board: one message after the other, each repeated until it is answered.

use pantin_link::packet::{self, Receiver};
use pantin_store::message::MAX_RESPONSE;
use pantin_store::{BLOCK_BYTES, ClipInfo, Refusal, Request, Response};
use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// When a transfer is given up.
#[derive(Clone, Copy, Debug)]
pub struct RetryPolicy {
    /// The time to wait for an answer before a message is sent again.
    pub answer: Duration,
    /// Messages in a row without progress after which the board counts as lost; and how often it may lose the transfer, by a restart for example.
    pub tries: u32,
}

impl Default for RetryPolicy {
    fn default() -> Self {
        RetryPolicy { answer: Duration::from_secs(1), tries: 10 }
    }
}

/// The cost of a transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Bytes of the clip that were sent: 0 if the board had it already.
    pub sent: u32,
    /// Messages that were sent again.
    pub again: u32,
}

/// The reason why the new clip does not play.
#[derive(Debug)]
pub enum TransferError {
    /// The board refuses it.
    Refused(Refusal),
    /// It did not answer: the bytes of the clip that it had by then.
    NoResponse(u32),
    /// The board lost the transfer this many times.
    Restarts(u32),
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
            TransferError::Restarts(times) => {
                write!(
                    f,
                    "the board restarted, or lost the transfer, {times} times; the old clip keeps playing: check its power supply"
                )
            }
            TransferError::Line(error) => write!(f, "the line failed: {error}"),
        }
    }
}

/// Sends `clip`, and passes the number of bytes that the board has to `told`. Reading from `line` must time out by itself.
///
/// The number of messages is bounded: within one attempt each message must make progress within [`RetryPolicy::tries`], and there are at most as many
/// further attempts.
pub fn send(
    line: &mut (impl Read + Write),
    clip: &[u8],
    info: &ClipInfo,
    policy: RetryPolicy,
    told: &mut dyn FnMut(u32),
) -> Result<Outcome, TransferError> {
    let mut sender = Sender { line, info, policy, receiver: Receiver::new(), sequence: 0, at: None, missed: 0, restarts: 0 };
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
                if sender.at.is_some_and(|at| offset < at) {
                    sender.count_restart()?;
                }
                outcome.sent += offset.saturating_sub(sender.at.unwrap_or(offset));
                sender.at = Some(offset);
                told(offset);
            }
            Some(Response::Done { .. }) => return Ok(outcome),
            // The board restarted in between.
            Some(Response::Refused { refusal: Refusal::NotBegun, .. }) => {
                sender.count_restart()?;
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
    policy: RetryPolicy,
    receiver: Receiver<MAX_RESPONSE>,
    sequence: u8,
    /// The offset that the board expects next; `None` before the transfer has begun.
    at: Option<u32>,
    /// Messages since the last progress.
    missed: u32,
    /// How often the board lost the transfer.
    restarts: u32,
}

impl<L: Read + Write> Sender<'_, L> {
    /// Counts that the board has lost the transfer, which begins again.
    fn count_restart(&mut self) -> Result<(), TransferError> {
        (self.at, self.restarts) = (None, self.restarts + 1);
        if self.restarts > self.policy.tries { Err(TransferError::Restarts(self.restarts)) } else { Ok(()) }
    }

    /// Sends a request and returns its answer, or `None` if none arrives in time.
    fn request(&mut self, request: &Request) -> Result<Option<Response>, TransferError> {
        if self.missed >= self.policy.tries {
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

    /// Waits for an answer, and ignores all other bytes on the line, such as pictures.
    fn answer(&mut self) -> Result<Option<Response>, TransferError> {
        let deadline = Instant::now() + self.policy.answer;
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

    /// Returns whether the answer belongs to this clip and says something new.
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

#[cfg(test)]
mod tests {
    use super::*;
    use pantin_store::message::MAX_REQUEST;

    /// A board that answers each request by a function.
    struct Board<F> {
        receiver: Receiver<MAX_REQUEST>,
        answers: Vec<u8>,
        requests: u32,
        answer: F,
    }

    impl<F: FnMut(u32, &Request) -> Option<Response>> Write for Board<F> {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            for &byte in bytes {
                let Some(request) = self.receiver.push(byte).and_then(|packet| Request::read(&packet).map(|_| packet)) else {
                    continue;
                };
                let request = Request::read(&request).expect("it was read");
                self.requests += 1;
                assert!(self.requests < 10_000, "the transfer does not end");
                if let Some(answer) = (self.answer)(self.requests, &request) {
                    let mut out = [0; packet::line_len(MAX_RESPONSE)];
                    let len = answer.write(0, &mut out).expect("it fits");
                    self.answers.extend(&out[..len]);
                }
            }
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl<F> Read for Board<F> {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            let len = self.answers.len().min(bytes.len());
            if len == 0 {
                std::thread::sleep(Duration::from_millis(1));
                return Err(ErrorKind::WouldBlock.into());
            }
            bytes[..len].copy_from_slice(&self.answers[..len]);
            self.answers.drain(..len);
            Ok(len)
        }
    }

    const POLICY: RetryPolicy = RetryPolicy { answer: Duration::from_millis(5), tries: 5 };

    /// Sends 4,000 bytes to a board; returns the error and the number of requests.
    fn fails(answer: impl FnMut(u32, &Request) -> Option<Response>) -> (TransferError, u32) {
        let clip = vec![7; 4000];
        let info = ClipInfo::of(&clip, "clip").expect("it is short");
        let mut board = Board { receiver: Receiver::new(), answers: vec![], requests: 0, answer };
        let error = send(&mut board, &clip, &info, POLICY, &mut |_| {}).expect_err("it must fail");
        (error, board.requests)
    }

    fn id(request: &Request) -> u32 {
        match *request {
            Request::Begin(info) => info.crc,
            Request::Data { id, .. } | Request::End { id } => id,
        }
    }

    #[test]
    fn a_board_that_loses_every_transfer_is_given_up() {
        let (error, requests) = fails(|_, request| {
            let id = id(request);
            Some(match request {
                Request::Begin(_) => Response::Next { id, offset: 0 },
                _ => Response::Refused { id, refusal: Refusal::NotBegun },
            })
        });
        assert!(error.to_string().contains("restart"), "{error}");
        assert!(requests <= 2 * (POLICY.tries + 1), "{requests} requests");
    }

    #[test]
    fn a_board_that_goes_back_is_given_up() {
        let (error, requests) = fails(|count, request| Some(Response::Next { id: id(request), offset: count % 3 * 256 }));
        assert!(error.to_string().contains("restart"), "{error}");
        assert!(requests <= 4 * (POLICY.tries + 1), "{requests} requests");
    }

    #[test]
    fn a_board_that_restarts_in_the_middle_of_each_transfer_is_given_up() {
        let mut next = 0;
        let (error, requests) = fails(|count, request| {
            let id = id(request);
            next = match request {
                _ if count % 9 == 8 => 0,
                Request::Data { offset, bytes, .. } if *offset == next => next + bytes.len() as u32,
                _ => next,
            };
            Some(Response::Next { id, offset: next })
        });
        assert!(error.to_string().contains("restart"), "{error}");
        assert!(requests <= 10 * (POLICY.tries + 1), "{requests} requests");
    }
}
