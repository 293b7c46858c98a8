//! The board's side of a transfer, as the app plays it, and one who sends.
#![allow(dead_code)]

use pantin_link::packet::{self, Receiver};
use pantin_store::message::MAX_RESPONSE;
use pantin_store::{BLOCK_BYTES, ClipInfo, Request, Response, Slot, Store, Update};

/// Golden vectors: clips of several blocks.
pub const OLD: &[u8] = include_bytes!("../../../../tests/vectors/index.ptn");
pub const NEW: &[u8] = include_bytes!("../../../../tests/vectors/channels-300.ptn");
pub const THIRD: &[u8] = include_bytes!("../../../../tests/vectors/numbers.ptn");

/// What a clip is sent with.
pub fn info(clip: &[u8]) -> ClipInfo {
    ClipInfo::of(clip, "clip").unwrap()
}

/// Which clip that is.
pub fn which(clip: &[u8]) -> &'static str {
    [(OLD, "old"), (NEW, "new"), (THIRD, "third")].iter().find(|(bytes, _)| *bytes == clip).map_or("another", |(_, name)| name)
}

/// The clip that plays.
pub fn playing<S: Slot>(store: &mut Store<S>) -> Option<&'static str> {
    let (stored, _) = store.open();
    stored.map(|stored| which(stored.bytes))
}

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

/// As it goes over the line.
pub fn line(request: &Request) -> Vec<u8> {
    let mut out = vec![0; packet::line_len(8 + BLOCK_BYTES)];
    let len = request.write(9, &mut out).unwrap();
    out.truncate(len);
    out
}

/// What a board says to bytes, and the keys among them. A clip that came whole is tried and sealed.
pub struct Said {
    pub answers: Vec<Response>,
    pub keys: Vec<u8>,
    pub sealed: bool,
}

/// Gives it bytes.
pub fn say<S: Slot>(update: &mut Update<S>, bytes: &[u8]) -> Said {
    let mut said = Said { answers: vec![], keys: vec![], sealed: false };
    let mut receiver = Receiver::<MAX_RESPONSE>::new();
    let mut heard = vec![];
    for &byte in bytes {
        said.keys.extend(update.receive(byte, |bytes| heard.extend_from_slice(bytes)));
        if update.is_complete() {
            let playable = update.candidate().is_some();
            said.sealed |= update.finish(playable, |bytes| heard.extend_from_slice(bytes));
        }
        if said.sealed {
            break;
        }
    }
    for byte in heard {
        if let Some(packet) = receiver.push(byte) {
            said.answers.push(Response::read(&packet).expect("boards say nothing else"));
        }
    }
    said
}

/// Sends a whole clip, without damage; the last answer.
pub fn send<S: Slot>(store: &mut Store<S>, clip: &[u8]) -> Option<Response> {
    let (_, mut update) = Update::open(store);
    let mut last = None;
    for request in requests(clip, &info(clip)) {
        last = say(&mut update, &line(&request)).answers.last().copied();
    }
    last
}
