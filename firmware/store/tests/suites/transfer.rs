//! What may come over a line in place of a transfer: parts of it, damage, messages twice, late, or of others. The old clip plays on, and
//! a whole transfer works afterwards.

use crate::board::{NEW, OLD, info, line, playing, requests, say, send};
use crate::mock::{Mock, store};
use pantin::OpenError;
use pantin_store::message::{IDLE_FRAMES, MAX_STARTS, SILENCE_FRAMES};
use pantin_store::{BLOCK_BYTES, ClipInfo, Refusal, Request, Response, Store, Update};
use proptest::prelude::*;

type Nrf51 = Mock<4, 1024>;

/// A store that plays the old clip.
fn playing_old() -> Store<Nrf51> {
    let (mut store, _) = store::<4, 1024>(4);
    send(&mut store, OLD);
    assert_eq!(playing(&mut store), Some("old"));
    store
}

/// It still does, and takes the new one.
fn goes_on(mut store: Store<Nrf51>) {
    assert_eq!(playing(&mut store), Some("old"));
    takes_new(store);
}

fn takes_new(mut store: Store<Nrf51>) {
    assert_eq!(send(&mut store, NEW), Some(Response::Done { id: info(NEW).crc }));
    assert_eq!(playing(&mut store), Some("new"));
}

/// All bytes of the new clip's transfer.
fn stream() -> Vec<u8> {
    requests(NEW, &info(NEW)).iter().flat_map(line).collect()
}

#[test]
fn every_message_is_answered_with_what_is_wanted_next() {
    let mut store = playing_old();
    let id = info(NEW).crc;
    let (stored, mut update) = Update::open(&mut store);
    assert_eq!(stored.unwrap().bytes, OLD);
    let answers: Vec<Response> =
        requests(NEW, &info(NEW)).iter().flat_map(|request| say(&mut update, &line(request)).answers).collect();
    let wanted =
        (0..NEW.len()).step_by(BLOCK_BYTES).chain([NEW.len()]).map(|offset| Response::Next { id, offset: offset as u32 });
    assert_eq!(answers, wanted.chain([Response::Done { id }]).collect::<Vec<_>>());
}

#[test]
fn a_transfer_that_ends_at_any_sixteenth_leaves_the_old_clip() {
    let stream = stream();
    for part in 0..16 {
        let mut store = playing_old();
        let (_, mut update) = Update::open(&mut store);
        assert!(!say(&mut update, &stream[..stream.len() * part / 16]).sealed);
        // The board is switched off here: nothing but its flash stays.
        goes_on(store);
    }
}

#[test]
fn a_line_that_was_lost_at_any_sixteenth_is_taken_up_again() {
    let stream = stream();
    let messages = requests(NEW, &info(NEW));
    for part in 0..16 {
        let mut store = playing_old();
        let (_, mut update) = Update::open(&mut store);
        say(&mut update, &stream[..stream.len() * part / 16]);
        (0..SILENCE_FRAMES).for_each(|_| update.frame_shown());
        let answers = say(&mut update, &line(&messages[0])).answers;
        let [Response::Next { offset, .. }] = answers[..] else { panic!("{answers:?}") };
        let sent = (stream.len() * part / 16).saturating_sub(line(&messages[0]).len()) / line(&messages[1]).len();
        assert_eq!(offset as usize, sent * BLOCK_BYTES, "{part} of 16");
        let rest = &messages[1 + sent..];
        assert!(rest.iter().any(|request| say(&mut update, &line(request)).sealed), "{part} of 16");
        assert_eq!(playing(&mut store), Some("new"));
    }
}

#[test]
fn one_that_begins_again_starts_where_it_was_and_one_that_plays_is_done() {
    let mut store = playing_old();
    let (_, mut update) = Update::open(&mut store);
    let (old, new) = (info(OLD), info(NEW));
    assert_eq!(say(&mut update, &line(&Request::Begin(old))).answers, [Response::Done { id: old.crc }]);
    assert_eq!(say(&mut update, &line(&Request::End { id: old.crc })).answers, [Response::Done { id: old.crc }]);
    for request in &requests(NEW, &new)[..3] {
        say(&mut update, &line(request));
    }
    let at = Response::Next { id: new.crc, offset: 2 * BLOCK_BYTES as u32 };
    assert_eq!(say(&mut update, &line(&Request::Begin(new))).answers, [at]);
    assert_eq!(say(&mut update, &line(&Request::End { id: new.crc })).answers, [at], "not all is there");
    for late in &requests(NEW, &new)[1..3] {
        assert_eq!(say(&mut update, &line(late)).answers, [at], "what it has");
    }
    assert_eq!(say(&mut update, &line(&requests(NEW, &new)[5])).answers, [at], "what comes too early");
    let short = Request::Data { id: new.crc, offset: 2 * BLOCK_BYTES as u32, bytes: &NEW[2 * BLOCK_BYTES..][..9] };
    assert_eq!(say(&mut update, &line(&short)).answers, [at], "no whole block");
    assert!(requests(NEW, &new)[3..].iter().any(|request| say(&mut update, &line(request)).sealed));
}

#[test]
fn what_cannot_be_played_is_refused_with_the_reason() {
    let refused = |clip: &[u8], info: ClipInfo| {
        let mut store = playing_old();
        let (_, mut update) = Update::open(&mut store);
        let answers: Vec<Response> =
            requests(clip, &info).iter().flat_map(|request| say(&mut update, &line(request)).answers).collect();
        let refusal = answers.iter().find_map(|answer| match answer {
            Response::Refused { id, refusal } if *id == info.crc => Some(*refusal),
            _ => None,
        });
        goes_on(store);
        refusal.unwrap_or_else(|| panic!("{answers:?}"))
    };
    let spoilt = |at: usize| {
        let mut clip = NEW.to_vec();
        clip[at] ^= 4;
        clip
    };
    let of = |clip: &[u8]| refused(clip, info(clip));
    assert_eq!(of(&[7; 5000]), Refusal::TooLong { capacity: 4096 - 256 });
    assert_eq!(of(&[7; 500]), Refusal::Clip(OpenError::BadMagic));
    assert_eq!(of(&[]), Refusal::Clip(OpenError::Truncated));
    assert_eq!(of(&NEW[..NEW.len() - 1]), Refusal::Clip(OpenError::Truncated));
    assert_eq!(of(&spoilt(NEW.len() - 40)), Refusal::Clip(OpenError::BadCrc));
    assert_eq!(of(&spoilt(1)), Refusal::Clip(OpenError::BadMagic));
    assert_eq!(of(&spoilt(2)), Refusal::Clip(OpenError::UnsupportedVersion(NEW[2] ^ 4)));
    assert_eq!(refused(&spoilt(900), info(NEW)), Refusal::BadCrc);
}

#[test]
fn what_the_board_has_no_memory_for_is_refused() {
    let mut store = playing_old();
    let (_, mut update) = Update::open(&mut store);
    let id = info(NEW).crc;
    for request in requests(NEW, &info(NEW)) {
        for byte in line(&request) {
            update.receive(byte, |_| {});
        }
    }
    assert!(update.is_complete());
    assert_eq!(update.candidate().unwrap().bytes, NEW);
    let mut said = vec![];
    assert!(!update.finish(false, |bytes| said.extend_from_slice(bytes)));
    let mut out = [0; 40];
    let len = Response::Refused { id, refusal: Refusal::TooBig }.write(said[3], &mut out).unwrap();
    assert_eq!(said[..said.len() - 4], out[..len - 4], "but for the sequence and its CRC");
    goes_on(store);
}

#[test]
fn flash_that_fails_is_told_and_the_transfer_given_up() {
    let (mut store, power) = store::<4, 1024>(4);
    send(&mut store, OLD);
    let (_, mut update) = Update::open(&mut store);
    let messages = requests(NEW, &info(NEW));
    say(&mut update, &line(&messages[0]));
    power.cut(10, 1);
    let id = info(NEW).crc;
    assert_eq!(say(&mut update, &line(&messages[1])).answers, [Response::Refused { id, refusal: Refusal::Flash }]);
    power.restore();
    assert_eq!(say(&mut update, &line(&messages[2])).answers, [Response::Refused { id, refusal: Refusal::NotBegun }]);
    goes_on(store);
}

#[test]
fn a_transfer_that_stands_still_is_given_up() {
    let mut store = playing_old();
    let (_, mut update) = Update::open(&mut store);
    let messages = requests(NEW, &info(NEW));
    let id = info(NEW).crc;
    say(&mut update, &line(&messages[0]));
    (1..IDLE_FRAMES).for_each(|_| update.frame_shown());
    assert_eq!(say(&mut update, &line(&messages[1])).answers, [Response::Next { id, offset: BLOCK_BYTES as u32 }]);
    (0..IDLE_FRAMES).for_each(|_| update.frame_shown());
    assert_eq!(say(&mut update, &line(&messages[2])).answers, [Response::Refused { id, refusal: Refusal::NotBegun }]);
    goes_on(store);
}

/// Sectors of both slots that were erased so far.
fn erases(store: Store<Nrf51>) -> (Store<Nrf51>, u32) {
    let slots = store.into_slots();
    let sum = slots.iter().flat_map(|slot| &slot.erases).sum();
    (Store::new(slots), sum)
}

#[test]
fn transfers_that_begin_and_bring_nothing_wear_no_flash() {
    let (mut store, before) = erases(playing_old());
    let (_, mut update) = Update::open(&mut store);
    for crc in 0..1000 {
        let info = ClipInfo { crc, ..info(NEW) };
        assert_eq!(say(&mut update, &line(&Request::Begin(info))).answers, [Response::Next { id: crc, offset: 0 }]);
    }
    let (store, after) = erases(store);
    assert_eq!(after, before);
    goes_on(store);
}

#[test]
fn transfers_that_never_end_wear_a_bounded_number_of_sectors() {
    let (mut store, before) = erases(playing_old());
    let (_, mut update) = Update::open(&mut store);
    let mut refused = 0;
    for crc in 0..1000 {
        say(&mut update, &line(&Request::Begin(ClipInfo { crc, ..info(NEW) })));
        let data = Request::Data { id: crc, offset: 0, bytes: &NEW[..BLOCK_BYTES] };
        let answers = say(&mut update, &line(&data)).answers;
        refused += u32::from(answers == [Response::Refused { id: crc, refusal: Refusal::TooManyStarts }]);
    }
    let (store, after) = erases(store);
    assert_eq!((after - before, refused), (u32::from(MAX_STARTS), 1000 - u32::from(MAX_STARTS)));
    goes_on(store);
}

#[test]
fn letters_go_through_between_packets_and_nothing_of_a_packet_does() {
    let mut store = playing_old();
    let (_, mut update) = Update::open(&mut store);
    let messages = requests(NEW, &info(NEW));
    let bytes = [b"r+", &line(&messages[0])[..], b"n", &line(&messages[1])[..], b"\n"].concat();
    let said = say(&mut update, &bytes);
    assert_eq!((said.keys.as_slice(), said.answers.len()), (&b"r+n\n"[..], 2));
    // A zero in its midst: the rest is nothing, until the next packet.
    let mut damaged = line(&messages[2]);
    damaged[100] = 0;
    assert!(say(&mut update, &damaged).keys.is_empty());
    let said = say(&mut update, &[&line(&messages[2])[..], b"v"].concat());
    assert_eq!((said.keys.as_slice(), said.answers.len()), (&b"v"[..], 1));
    // Its first zero is lost: its second byte is no letter.
    assert!(say(&mut update, &line(&messages[3])[1..]).keys.is_empty());
    // It never ends: keys come again after a silence.
    say(&mut update, &line(&messages[3])[..50]);
    (0..SILENCE_FRAMES).for_each(|_| update.frame_shown());
    assert_eq!(say(&mut update, b"p").keys, b"p");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn flipped_bits_never_play(flips in prop::collection::vec((0usize..4000, 0u8..8), 1..20)) {
        let mut stream = stream();
        let len = stream.len();
        flips.iter().for_each(|&(at, bit)| stream[at % len] ^= 1 << bit);
        let mut store = playing_old();
        let (_, mut update) = Update::open(&mut store);
        let sealed = say(&mut update, &stream).sealed;
        // Two flips may be of one bit.
        let whole = stream == self::stream();
        prop_assert!(sealed == whole || !sealed);
        if sealed { prop_assert!(playing(&mut store) == Some("new")) } else { goes_on(store) }
    }

    #[test]
    fn messages_in_any_order_twice_or_of_others(order in prop::collection::vec((0usize..14, 0u8..8), 0..60)) {
        let messages = requests(NEW, &info(NEW));
        let foreign = ClipInfo { crc: 7, ..info(NEW) };
        let others = requests(OLD, &foreign);
        let mut store = playing_old();
        let (_, mut update) = Update::open(&mut store);
        let mut sealed = false;
        for (which, kind) in order {
            let list = if kind == 0 { &others } else { &messages };
            sealed |= !sealed && say(&mut update, &line(&list[which % list.len()])).sealed;
        }
        if sealed { prop_assert!(playing(&mut store) == Some("new")) } else { goes_on(store) }
    }

    #[test]
    fn any_bytes_at_all_and_then_a_transfer(noise in prop::collection::vec(any::<u8>(), 0..600)) {
        let mut store = playing_old();
        let (_, mut update) = Update::open(&mut store);
        prop_assert!(!say(&mut update, &noise).sealed);
        // The first message may be taken for the rest of what was begun.
        let messages = requests(NEW, &info(NEW));
        say(&mut update, &line(&messages[0]));
        prop_assert!(messages.iter().any(|request| say(&mut update, &line(request)).sealed));
        prop_assert!(playing(&mut store) == Some("new"));
    }

    #[test]
    fn what_is_written_is_read(id: u32, number: u32, name: String, bytes in prop::collection::vec(any::<u8>(), 1..=BLOCK_BYTES), which in 0usize..9) {
        let name = pantin_store::Name::new(&name.replace('\0', " "));
        let mut out = vec![0; 300];
        let refused = |refusal| Response::Refused { id, refusal };
        let answer = [Response::Next { id, offset: number }, Response::Done { id }, refused(Refusal::TooLong { capacity: number }),
            refused(Refusal::NotBegun), refused(Refusal::BadCrc), refused(Refusal::Clip(OpenError::UnsupportedVersion(number as u8))),
            refused(Refusal::TooBig), refused(Refusal::Flash), refused(Refusal::TooManyStarts)][which];
        let len = answer.write(3, &mut out).unwrap();
        let mut receiver = pantin_link::packet::Receiver::<{ pantin_store::message::MAX_RESPONSE }>::new();
        let read = out[..len].iter().find_map(|&byte| receiver.push(byte).and_then(|packet| Response::read(&packet)));
        prop_assert_eq!(read, Some(answer));
        let begin = Request::Begin(ClipInfo { length: number, crc: id, name });
        let request = [begin, Request::Data { id, offset: number, bytes: &bytes }, Request::End { id }][which % 3];
        let mut receiver = pantin_link::packet::Receiver::<{ pantin_store::message::MAX_REQUEST }>::new();
        let same = line(&request).into_iter().any(|byte| receiver.push(byte).is_some_and(|packet| Request::read(&packet) == Some(request)));
        // A name of no keys is called otherwise.
        prop_assert!(same || name.as_str() == "clip");
    }
}
