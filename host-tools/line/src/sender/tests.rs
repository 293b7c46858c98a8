use super::*;
use pantin::Clip;
use pantin_link::packet::Receiver;
use pantin_link::{Channel, EventQueue, LineEvent, Link, MAX_PACKET};
use proptest::prelude::*;

const CLIPS: [&[u8]; 5] = [
    include_bytes!("../../../../tests/vectors/walk.ptn"),
    include_bytes!("../../../../tests/vectors/followers.ptn"),
    include_bytes!("../../../../tests/vectors/run-fine.ptn"),
    include_bytes!("../../../../tests/vectors/quaternion.ptn"),
    include_bytes!("../../../../motions/greet.ptn"),
];

fn source(bytes: &[u8]) -> Source {
    Source::new(&Clip::new_checked(bytes).expect("a clip")).expect("fit to be sent")
}

/// A receiver that is played beside what it should have.
struct Played<'s> {
    source: &'s Source,
    states: Vec<(u16, Vec<[i32; 4]>)>,
}

impl Played<'_> {
    /// Whether every channel that says it is exact is.
    fn agrees<const Q: usize>(&self, link: &Link<Q>) -> bool {
        let Some(frame) = link.frame() else { return true };
        self.states.iter().all(|(channel, states)| {
            link.channels()[usize::from(*channel)].state().is_none_or(|state| state == states[frame as usize])
        }) && link.exact_channels() <= self.source.starts.len()
    }
}

/// Plays what `line` makes of the timed_packets, a call of `each` a frame.
fn play(
    timed_packets: impl Iterator<Item = TimedPacket>,
    (source, line): (&Source, LineSettings),
    mut each: impl FnMut(f64, &Link<64>),
) {
    let channels = usize::from(source.head.channels);
    let (mut states, mut pose) = (vec![Channel::default(); channels], vec![0; channels]);
    let mut link = Link::<64>::new(source.head.form, &mut states, &mut pose);
    let mut receiver = Receiver::<MAX_PACKET>::new();
    let frame = f64::from(source.head.frame_time_ns) / 1e9;
    let mut clock = None;
    for timed in timed_packets {
        let there = timed.at + timed.bytes.len() as f64 / line.rate;
        let clock = clock.get_or_insert(timed.at);
        while *clock + frame <= there {
            *clock += frame;
            link.step();
            each(*clock, &link);
        }
        for byte in timed.bytes {
            if let Some(packet) = receiver.push(byte) {
                link.receive(&packet).expect("the rig is its own");
            }
        }
    }
    for _ in 0..300 {
        link.step();
        each(f64::MAX, &link);
    }
}

fn line(source: &Source, rate: f64) -> LineSettings {
    let ahead = (1e9 / f64::from(source.head.frame_time_ns)) as u32;
    LineSettings { rate, ahead, share: 1.0, cycle: 4, parity: false, key: None }.fitted(source).expect("it fits")
}

#[test]
fn events_are_heard_at_their_frames_although_packets_are_lost() {
    let source = source(include_bytes!("../../../../tests/vectors/event-names.ptn"));
    assert_eq!(source.events.len(), 5);
    let line = line(&source, 3840.0);
    let short = |name: &str| LineEvent::new(0, 0, name).name().unwrap_or_default().to_owned();
    // All first copies are lost, or all second ones.
    for lost in [None, Some(true), Some(false)] {
        let (mut states, mut pose) = (vec![Channel::default(); source.channels()], vec![0; source.channels()]);
        let mut link = Link::<64>::new(source.form(), &mut states, &mut pose);
        let mut receiver = Receiver::<MAX_PACKET>::new();
        let (mut queue, mut heard, mut count) = (EventQueue::default(), vec![], 0);
        let (mut clock, mut seen) = (None, std::collections::HashSet::new());
        let packets: Vec<TimedPacket> = Sender::new(9).clip(&source, line, Some(2)).collect();
        let end = packets.last().expect("packets").at + 2.0 * source.seconds() + 2.0;
        let idle = TimedPacket { at: end, bytes: vec![] };
        for timed in packets.into_iter().chain([idle]) {
            let clock = clock.get_or_insert(timed.at);
            while *clock + source.frame_seconds() <= timed.at {
                *clock += source.frame_seconds();
                link.step();
                while let Some(event) = link.now().and_then(|now| queue.take(now)) {
                    heard.push((link.now().unwrap() - BEGIN, event.id, event.name().unwrap_or_default().to_owned()));
                }
            }
            for byte in timed.bytes {
                let Some(packet) = receiver.push(byte) else { continue };
                link.receive(&packet).expect("the rig is its own");
                let event = link.head().and_then(|head| LineEvent::read(&packet, head));
                if let Some(event) = event {
                    count += 1;
                    let first = seen.insert((event.frame, event.id));
                    if lost.is_none_or(|lost| first != lost) {
                        queue.push(event, link.now().unwrap_or(BEGIN - 1));
                    }
                }
            }
        }
        let frames = source.frames();
        let mut expected: Vec<(u32, u32, String)> = (0..2)
            .flat_map(|round| source.events.iter().map(move |(frame, id, name)| (round * frames + frame, *id, short(name))))
            .collect();
        heard.sort();
        expected.sort();
        assert_eq!(heard, expected, "{lost:?}");
        assert_eq!((count, link.counts().missing, link.counts().rejected), (4 * source.events.len(), 0, 0));
    }
}

/// A wave that is never still, and a step.
fn made(frame: usize, channel: usize) -> i32 {
    let wave = (f64::from(frame as u32) / (3.0 + channel as f64)).sin() * 5e8;
    if channel == 0 { if (frame / 40).is_multiple_of(2) { 0 } else { 1 << 30 } } else { wave as i32 }
}

#[test]
fn what_is_made_now_is_there_within_its_bound_after_the_delay() {
    let making = [LiveChannel { bound: 1 << 25, way: 1 << 30, wraps: false }; 8];
    let source = Source::live(pantin::Form::default(), 33_333_333, &making);
    let line = LineSettings { rate: 960.0, ahead: 6, share: 1.0, cycle: 24, parity: false, key: None };
    let mut live = Sender::new(5).live(&source, line, LiveTiming::FACE, &making);
    let (mut states, mut pose) = ([Channel::default(); 8], [0; 8]);
    let mut link = Link::<24>::new(source.form(), &mut states, &mut pose);
    let mut receiver = Receiver::<MAX_PACKET>::new();
    let (mut late, mut worst) = (0, 0);
    for frame in 0..600 {
        let pose: Vec<i32> = (0..8).map(|channel| made(frame, channel)).collect();
        for byte in live.push(&pose).into_iter().flat_map(|timed| timed.bytes) {
            if let Some(packet) = receiver.push(byte) {
                link.receive(&packet).expect("its own form");
            }
        }
        link.step();
        if frame > 60 {
            assert!(link.is_synced(), "frame {frame}: {} exact", link.exact_channels());
            let shown = link.frame().expect("it plays") as usize;
            late = late.max(frame - shown);
            let off = (1..8).map(|channel| i64::from(link.pose().values[channel]) - i64::from(made(shown, channel)));
            worst = worst.max(off.map(i64::abs).max().unwrap_or(0));
        }
    }
    assert_eq!(live.omitted_messages(), 0);
    assert!(late <= LiveTiming::FACE.delay(&line) as usize + 2, "{late}");
    assert!(worst <= (1 << 25) + (1 << 22), "{worst}");
}

/// A body of 16 joints that moves all of its angles, one of them around and around, over a line of 38,400 baud in simulated time: it is shown within
/// 150 ms, exact, within its bound.
#[test]
fn a_body_that_is_made_now_is_shown_within_150_ms() {
    const CHANNELS: usize = 48;
    const SECONDS_A_FRAME: f64 = 1.0 / 60.0;
    let degrees = |degrees: f64| (degrees / 360.0 * 32f64.exp2()).round() as i64 as i32;
    let angle = |frame: usize, channel: usize| {
        let time = frame as f64 * SECONDS_A_FRAME;
        degrees(if channel == 0 { 90.0 * time } else { 40.0 * (time * (1.0 + channel as f64 / 8.0)).sin() })
    };
    let making = [LiveChannel { bound: degrees(1.0), way: 1 << 31, wraps: true }; CHANNELS];
    let source = Source::live(pantin::Form::default(), 16_666_667, &making);
    let line = LineSettings { rate: 3840.0, ahead: 2, share: 1.0, cycle: 60, parity: false, key: None };
    let mut live = Sender::new(5).live(&source, line, LiveTiming::BODY, &making);
    let (mut states, mut pose) = ([Channel::default(); CHANNELS], [0; CHANNELS]);
    let mut link = Link::<24>::new(source.form(), &mut states, &mut pose);
    let mut receiver = Receiver::<MAX_PACKET>::new();
    let (mut late, mut worst, mut synced) = (0, 0, 0);
    let mut on_line: Vec<(f64, Vec<u8>)> = Vec::new();
    for frame in 0..1200 {
        let pose: Vec<i32> = (0..CHANNELS).map(|channel| angle(frame, channel)).collect();
        for timed in live.push(&pose) {
            on_line.push((timed.at + timed.bytes.len() as f64 / line.rate, timed.bytes));
        }
        let now = (frame as f64 + 1.0 - f64::from(LiveTiming::BODY.delay(&line))) * SECONDS_A_FRAME;
        while on_line.first().is_some_and(|(there, _)| *there <= now) {
            for byte in on_line.remove(0).1 {
                if let Some(packet) = receiver.push(byte) {
                    link.receive(&packet).expect("its own form");
                }
            }
        }
        link.step();
        if frame > 180 {
            synced += usize::from(link.is_synced());
            let shown = link.frame().expect("it plays") as usize;
            late = late.max(frame - shown);
            let off = |channel: usize| i64::from(link.pose().values[channel].wrapping_sub(angle(shown, channel))).abs();
            worst = worst.max((0..CHANNELS).map(off).max().unwrap_or(0));
        }
    }
    let (rate, milliseconds) = (live.bytes().line / 20.0, 1e3 * late as f64 * SECONDS_A_FRAME);
    println!(
        "{late} frames, {milliseconds:.0} ms; {rate:.0} bytes a second; {synced} frames exact, {} omitted; off by {:.2} degrees",
        live.omitted_messages(),
        worst as f64 / f64::from(degrees(1.0))
    );
    assert_eq!((live.omitted_messages(), synced), (0, 1200 - 181));
    assert!(milliseconds <= 150.0, "{milliseconds} ms");
    assert!(worst <= i64::from(degrees(1.1)), "{worst}");
}

#[test]
fn without_loss_every_frame_is_what_was_sent() {
    for bytes in CLIPS {
        let source = source(bytes);
        let line = line(&source, 20_000.0);
        let states = source.expected_states(line.cycle);
        let played = Played { source: &source, states };
        let mut sender = Sender::new(7);
        let mut frames = vec![0; source.frames() as usize];
        play(sender.clip(&source, line, Some(2)), (&source, line), |_, link| {
            assert!(played.agrees(link));
            if let Some(frame) = link.frame() {
                assert!(link.is_synced(), "frame {frame}: {} of {}", link.exact_channels(), link.channels().len());
                frames[frame as usize] += 1;
            }
        });
        assert!(frames.iter().all(|&times| times >= 1), "{frames:?}");
        assert!(source.deviation(line.cycle).0 < 0.25, "{:?}", source.deviation(line.cycle));
    }
}

/// Pushes bytes into a receiver.
fn hear<const Q: usize>(link: &mut Link<Q>, receiver: &mut Receiver<MAX_PACKET>, bytes: &[u8]) {
    for &byte in bytes {
        if let Some(packet) = receiver.push(byte) {
            link.receive(&packet).expect("its own form");
        }
    }
}

#[test]
fn a_sender_that_stalls_makes_time_stand_still_and_loses_nothing() {
    let source = source(CLIPS[0]);
    let line = line(&source, 20_000.0);
    let (mut states, mut pose) = (vec![Channel::default(); source.channels()], vec![0; source.channels()]);
    let mut link = Link::<24>::new(source.form(), &mut states, &mut pose);
    let mut receiver = Receiver::new();
    let sent: Vec<TimedPacket> = Sender::new(7).clip(&source, line, Some(1)).collect();
    let (first, rest) = sent.split_at(sent.len() / 2);
    for timed in first {
        hear(&mut link, &mut receiver, &timed.bytes);
        (0..4).for_each(|_| link.step());
    }
    (0..200).for_each(|_| link.step());
    let (now, drawn) = (link.now(), link.pose().values.to_vec());
    (0..200).for_each(|_| link.step());
    assert_eq!((link.now(), link.pose().values), (now, &drawn[..]), "it stands");
    assert!(link.is_synced() && link.counts().desyncs == 0);
    for timed in rest {
        hear(&mut link, &mut receiver, &timed.bytes);
        (0..4).for_each(|_| link.step());
        assert!(link.is_synced());
    }
    (0..200).for_each(|_| link.step());
    assert_eq!((link.frame(), link.counts().desyncs), (Some(source.frames() - 1), 0));
}

#[test]
fn after_a_stall_packets_are_ahead_of_their_time_again() {
    let source = source(CLIPS[0]);
    let line = line(&source, 20_000.0);
    let (mut states, mut pose) = (vec![Channel::default(); source.channels()], vec![0; source.channels()]);
    let mut link = Link::<24>::new(source.form(), &mut states, &mut pose);
    let mut receiver = Receiver::new();
    let sent: Vec<TimedPacket> = Sender::new(7).clip(&source, line, Some(6)).collect();
    let (mut clock, mut halted) = (sent[0].at, 0);
    for (index, timed) in sent.iter().enumerate() {
        if index == sent.len() / 3 {
            (0..500).for_each(|_| link.step());
        }
        while clock < timed.at {
            clock += source.frame_seconds();
            let before = link.now();
            link.step();
            halted += u32::from(index > sent.len() * 2 / 3 && link.now() == before);
        }
        hear(&mut link, &mut receiver, &timed.bytes);
    }
    assert_eq!(halted, 0, "frames on which time stood still");
    let behind =
        sent.last().map_or(0.0, |last| last.at / source.frame_seconds()) as i64 - i64::from(link.now().unwrap_or(0) - BEGIN);
    assert!((-4..=8).contains(&behind), "{behind}");
}

#[test]
fn a_flood_is_counted_and_recovered_from() {
    let source = source(CLIPS[0]);
    let line = line(&source, 20_000.0);
    let played = Played { source: &source, states: source.expected_states(line.cycle) };
    let (mut states, mut pose) = (vec![Channel::default(); source.channels()], vec![0; source.channels()]);
    let mut link = Link::<24>::new(source.form(), &mut states, &mut pose);
    let mut receiver = Receiver::new();
    let sent: Vec<TimedPacket> = Sender::new(7).clip(&source, line, Some(4)).collect();
    let (flood, rest) = sent.split_at(sent.len() / 3);
    // A third of all at once, then the others in their time.
    flood.iter().for_each(|timed| hear(&mut link, &mut receiver, &timed.bytes));
    assert!(link.counts().dropped > 0);
    let (mut clock, mut synced) = (rest[0].at, 0);
    for timed in rest {
        while clock < timed.at {
            clock += source.frame_seconds();
            link.step();
            assert!(played.agrees(&link));
            synced += u32::from(link.is_synced());
        }
        hear(&mut link, &mut receiver, &timed.bytes);
    }
    assert!(synced > source.frames(), "{synced} frames were exact");
}

#[test]
fn memory_is_what_is_stated() {
    assert_eq!(core::mem::size_of::<Channel>(), 36);
}

/// What may happen to a packet on its way.
#[derive(Clone, Debug)]
enum Fate {
    Lost,
    Flipped(usize, u8),
    Cut(usize),
    Twice,
    /// The packet arrives after this number of later ones.
    Later(usize),
    /// The packet that was sent this number of packets ago arrives instead.
    Replayed(usize),
    Foreign,
    Noise(Vec<u8>),
}

fn fate() -> impl Strategy<Value = Fate> {
    prop_oneof![
        4 => Just(Fate::Lost),
        2 => (0..100usize, 1..=255u8).prop_map(|(at, mask)| Fate::Flipped(at, mask)),
        1 => (0..100usize).prop_map(Fate::Cut),
        1 => Just(Fate::Twice),
        1 => (1..5usize).prop_map(Fate::Later),
        1 => (1..200usize).prop_map(Fate::Replayed),
        1 => Just(Fate::Foreign),
        1 => prop::collection::vec(any::<u8>(), 0..200).prop_map(Fate::Noise),
    ]
}

/// The packets of two rounds, as these fates leave them, and the frame of the last one that was touched.
fn fated(source: &Source, line: LineSettings, fates: &[(usize, Fate)]) -> (Vec<TimedPacket>, f64) {
    let sent: Vec<TimedPacket> = Sender::new(7).clip(source, line, Some(2)).collect();
    let foreign: Vec<TimedPacket> = Sender::new(8).clip(source, line, Some(2)).collect();
    let mut came: Vec<(f64, TimedPacket)> = sent.iter().enumerate().map(|(i, timed)| (i as f64, timed.clone())).collect();
    let mut last = 0.0f64;
    for (at, fate) in fates {
        let at = at % sent.len();
        let bytes = &mut came[at].1.bytes;
        last = last.max(sent[at].at);
        match fate {
            Fate::Lost => bytes.clear(),
            Fate::Flipped(byte, mask) => {
                let len = bytes.len();
                if len > 0 {
                    bytes[byte % len] ^= mask;
                }
            }
            Fate::Cut(len) => bytes.truncate(*len),
            Fate::Twice => *bytes = [sent[at].bytes.clone(), vec![0], sent[at].bytes.clone()].concat(),
            Fate::Later(places) => came[at].0 = (at + places) as f64 + 0.5,
            Fate::Replayed(ago) => *bytes = sent[at.saturating_sub(*ago)].bytes.clone(),
            Fate::Foreign => *bytes = foreign[at].bytes.clone(),
            Fate::Noise(noise) => bytes.extend(noise),
        }
    }
    came.sort_by(|a, b| a.0.total_cmp(&b.0));
    let times: Vec<f64> = sent.iter().map(|timed| timed.at).collect();
    let came = came.into_iter().zip(times).map(|((_, timed), at)| TimedPacket { at, ..timed });
    (came.collect(), last)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn whatever_happens_to_packets_what_is_said_to_be_exact_is(
        clip in 0..CLIPS.len(),
        fates in prop::collection::vec((0..1000usize, fate()), 0..60),
    ) {
        let source = source(CLIPS[clip]);
        let line = line(&source, 20_000.0);
        let played = Played { source: &source, states: source.expected_states(line.cycle) };
        let (came, _) = fated(&source, line, &fates);
        let mut drawn: Option<Vec<i32>> = None;
        let (mut met, mut session) = (vec![false; source.starts.len()], 7);
        play(came.into_iter(), (&source, line), |_, link| {
            let own = link.head().map_or(session, |head| head.session);
            if own != session {
                (session, drawn) = (own, None);
                met.fill(false);
            }
            assert!(played.agrees(link));
            // No joint is drawn faster than its pace.
            if let Some(before) = drawn.replace(link.pose().values.to_vec()) {
                for (track, start) in source.starts.iter().enumerate() {
                    if let pantin_link::ChannelKind::Moving { pace, .. } = start {
                        let moved = link.pose().values[track].wrapping_sub(before[track]).unsigned_abs();
                        // A channel that was described again in between, for another clip, restarts too.
                        let keeps = link.channels()[track].has_joined();
                        assert!(!(met[track] && keeps) || moved <= pantin_link::pace(*pace).unsigned_abs(), "channel {track}: {moved}");
                        met[track] = keeps;
                    }
                }
            }
        });
    }

    #[test]
    fn all_is_exact_a_cycle_after_the_last_loss_and_drawn_half_a_second_later(
        clip in 0..CLIPS.len(),
        first in 0.1..0.6f64,
        lost in prop::collection::vec(0..100u8, 1..60),
    ) {
        let source = source(CLIPS[clip]);
        let line = line(&source, 20_000.0);
        let mut sent: Vec<TimedPacket> = Sender::new(7).clip(&source, line, Some(3)).collect();
        let begin = (sent.len() as f64 * first) as usize;
        let mut last = 0u32;
        for (timed, lost) in sent[begin..].iter_mut().zip(lost) {
            if lost < 50 {
                let mut receiver = Receiver::<MAX_PACKET>::new();
                let packet = timed.bytes.iter().find_map(|&byte| receiver.push(byte).map(|packet| (packet.kind, packet.payload.to_vec())));
                if let Some((pantin_link::packet::kind::MOTION, payload)) = packet {
                    let mut messages = pantin_link::Messages::new(&payload);
                    messages.by_ref().for_each(drop);
                    last = last.max(u32::from(messages.frame()));
                    timed.bytes.clear();
                }
            }
        }
        let half = 500_000_000 / source.head.frame_time_ns;
        let end = BEGIN + 3 * source.frames();
        play(sent.into_iter(), (&source, line), |_, link| {
            let Some(now) = link.now().filter(|&now| last > 0 && now > last + line.cycle && now + 1 < end) else { return };
            assert!(link.is_synced(), "{now}: {} of {}, last {last}, cycle {}", link.exact_channels(), link.channels().len(), line.cycle);
            if now > last + line.cycle + half {
                let apart = link.channels().iter().zip(link.pose().values).position(|(channel, &drawn)| channel.state().is_some_and(|state| state[0] != drawn));
                assert!(apart.is_none() || (now - BEGIN) % source.frames() < half, "{now} {apart:?}");
            }
        });
    }
}

#[test]
fn the_bytes_on_the_line_stay_the_same() {
    let sent = |(bytes, parity)| {
        let source = source(bytes);
        let line = LineSettings { parity, ..line(&source, 20_000.0) };
        let sent: Vec<u8> = Sender::new(7).clip(&source, line, Some(2)).flat_map(|timed| timed.bytes).collect();
        (sent.len(), pantin::codec::crc::of(&sent))
    };
    // Of clips that stay as they are. A packet has the rig's id in it.
    let expected = [(15342, 6192), (16377, 16046), (4712, 39433)];
    assert_eq!([(CLIPS[0], false), (CLIPS[0], true), (CLIPS[2], false)].map(sent), expected);
}

/// Plays nine rounds in real time, with the packets that `forge` puts before a genuine one; returns the longest time without a new frame, and the last
/// frame at which a channel was not exact, both in frames after the first forged packet.
fn disturbed(forge: impl Fn(usize, &[TimedPacket]) -> Vec<TimedPacket>) -> (u32, u32) {
    let source = source(CLIPS[0]);
    let line = line(&source, 20_000.0);
    let expected = Played { source: &source, states: source.expected_states(line.cycle) };
    let (mut states, mut pose) = (vec![Channel::default(); source.channels()], vec![0; source.channels()]);
    let mut link = Link::<24>::new(source.form(), &mut states, &mut pose);
    let mut receiver = Receiver::new();
    let sent: Vec<TimedPacket> = Sender::new(7).clip(&source, line, Some(9)).collect();
    let (mut clock, mut frames, mut held, mut longest, mut last) = (sent[0].at, 0, 0, 0, 0);
    for (index, timed) in sent.iter().enumerate() {
        while clock < timed.at {
            clock += source.frame_seconds();
            let before = link.now();
            link.step();
            assert!(expected.agrees(&link));
            if index > sent.len() / 4 {
                frames += 1;
                held = if link.now() == before { held + 1 } else { 0 };
                longest = longest.max(held);
                last = if link.is_synced() { last } else { frames };
            }
        }
        forge(index, &sent).iter().for_each(|forged| hear(&mut link, &mut receiver, &forged.bytes));
        hear(&mut link, &mut receiver, &timed.bytes);
    }
    println!("time stood still for {longest} frames, exact again after {last} of {frames}");
    (longest, last)
}

#[test]
fn a_packet_from_far_ahead_neither_stops_time_nor_costs_a_state() {
    for ahead in [60, 200, 300] {
        let one = |index: usize, sent: &[TimedPacket]| {
            if index == sent.len() / 4 + 1 { sent[index + ahead..=index + ahead].to_vec() } else { vec![] }
        };
        assert_eq!(disturbed(one), (0, 0), "{ahead} packets ahead");
    }
}

#[test]
fn packets_from_elsewhere_that_are_fewer_than_the_genuine_ones_change_nothing() {
    let every_third = |index: usize, sent: &[TimedPacket]| {
        let from = sent.len() / 4..sent.len() / 2;
        if from.contains(&index) && index.is_multiple_of(3) { sent[index + 300..=index + 300].to_vec() } else { vec![] }
    };
    assert_eq!(disturbed(every_third), (0, 0));
}

#[test]
fn a_receiver_that_was_led_astray_comes_back_to_the_genuine_clock() {
    let many = |index: usize, sent: &[TimedPacket]| {
        if index == sent.len() / 4 + 1 { sent[index + 300..index + 320].to_vec() } else { vec![] }
    };
    let (held, last) = disturbed(many);
    assert!(held <= 8 && last < 100, "{held} {last}");
}
