//! What arrives over a line, and what is in a board's flash: nothing panics, and only valid clips play.

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use pantin::{Clip, Form};
use pantin_line::sender::{LineSettings, Sender, Source};
use pantin_link::packet::{self, Receiver};
use pantin_link::{Channel, Head, Link, MAX_PACKET, Messages, QUEUE_PACKETS, read_starts};
use pantin_store::header::Header;
use pantin_store::message::{MAX_RESPONSE, MAX_STARTS};
use pantin_store::{BLOCK_BYTES, ClipInfo, Request, Response, Slot, Store, Update};

use crate::clips::RIG;
use crate::fix;

/// Channels of the receiver.
const CHANNELS: usize = 128;
/// Bytes of the line between two frames.
const FRAME_BYTES: usize = 64;

/// Bytes of a line of which one input may consist.
const LINE_BYTES: usize = 8192;

/// The clip whose stream is the first input.
const WALK: &[u8] = include_bytes!("../../vectors/walk.ptn");
/// The clips whose updates are.
const UPDATES: [&[u8]; 2] = [include_bytes!("../../vectors/frames-3.ptn"), include_bytes!("../../vectors/events.ptn")];

/// A clip's packets, without parity and with it.
pub fn streams() -> Vec<Vec<u8>> {
    let Ok(source) = Clip::new_checked(WALK).map_err(drop).and_then(|clip| Source::new(&clip).map_err(drop)) else {
        return vec![];
    };
    let packets = |parity| {
        let line = LineSettings { rate: 3840.0, ahead: 48, share: 1.0, cycle: 60, parity, key: None };
        Sender::new(3).clip(&source, line, Some(1)).flat_map(|timed| timed.bytes).take(LINE_BYTES / 4).collect()
    };
    [false, true].map(packets).to_vec()
}

/// Two updates, one after the other.
pub fn updates() -> Vec<Vec<u8>> {
    let (mut line, mut sequence) = (vec![], 0);
    for clip in UPDATES {
        let Some(info) = ClipInfo::of(clip, "fuzz") else { continue };
        let data = clip.chunks(BLOCK_BYTES).enumerate();
        let data = data.map(|(block, bytes)| Request::Data { id: info.crc, offset: (block * BLOCK_BYTES) as u32, bytes });
        for request in [Request::Begin(info)].into_iter().chain(data).chain([Request::End { id: info.crc }]) {
            let mut out = [0; packet::line_len(8 + BLOCK_BYTES)];
            let len = request.write(sequence, &mut out).unwrap_or(0);
            line.extend_from_slice(&out[..len]);
            sequence = sequence.wrapping_add(1);
        }
    }
    vec![line]
}

/// Plays the bytes of a line, and reads them as payloads. Returns whether they are intact packets.
pub fn link_receive(bytes: &[u8]) -> bool {
    let bytes = bytes.get(..LINE_BYTES).unwrap_or(bytes);
    payloads(bytes);
    let with_parity = hear(Receiver::with_parity(), bytes);
    hear(Receiver::new(), bytes) || with_parity
}

fn payloads(bytes: &[u8]) {
    let mut state = [0; 4];
    for (_, _, message) in Messages::new(bytes) {
        state = message.apply(state, message.mode);
    }
    if let Some((head, _)) = Head::read(bytes) {
        read_starts(bytes, head.identity(), |_, _| {});
    }
    read_starts(bytes, 0, |_, _| {});
}

fn hear(mut receiver: Receiver<MAX_PACKET>, bytes: &[u8]) -> bool {
    let form = Clip::new_checked(WALK).map_or(Form::default(), |clip| clip.form());
    let (mut channels, mut pose) = ([Channel::default(); CHANNELS], [0; CHANNELS]);
    let mut link = Link::<QUEUE_PACKETS>::new(form, &mut channels, &mut pose);
    let mut played = false;
    for bytes in bytes.chunks(FRAME_BYTES) {
        for &byte in bytes {
            if let Some(packet) = receiver.push(byte) {
                let _ = link.receive(&packet);
            }
            receiver.take_key();
        }
        let before = link.now();
        link.step();
        // Time never goes back but where another clock or clip was believed, which loses all states.
        if let (Some(before), Some(now)) = (before, link.now()) {
            played |= now != before;
        }
        let known = link.head().map_or(0, |head| usize::from(head.channels));
        assert!(link.exact_channels() <= known && known <= CHANNELS);
        assert!(link.frame().is_none_or(|frame| link.head().is_some_and(|head| frame < head.frames)));
    }
    receiver.take_key_after_timeout();
    played && receiver.damaged() == 0
}

const WORD: usize = 4;
const SECTOR: usize = 1024;
const SECTORS: usize = 8;

/// A slot in memory.
#[derive(Clone, Debug)]
struct Flash {
    bytes: Vec<u8>,
    erases: u32,
}

impl Flash {
    /// A slot that starts with these bytes.
    fn new(bytes: &[u8]) -> Flash {
        let mut all = bytes.get(..SECTORS * SECTOR).unwrap_or(bytes).to_vec();
        all.resize(SECTORS * SECTOR, 0xff);
        Flash { bytes: all, erases: 0 }
    }
}

impl ErrorType for Flash {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        bytes.copy_from_slice(
            self.bytes.get(offset as usize..).and_then(|rest| rest.get(..bytes.len())).ok_or(NorFlashErrorKind::OutOfBounds)?,
        );
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        assert!(from.is_multiple_of(SECTOR as u32) && to.is_multiple_of(SECTOR as u32));
        self.bytes.get_mut(from as usize..to as usize).ok_or(NorFlashErrorKind::OutOfBounds)?.fill(0xff);
        self.erases += (to - from) / SECTOR as u32;
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        assert!(offset.is_multiple_of(WORD as u32) && bytes.len().is_multiple_of(WORD));
        let place = self
            .bytes
            .get_mut(offset as usize..)
            .and_then(|rest| rest.get_mut(..bytes.len()))
            .ok_or(NorFlashErrorKind::OutOfBounds)?;
        assert!(place.iter().all(|&byte| byte == 0xff), "flash is written that was not erased");
        place.copy_from_slice(bytes);
        Ok(())
    }
}

impl Slot for Flash {
    fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

/// Returns the length of the clip that plays; it must be valid.
fn plays(store: &mut Store<Flash>) -> Option<usize> {
    let stored = store.open().0?;
    assert!(Clip::new_checked(stored.bytes).is_ok());
    assert_eq!(ClipInfo::of(stored.bytes, stored.info.name.as_str()).map(|info| info.crc), Some(stored.info.crc));
    Some(stored.bytes.len())
}

/// Opens a store whose slots hold the bytes as they are, and behind a valid header, as a clip with its CRCs corrected. Returns whether that plays; a clip
/// whose rig is apart must not.
pub fn store_open(bytes: &[u8]) -> bool {
    let (first, second) = bytes.split_at(bytes.len() / 2);
    plays(&mut Store::new([Flash::new(first), Flash::new(second)]));
    let mut clip = bytes.to_vec();
    fix::clip(&mut clip);
    let Some(info) = ClipInfo::of(&clip, "fuzz") else { return false };
    let mut slot = Header { info, sequence: 1 }.bytes().to_vec();
    slot.resize(BLOCK_BYTES, 0xff);
    slot.extend(&clip);
    let played = plays(&mut Store::new([Flash::new(bytes), Flash::new(&slot)]));
    let opened = Clip::with_rig(&clip, RIG).is_ok_and(|clip| clip.rig_len() == 0);
    assert!(!opened || played.is_none());
    opened || played == Some(clip.len())
}

/// Takes the bytes of an update's line. Returns whether requests came and none was refused.
pub fn update_receive(bytes: &[u8]) -> bool {
    let bytes = bytes.get(..LINE_BYTES).unwrap_or(bytes);
    let mut store = Store::new([Flash::new(&[]), Flash::new(&[])]);
    let (mut answered, mut refused, mut sealed) = (false, false, 0);
    let mut rest = bytes;
    while !rest.is_empty() {
        let (_, mut update) = Update::open(&mut store);
        let mut receiver = Receiver::<MAX_RESPONSE>::new();
        let mut done = false;
        while let Some((&byte, after)) = rest.split_first().filter(|_| !done) {
            rest = after;
            let mut answers = vec![];
            let key = update.receive(byte, |answer| answers.extend_from_slice(answer));
            assert!(key.is_none_or(|key| key.is_ascii_graphic() || b" \n\r\t".contains(&key)));
            if update.is_complete() {
                let playable = update.candidate().is_some();
                done = update.finish(playable, |answer| answers.extend_from_slice(answer));
                sealed += u32::from(done);
            }
            for byte in answers {
                if let Some(packet) = receiver.push(byte) {
                    let response = Response::read(&packet).expect("boards send nothing else");
                    answered = true;
                    refused |= matches!(response, Response::Refused { .. });
                }
            }
            if byte == b'p' {
                update.frame_shown();
            }
        }
    }
    plays(&mut store);
    let erases: u32 = store.into_slots().iter().map(|slot| slot.erases).sum();
    assert!(erases <= (sealed + 1) * (u32::from(MAX_STARTS) + 1) * SECTORS as u32, "{erases} sectors erased");
    answered && !refused
}
