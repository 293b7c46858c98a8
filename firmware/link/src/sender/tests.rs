use super::*;
use crate::packet::Receiver;
use crate::{Channel, Link, PACKET};
use pantin::Clip;

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
        }) && link.exact() <= self.source.starts.len()
    }
}

/// Plays what `line` makes of the departures, a call of `each` a frame.
fn play(
    departures: impl Iterator<Item = Departure>,
    (source, line): (&Source, Line),
    mut damage: impl FnMut(&mut Vec<u8>),
    mut each: impl FnMut(f64, &Link<64>),
) {
    let channels = usize::from(source.head.channels);
    let (mut states, mut pose) = (vec![Channel::default(); channels], vec![0; channels]);
    let mut link = Link::<64>::new(source.head.rig, &mut states, &mut pose);
    let mut receiver = Receiver::<PACKET>::new();
    let frame = f64::from(source.head.frame_time_ns) / 1e9;
    let mut clock = None;
    for mut departure in departures {
        let there = departure.at + departure.bytes.len() as f64 / line.rate;
        let clock = clock.get_or_insert(departure.at);
        while *clock + frame <= there {
            *clock += frame;
            link.step();
            each(*clock, &link);
        }
        damage(&mut departure.bytes);
        for byte in departure.bytes {
            if let Some(packet) = receiver.push(byte) {
                link.take(&packet).expect("the rig is its own");
            }
        }
    }
    for _ in 0..300 {
        link.step();
        each(f64::MAX, &link);
    }
}

fn line(source: &Source, rate: f64) -> Line {
    let ahead = (1e9 / f64::from(source.head.frame_time_ns)) as u32;
    Line { rate, ahead, share: 1.0, cycle: 4 }.fitted(source).expect("it fits")
}

#[test]
fn without_loss_every_frame_is_what_was_sent() {
    for bytes in CLIPS {
        let source = source(bytes);
        let line = line(&source, 20_000.0);
        let states = source.played(line.cycle);
        let played = Played { source: &source, states };
        let mut sender = Sender::new(7);
        let mut frames = vec![0; source.frames() as usize];
        play(sender.clip(&source, line, Some(2)), (&source, line), |_| {}, |_, link| {
            assert!(played.agrees(link));
            if let Some(frame) = link.frame() {
                assert!(link.synced(), "frame {frame}: {} of {}", link.exact(), link.channels().len());
                frames[frame as usize] += 1;
            }
        });
        assert!(frames[1..].iter().all(|&times| times >= 1), "{frames:?}");
        assert!(source.deviation(line.cycle).0 < 0.25, "{:?}", source.deviation(line.cycle));
    }
}
