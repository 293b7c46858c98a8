//! The board's side of a transfer, as the app plays it, and one who sends.
#![allow(dead_code)]

use pantin_link::packet::{self, Receiver};
use pantin_store::message::ANSWER;
use pantin_store::{Answer, Ask, BLOCK, Claim, Slot, Store, Update};

/// Golden vectors: clips of several blocks.
pub const OLD: &[u8] = include_bytes!("../../../../tests/vectors/index.ptn");
pub const NEW: &[u8] = include_bytes!("../../../../tests/vectors/followers.ptn");
pub const THIRD: &[u8] = include_bytes!("../../../../tests/vectors/numbers.ptn");

/// What a clip is sent with.
pub fn claim(clip: &[u8]) -> Claim {
    Claim::of(clip, "clip").unwrap()
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
pub fn asks<'a>(clip: &'a [u8], claim: &Claim) -> Vec<Ask<'a>> {
    let id = claim.crc;
    let data = clip.chunks(BLOCK).enumerate().map(|(block, bytes)| Ask::Data { id, offset: (block * BLOCK) as u32, bytes });
    [Ask::Begin(*claim)].into_iter().chain(data).chain([Ask::End { id }]).collect()
}

/// As it goes over the line.
pub fn line(ask: &Ask) -> Vec<u8> {
    let mut out = vec![0; packet::line_len(8 + BLOCK)];
    let len = ask.write(9, &mut out).unwrap();
    out.truncate(len);
    out
}

/// What a board says to bytes, and the letters among them. A clip that came whole is tried and sealed.
pub struct Said {
    pub answers: Vec<Answer>,
    pub letters: Vec<u8>,
    pub sealed: bool,
}

/// Gives it bytes.
pub fn say<S: Slot>(update: &mut Update<S>, bytes: &[u8]) -> Said {
    let mut said = Said { answers: vec![], letters: vec![], sealed: false };
    let mut receiver = Receiver::<ANSWER>::new();
    let mut heard = vec![];
    for &byte in bytes {
        said.letters.extend(update.take(byte, |bytes| heard.extend_from_slice(bytes)));
        if update.is_whole() {
            let playable = update.candidate().is_some();
            said.sealed |= update.finish(playable, |bytes| heard.extend_from_slice(bytes));
        }
        if said.sealed {
            break;
        }
    }
    for byte in heard {
        if let Some(packet) = receiver.push(byte) {
            said.answers.push(Answer::read(&packet).expect("boards say nothing else"));
        }
    }
    said
}

/// Sends a whole clip, without damage; the last answer.
pub fn send<S: Slot>(store: &mut Store<S>, clip: &[u8]) -> Option<Answer> {
    let (_, mut update) = Update::open(store);
    let mut last = None;
    for ask in asks(clip, &claim(clip)) {
        last = say(&mut update, &line(&ask)).answers.last().copied();
    }
    last
}
