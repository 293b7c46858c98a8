//! A board with a store, played in step, to which a clip is sent message by message.

use anyhow::{Context, Result};
use pantin_link::packet::{self, Receiver};
use pantin_store::message::MAX_RESPONSE;
use pantin_store::{BLOCK_BYTES, ClipInfo, Request, Response};

use crate::sync::Session;

/// The messages of a transfer.
pub fn requests<'a>(clip: &'a [u8], info: &ClipInfo) -> Vec<Request<'a>> {
    let id = info.crc;
    let data = clip.chunks(BLOCK_BYTES).enumerate().map(|(block, bytes)| Request::Data {
        id,
        offset: (block * BLOCK_BYTES) as u32,
        bytes,
    });
    [Request::Begin(*info)].into_iter().chain(data).chain([Request::End { id }]).collect()
}

/// A message as it goes over the line.
pub fn line(request: &Request) -> Result<Vec<u8>> {
    let mut out = vec![0; packet::line_len(8 + BLOCK_BYTES)];
    let len = request.write(0, &mut out).context("a message that does not fit its packet")?;
    out.truncate(len);
    Ok(out)
}

/// A packet without meaning: after it, single bytes are keys again.
pub fn nothing() -> Result<Vec<u8>> {
    let mut out = vec![0; packet::line_len(0)];
    let len = packet::encode(*packet::kind::UPDATES.end(), 0, &[], &mut out).context("a packet that does not fit")?;
    out.truncate(len);
    Ok(out)
}

/// Sends a message to a board that waits for the request of the next picture, and returns its answer.
pub fn request(session: &mut Session, request: &Request) -> Result<Response> {
    session.send(&line(request)?)?;
    let mut receiver = Receiver::<MAX_RESPONSE>::new();
    loop {
        let byte = session.receive()?;
        if let Some(packet) = receiver.push(byte) {
            return Response::read(&packet).with_context(|| format!("the board says {packet:?}"));
        }
    }
}

/// Sends a whole clip, and returns the last answer.
pub fn send(session: &mut Session, clip: &[u8], info: &ClipInfo) -> Result<Response> {
    let mut last = None;
    for message in requests(clip, info) {
        let answer = request(session, &message)?;
        last = Some(answer);
        if !matches!(answer, Response::Next { .. }) {
            break;
        }
    }
    last.context("no message")
}
