//! The fields in front of a motion's symbols: each rule of FORMAT.md is checked, and a clip reports what the file holds.

use super::common::varint;
use pantin::codec::crc;
use pantin::codec::layout::*;
use pantin::{ChannelState, Clip, Form, Memory, OpenError, PartialClip, Player, Progress, Stream, TooSmall};

static WALK: &[u8] = include_bytes!("../walk.ptn");

/// One of the repository's vectors; `None` where the package has none.
fn vector(name: &str) -> Option<Vec<u8>> {
    std::fs::read(format!("{}/../tests/vectors/{name}.ptn", env!("CARGO_MANIFEST_DIR"))).ok()
}

/// Bytes in blocks with their CRCs, the first of which goes on from `seed`.
fn blocks(payload: &[u8], mut seed: u16) -> Vec<u8> {
    let mut out = Vec::new();
    for block in payload.chunks(BLOCK_BYTES) {
        out.extend(block);
        out.extend(crc::update(seed, block).to_le_bytes());
        seed = crc::INITIAL;
    }
    out
}

/// A file with the rig of `WALK`, these flags beside the rig's, and a motion.
fn file(flags: u8, payload: &[u8]) -> Vec<u8> {
    let clip = Clip::new_checked(WALK).unwrap();
    let flags = flags | HAS_RIG;
    let len = payload.len() + payload.len().div_ceil(BLOCK_BYTES) * CRC_BYTES;
    let rig = &WALK[4..4 + clip.rig_len()];
    let motion = blocks(payload, crc::of_prefix(flags, len as u32));
    [&[MAGIC[0], MAGIC[1], VERSION, flags], rig, &varint(len), &motion].concat()
}

fn opens(payload: &[u8]) -> Result<(), OpenError> {
    Clip::new_checked(&file(0, payload)).map(drop)
}

#[test]
fn each_rule_of_a_head_is_checked() {
    let rates = FRAME_TIMES_NS.len() as u8;
    let head = |rate: &[u8], frames: u32, exponent: i8| [rate, &varint(frames as usize), &[exponent as u8]].concat();
    for good in [head(&[1], 1, 0), head(&[rates - 1], MAX_FRAMES, 31), head(&[1], 1, -63), head(&[0, 1, 0, 0, 0], 1, 0)] {
        assert_eq!(opens(&good), Ok(()), "{good:?}");
    }
    for bad in [
        // No time from one frame to the next: stated, and of no entry of the table.
        head(&[0, 0, 0, 0, 0], 1, 0),
        head(&[rates], 1, 0),
        head(&[255], 1, 0),
        head(&[1], 0, 0),
        head(&[1], MAX_FRAMES + 1, 0),
        head(&[1], 1, 32),
        head(&[1], 1, -64),
    ] {
        assert_eq!(opens(&bad), Err(OpenError::Malformed), "{bad:?}");
    }
}

#[test]
fn events_end_in_the_payload() {
    // A rate, ten frames, an exponent, two events: at frame 1 with id 300, at frame 3 with id 5.
    let whole = [1, 10, 0, 2, 1, 0xac, 2, 2, 5];
    let bytes = file(HAS_EVENTS, &whole);
    let clip = Clip::new_checked(&bytes).unwrap();
    let events: Vec<_> = clip.events().map(|event| (event.frame, event.id)).collect();
    assert_eq!(events, [(1, 300), (3, 5)]);
    assert_eq!((clip.head_len(), clip.event_count()), (whole.len(), 2));
    for len in 4..whole.len() {
        let cut = Clip::new_checked(&file(HAS_EVENTS, &whole[..len])).map(drop);
        assert_eq!(cut, Err(OpenError::Malformed), "{len} bytes");
    }
}

#[test]
fn bytes_follow_the_last_part_only_where_the_flags_say_so() {
    let with = |flags: u8, behind: &[u8]| {
        let bytes = [&file(flags, &[1, 10, 0]), behind].concat();
        Clip::new_checked(&bytes).map(|clip| clip.frames())
    };
    for behind in [&[0][..], &[200, 1, 7], &[255; 300]] {
        assert_eq!(with(0, behind), Err(OpenError::Malformed), "{} bytes", behind.len());
        assert_eq!(with(LOOPED, behind), Err(OpenError::Malformed), "{} bytes", behind.len());
        assert_eq!(with(HAS_SECTIONS, behind), Ok(10), "{} bytes", behind.len());
    }
    assert_eq!((with(0, &[]), with(HAS_SECTIONS, &[])), (Ok(10), Ok(10)));
}

#[test]
fn names_of_events_end_in_their_section() {
    let with_names = |names: &[u8]| {
        let names = blocks(names, crc::INITIAL);
        [file(HAS_EVENT_NAMES, &[1, 10, 0]), varint(names.len()), names].concat()
    };
    let bytes = with_names(&[1, b'a', 0, 2, b'b', b'c']);
    let clip = Clip::new_checked(&bytes).unwrap();
    assert_eq!([0, 1, 2, 3].map(|id| clip.event_name(id)), [Some("a"), None, Some("bc"), None]);
    // The last name is longer than what is left, or its length has no end.
    for wrong in [&[1, b'a', 3, b'b', b'c'][..], &[1, b'a', 0x80]] {
        assert_eq!(Clip::new_checked(&with_names(wrong)).map(drop), Err(OpenError::Truncated), "{wrong:?}");
    }
}

#[test]
fn the_parts_of_a_file_add_up_to_the_byte() {
    let (Some(names), Some(index), Some(scalars)) = (vector("event-names"), vector("index"), vector("scalars")) else { return };
    assert!(Clip::new_checked(&names).unwrap().event_names_len() > 0);
    assert!(Clip::new_checked(&index).unwrap().index_len() > 0);
    for bytes in [WALK, &names, &index, &scalars] {
        let clip = Clip::new_checked(bytes).unwrap();
        let part = |len: usize| if len > 0 { varint(len).len() + len } else { 0 };
        let parts = [clip.motion_len(), clip.index_len(), clip.event_names_len()].map(part);
        assert_eq!(4 + clip.rig_len() + parts.iter().sum::<usize>(), bytes.len());
    }
}

#[test]
fn a_clip_knows_its_form_scalars_and_names_of_events() {
    let clip = Clip::new_checked(WALK).unwrap();
    assert_eq!(clip.form(), clip.form_ref().to_form());
    assert_eq!((clip.form().rig_id(), clip.form().length_exponent()), (clip.rig().id(), clip.length_exponent()));
    let form = clip.form_ref();
    assert_eq!((form.rig_id(), form.length_exponent()), (clip.rig().id(), clip.length_exponent()));
    assert_ne!(clip.form(), Form::default());
    assert_eq!((clip.event_name(0), clip.event_id(""), clip.event_id("left_foot_down")), (None, None, None));
    let (Some(scalars), Some(names)) = (vector("scalars"), vector("event-names")) else { return };
    let clip = Clip::new_checked(&scalars).unwrap();
    for scalar in clip.rig().scalars() {
        assert!(clip.find_scalar(scalar.name()).is_some());
    }
    let clip = Clip::new_checked(&names).unwrap();
    assert_eq!([0, 1, 2].map(|id| clip.event_name(id)), [Some(pantin::LEFT_FOOT_DOWN), None, Some("été")]);
    assert!(clip.event_name(3).is_some_and(|name| name.starts_with("long long")) && clip.event_name(4).is_none());
    assert_eq!([pantin::LEFT_FOOT_DOWN, "", "été", "clap"].map(|name| clip.event_id(name)), [Some(0), None, Some(2), None]);
    assert_eq!(clip.event_names().count(), 4);
}

#[test]
fn symbols_that_may_not_all_be_there_wait_for_the_next_block() {
    // A head that ends a few bytes in front of the first block's end.
    let events = 120;
    let head = [&[1, 10, 0, events][..], &[0, 1].repeat(events.into())].concat();
    let payload = [&head[..], &[0; BLOCK_BYTES]].concat();
    let bytes = file(HAS_EVENTS, &payload);
    let clip = Clip::new_checked(&bytes).unwrap();
    assert_eq!(clip.head_len(), head.len());
    let first = bytes.len() - clip.motion_len() + BLOCK_BYTES + CRC_BYTES;
    assert_eq!(PartialClip::new(&bytes[..first]).err(), Some(OpenError::Truncated));
    assert!(PartialClip::new(&bytes).is_ok());
}

/// A head with this number of events, each of two bytes.
fn head_with_events(events: usize) -> Vec<u8> {
    [&[1, 10, 0][..], &varint(events), &[0, 1].repeat(events)].concat()
}

/// Events whose symbols begin at the last position at which a start is sure to be whole, with one block at hand: 32 bytes before its end.
const EVENTS_AT_LIMIT: usize = 110;

#[test]
fn a_partial_clip_opens_with_its_first_block() {
    for (events, opens) in [(EVENTS_AT_LIMIT - 1, true), (EVENTS_AT_LIMIT, true), (EVENTS_AT_LIMIT + 1, false)] {
        let bytes = file(HAS_EVENTS, &[&head_with_events(events)[..], &[0; BLOCK_BYTES]].concat());
        let first = bytes.len() - Clip::new_checked(&bytes).unwrap().motion_len() + BLOCK_BYTES + CRC_BYTES;
        for len in [first, first + 1, first + 100] {
            let error = (!opens).then_some(OpenError::Truncated);
            assert_eq!(PartialClip::new(&bytes[..len]).err(), error, "{events} events, {len} bytes");
        }
        assert_eq!(PartialClip::new(&bytes[..first - 1]).err(), Some(OpenError::Truncated));
    }
}

#[test]
fn events_past_the_bytes_at_hand_are_truncated_and_past_the_motion_malformed() {
    let bytes = file(HAS_EVENTS, &[&head_with_events(300)[..], &[0; BLOCK_BYTES]].concat());
    let first = bytes.len() - Clip::new_checked(&bytes).unwrap().motion_len() + BLOCK_BYTES + CRC_BYTES;
    assert_eq!(PartialClip::new(&bytes[..first]).err(), Some(OpenError::Truncated));
    assert!(PartialClip::new(&bytes).is_ok());
    let cut = file(HAS_EVENTS, &head_with_events(300)[..400]);
    assert_eq!(PartialClip::new(&cut).err(), Some(OpenError::Malformed));
}

/// Steps of a stream that is fed `bytes` up to where it needs more, fails or shows a frame.
fn streamed(bytes: &[u8]) -> Vec<Progress> {
    let rig = Clip::new_checked(WALK).unwrap().rig();
    let (mut buffer, mut states, mut values) = ([0; 2 * Stream::BUFFER], [ChannelState::NEW; 32], [0; 32]);
    let mut stream = Stream::new(rig, &mut buffer, &mut states, &mut values).unwrap();
    assert_eq!(stream.feed(bytes), bytes.len());
    let mut steps = vec![];
    loop {
        let step = stream.step();
        steps.push(step);
        if !matches!(step, Progress::Opened | Progress::Event(_)) {
            return steps;
        }
    }
}

#[test]
fn a_stream_reads_events_as_far_as_they_are_sure_to_be_whole() {
    let bytes = file(HAS_EVENTS, &[&head_with_events(EVENTS_AT_LIMIT + 9)[..], &[0; BLOCK_BYTES]].concat());
    let first = bytes.len() - Clip::new_checked(&bytes).unwrap().motion_len() + BLOCK_BYTES + CRC_BYTES;
    let steps = streamed(&bytes[..first]);
    // The last one begins at the limit.
    assert_eq!((steps.len(), steps.last()), (1 + EVENTS_AT_LIMIT + 1 + 1, Some(&Progress::NeedMore)));
}

#[test]
fn a_streams_events_end_in_the_motion() {
    let whole = [1, 10, 0, 2, 1, 0xac, 2, 2, 5];
    let steps = streamed(&file(HAS_EVENTS, &whole));
    let events: Vec<_> =
        steps.iter().filter_map(|step| if let Progress::Event(event) = step { Some(event.id) } else { None }).collect();
    assert_eq!((events, steps.last()), (vec![300, 5], Some(&Progress::Frame)));
    for len in 4..whole.len() {
        let steps = streamed(&file(HAS_EVENTS, &whole[..len]));
        assert_eq!(steps.last(), Some(&Progress::Damaged(OpenError::Malformed)), "{len} bytes");
    }
}

#[test]
fn a_stream_refuses_an_empty_motion_and_a_damaged_one() {
    let whole = file(0, &[1, 10, 0]);
    let motion = Clip::new_checked(&whole).unwrap().motion_len();
    let empty = [&whole[..whole.len() - motion - 1], &[0]].concat();
    assert_eq!(streamed(&empty), [Progress::Damaged(OpenError::Malformed)]);
    let mut damaged = whole.clone();
    *damaged.last_mut().unwrap() ^= 1;
    assert_eq!(streamed(&damaged), [Progress::Damaged(OpenError::BadCrc)]);
}

#[test]
fn a_stream_states_what_its_clip_states() {
    for (bytes, looped) in [(file(0, &[2, 10, 0]), false), (file(LOOPED, &[2, 10, 0]), true)] {
        let clip = Clip::new_checked(&bytes).unwrap();
        let (mut buffer, mut states, mut values) = ([0; Stream::BUFFER], [ChannelState::NEW; 32], [0; 32]);
        let mut stream = Stream::new(clip.rig(), &mut buffer, &mut states, &mut values).unwrap();
        assert_eq!((stream.frames(), stream.frame_time_ns(), stream.looped()), (0, 0, false));
        assert_eq!((stream.feed(&bytes), stream.step()), (bytes.len(), Progress::Opened));
        assert_eq!((stream.frames(), stream.frame_time_ns(), stream.looped()), (10, FRAME_TIMES_NS[2], looped));
    }
}

#[test]
fn finishing_checks_what_follows_the_motion() {
    let Some(bytes) = vector("event-names") else { return };
    let mut partial = PartialClip::new(&bytes).unwrap();
    assert_eq!(partial.clip().event_name(0), None);
    let mut damaged = bytes.clone();
    *damaged.last_mut().unwrap() ^= 1;
    assert_eq!(partial.finish(&bytes[..bytes.len() - 1]), Err(OpenError::Truncated));
    assert_eq!(PartialClip::new(&damaged).unwrap().finish(&damaged), Err(OpenError::BadCrc));
    assert_eq!((partial.finish(&bytes), partial.clip().event_name(0)), (Ok(()), Some(pantin::LEFT_FOOT_DOWN)));
    // A motion of which blocks were not checked.
    let long = file(HAS_EVENTS, &[&head_with_events(EVENTS_AT_LIMIT)[..], &[0; BLOCK_BYTES]].concat());
    let mut partial = PartialClip::new(&long[..long.len() - 1]).unwrap();
    assert_eq!(partial.finish(&long), Err(OpenError::BadCrc));
    assert_eq!((partial.extend(&long), partial.finish(&long)), (Ok(()), Ok(())));
}

#[test]
fn a_streams_buffer_may_be_larger_than_needed_but_not_smaller() {
    let rig = Clip::new_checked(WALK).unwrap().rig();
    let (mut buffer, mut states, mut values) = ([0; Stream::BUFFER + 1], [ChannelState::NEW; 32], [0; 32]);
    for given in [Stream::BUFFER, Stream::BUFFER + 1] {
        assert!(Stream::new(rig, &mut buffer[..given], &mut states, &mut values).is_ok());
    }
    let given = Stream::BUFFER - 1;
    let short = Stream::new(rig, &mut buffer[..given], &mut states, &mut values).map(drop);
    assert_eq!(short, Err(TooSmall { memory: Memory::Buffer, needed: Stream::BUFFER, given }));
}

#[test]
fn seeking_goes_on_from_the_files_snapshots() {
    let Some(bytes) = vector("index") else { return };
    let clip = Clip::new_checked(&bytes).unwrap();
    let (motion, index) = (clip.motion_len(), clip.index_len());
    let at = bytes.len() - index;
    let motion_end = at - varint(index).len();
    let last: [u8; 2] = bytes[motion_end - CRC_BYTES..motion_end].try_into().unwrap();
    assert!(motion_end > motion);
    let seed = pantin::codec::index_seed(u16::from_le_bytes(last), index as u32);
    let strides = bytes[at..].chunks(BLOCK_BYTES + CRC_BYTES);
    let payload: Vec<u8> = strides.flat_map(|block| &block[..block.len() - CRC_BYTES]).copied().collect();
    assert!(blocks(&payload, seed) == bytes[at..], "the CRCs of the index go on from the motion's last");
    // What the snapshots say is what a seek shows: with another value in one, another pose.
    let seeks = |bytes: &[u8]| {
        let clip = Clip::new_checked(bytes).unwrap();
        let (mut states, mut values) = (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()]);
        let mut player = Player::new(clip, &mut states, &mut values).unwrap();
        let mut poses = Vec::new();
        for frame in (0..clip.frames()).rev() {
            player.seek(frame);
            poses.push(player.pose().values.to_vec());
        }
        poses
    };
    let mut other = payload.clone();
    let end = other.len() - 3;
    other[end] ^= 0x10;
    let lie = [&bytes[..at], &blocks(&other, seed)].concat();
    assert_ne!(seeks(&lie), seeks(&bytes));
}

#[test]
fn a_slow_clock_loses_no_part_of_a_nanosecond() {
    // A thousand frames of 100 ns.
    let bytes = file(0, &[&[0, 100, 0, 0, 0][..], &varint(1000), &[0]].concat());
    let mut clock = pantin::Clock::new(&Clip::new_checked(&bytes).unwrap());
    clock.set_speed(fixed::types::I16F16::DELTA);
    // 2^16 times a microsecond at 2^-16 of the speed.
    (0..1 << 16).for_each(|_| clock.advance(1));
    assert_eq!(clock.frame(), 10);
}

#[test]
fn a_form_is_what_it_is_made_of() {
    let form = Form::new(7, -3, [1, 0, 2, 0]);
    assert_eq!((form.rig_id(), form.length_exponent()), (7, -3));
    assert!(form.exponentials().take(4).eq([1, 0, 2, 0]) && form.exponentials().skip(4).all(|byte| byte == 0));
    // A bit for each joint with a choice, in whole words.
    let bits = 8 * Form::EXPONENTIAL_BYTES;
    assert!((MAX_CHANNELS / 3..MAX_CHANNELS / 3 + 32).contains(&bits) && form.exponentials().count() == bits / 8);
}
