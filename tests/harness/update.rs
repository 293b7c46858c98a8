//! A board with a store, played in step, to which a clip is sent message by message.

use anyhow::{Context, Result};
use pantin_link::packet::{self, Receiver};
use pantin_store::message::ANSWER;
use pantin_store::{Answer, Ask, BLOCK, Claim};

use crate::sync::Session;

/// The messages of a transfer.
pub fn asks<'a>(clip: &'a [u8], claim: &Claim) -> Vec<Ask<'a>> {
    let id = claim.crc;
    let data = clip.chunks(BLOCK).enumerate().map(|(block, bytes)| Ask::Data { id, offset: (block * BLOCK) as u32, bytes });
    [Ask::Begin(*claim)].into_iter().chain(data).chain([Ask::End { id }]).collect()
}

/// A message as it goes over the line.
pub fn line(ask: &Ask) -> Result<Vec<u8>> {
    let mut out = vec![0; packet::line_len(8 + BLOCK)];
    let len = ask.write(0, &mut out).context("a message that does not fit its packet")?;
    out.truncate(len);
    Ok(out)
}

/// A packet that says nothing: after it, letters are letters again.
pub fn nothing() -> Result<Vec<u8>> {
    let mut out = vec![0; packet::line_len(0)];
    let len = packet::encode(*packet::kind::UPDATES.end(), 0, &[], &mut out).context("a packet that does not fit")?;
    out.truncate(len);
    Ok(out)
}

/// Says something to a board that waits for the next picture to be asked for, and returns what it answers.
pub fn ask(session: &mut Session, ask: &Ask) -> Result<Answer> {
    session.send(&line(ask)?)?;
    let mut receiver = Receiver::<ANSWER>::new();
    loop {
        let byte = session.receive()?;
        if let Some(packet) = receiver.push(byte) {
            return Answer::read(&packet).with_context(|| format!("the board says {packet:?}"));
        }
    }
}

/// Sends a whole clip, and returns the last answer.
pub fn send(session: &mut Session, clip: &[u8], claim: &Claim) -> Result<Answer> {
    let mut last = None;
    for message in asks(clip, claim) {
        let answer = ask(session, &message)?;
        last = Some(answer);
        if !matches!(answer, Answer::Want { .. }) {
            break;
        }
    }
    last.context("no message")
}
