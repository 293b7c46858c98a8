//! Vectors made of noise and of edges: together they hold every feature of the format, which [`super::coverage`] counts.

use anyhow::Result;
use pantin::codec::layout::{FIRST_STEP, GROUPS, HAS_SECTIONS, MAX_STEP, START_MODE, STEP_CHANGES, group, segment_type};
use pantin::{Event, Kind, Up};
use pantin_convert::Memory;
use pantin_convert::encode::clip::{self, Channel, Coded, Start};
use pantin_convert::encode::rig;
use pantin_convert::encode::segment::Segment;
use pantin_convert::motion::{Joint, Rig, Scalar};

use super::Vector;
use hostile::noise::Noise;

/// A motion of noise, and its figure.
pub struct Made {
    /// Name of the vector.
    pub name: &'static str,
    /// Its figure.
    pub rig: Rig,
    /// Its motion.
    pub coded: Coded,
    /// Whether the rig stands apart.
    pub apart: bool,
    /// Frames from one snapshot of its index to the next; 0 for none.
    pub index: u32,
    /// Sections behind the clip, which this version does not define.
    pub sections: &'static [u8],
}

impl Made {
    /// The files.
    pub fn vector(&self) -> Result<Vector> {
        let rig = rig::encode(&self.rig)?;
        let mut clip = match self.index {
            0 => clip::encode(&self.coded, &rig, self.apart)?,
            spacing => clip::encode_with_index(&self.coded, &rig, self.apart, spacing, Memory::default())?,
        };
        if !self.sections.is_empty() {
            clip[3] |= HAS_SECTIONS;
            clip.extend_from_slice(self.sections);
            // The CRC covers the flags.
            hostile::fix::clip(&mut clip);
        }
        Ok(Vector { name: self.name.into(), clip, rig: self.apart.then_some(rig) })
    }
}

const EULER: [Kind; 3] = [Kind::Zrotation, Kind::Xrotation, Kind::Yrotation];
const PLACE: [Kind; 3] = [Kind::Xposition, Kind::Yposition, Kind::Zposition];
const QUATERNION: [Kind; 4] = [Kind::Wquaternion, Kind::Xquaternion, Kind::Yquaternion, Kind::Zquaternion];
const EXPONENTIAL: [Kind; 3] = [Kind::Xexponential, Kind::Yexponential, Kind::Zexponential];

/// A chain of joints with these channels, one unit of 1 cm apart, and as many scalars.
pub fn figure(joints: &[&[Kind]], scalars: usize) -> Rig {
    let joint = |(index, kinds): (usize, &&[Kind])| Joint {
        name: format!("j{index}"),
        parent: index.checked_sub(1),
        offset: [0.0, if index == 0 { 0.0 } else { -10.5 }, 0.25 * index as f64],
        kinds: kinds.to_vec(),
        end_site: false,
        helper: false,
    };
    Rig {
        joints: joints.iter().enumerate().map(joint).collect(),
        scalars: (0..scalars).map(|index| Scalar { name: format!("s{index}"), full_scale: 1.0 }).collect(),
        cm_per_unit: 1.0,
        up: Up::Y,
    }
}

/// A motion without channels yet, 30 frames a second.
fn motion(frames: u32) -> Coded {
    Coded {
        frames,
        frame_time_ns: 33_333_333,
        length_exponent: -16,
        exponentials: vec![],
        channels: vec![],
        events: vec![],
        event_names: vec![],
        looped: false,
    }
}

fn moving(p: i32, v: i32, step: u8) -> Start {
    Start::Moving { p, v, step }
}

fn constant(p: i32, step: u8) -> Start {
    Start::Constant { p, step }
}

/// A segment of this mode with small numbers where it has any.
fn small(mode: u8, noise: &mut Noise) -> Segment {
    let kind = mode >> 4;
    let mut number = |has: bool| if has { noise.between(-9, 9) } else { 0 };
    Segment {
        mode,
        w: number(matches!(kind, segment_type::W | segment_type::WK)),
        k: number(matches!(kind, segment_type::K | segment_type::WK)),
    }
}

/// Segments until no other may start: the last two frames start none.
fn fill(frames: u32, mut next: impl FnMut() -> Segment) -> Vec<Segment> {
    let mut segments = vec![];
    let mut frame = 0;
    while frame + 2 < frames as usize {
        segments.push(next());
        frame += segments.last().map_or(1, Segment::length);
    }
    segments
}

fn lively(frames: u32, start: Start, noise: &mut Noise) -> Channel {
    let segments = fill(frames, || {
        let mode = noise.below(4) as u8 * 16 + noise.below(10) as u8;
        small(mode, noise)
    });
    Channel { start, segments }
}

/// Every channel of `rig` moves by noise.
fn alive(rig: &Rig, coded: &mut Coded, noise: &mut Noise) {
    for (_, kind) in rig.channel_kinds() {
        let step = if kind.is_position() { 18 } else { 42 } + noise.below(5) as u8;
        let start = moving(noise.between(-300, 300), noise.between(-40, 40), step);
        coded.channels.push(lively(coded.frames, start, noise));
    }
}

/// A clip in which every channel of `rig` moves by noise, whose bytes grow with its length as no motion's do.
pub fn noisy(rig: &Rig, frames: u32) -> Result<Vec<u8>> {
    let mut coded = Coded { frame_time_ns: 8_333_333, ..motion(frames) };
    alive(rig, &mut coded, &mut Noise::new(3));
    clip::encode(&coded, &rig::encode(rig)?, false)
}

fn simple(name: &'static str, joints: &[&[Kind]], scalars: usize, mut coded: Coded) -> Made {
    let rig = figure(joints, scalars);
    let seed = name.len() as u64 + u64::from(coded.frames);
    alive(&rig, &mut coded, &mut Noise::new(seed));
    Made { name, rig, coded, apart: false, index: 0, sections: &[] }
}

/// Every type with every length: six channels take the 63 modes in six orders.
fn segments() -> Made {
    let rig = figure(&[&EULER, &EULER], 0);
    let mut coded = motion(420);
    let mut noise = Noise::new(7);
    let modes: Vec<u8> = (0..START_MODE).collect();
    for channel in 0..rig.channels() {
        let mut order = modes.iter().cycle().skip(channel * modes.len() / 6 + channel % 2).step_by(11);
        let start = moving(channel as i32 * 50, 3 - channel as i32, FIRST_STEP - 6 + channel as u8);
        let segments = fill(coded.frames, || small(order.next().copied().unwrap_or(0), &mut noise));
        coded.channels.push(Channel { start, segments });
    }
    Made { name: "segments", rig, coded, apart: false, index: 0, sections: &[] }
}

/// Numbers of every size up to 2^30, of either sign, as accelerations and as slopes; values wrap.
fn numbers() -> Made {
    let rig = figure(&[], 8);
    let mut coded = motion(100);
    let mut noise = Noise::new(11);
    let mut turn = 0;
    let mut number = move || {
        turn = (turn + 7) % 38;
        let size = match turn {
            0..8 => (1 << turn) - 1,
            bits => group(GROUPS + 1) as i32 - 1 + (1 << (bits - 8)) + noise.below(1 << (bits - 8)) as i32,
        };
        if noise.below(2) == 0 { size } else { -size }
    };
    for channel in 0..rig.channels() as u8 {
        let mut turn = channel;
        let next = || {
            turn = turn.wrapping_add(1);
            let length = turn / 3 % 4;
            match turn % 3 {
                0 => Segment { mode: segment_type::W << 4 | length, w: number(), k: 0 },
                1 => Segment { mode: segment_type::K << 4 | length, w: 0, k: number() },
                _ => Segment { mode: segment_type::WK << 4 | length, w: number(), k: number() },
            }
        };
        coded.channels.push(Channel { start: moving(0, 0, 5 * channel + channel % 2), segments: fill(100, next) });
    }
    Made { name: "numbers", rig, coded, apart: false, index: 0, sections: &[] }
}

/// How channels begin: every change of step, every step, first values of every size, the least one included; resting,
/// constant and moving channels after one another.
fn starts() -> Made {
    let rig = figure(&[vec![&PLACE as &[Kind]; 12], vec![&EULER as &[Kind]; 28]].concat(), 0);
    let mut noise = Noise::new(13);
    let mut step = 30;
    let changes = (0..STEP_CHANGES as i32).map(|change| {
        step += if change % 2 == 0 { change / 2 } else { -(change + 1) / 2 };
        constant(change - 9, step as u8)
    });
    let mut starts: Vec<Start> = [constant(1, 30)].into_iter().chain(changes).collect();
    starts.extend((0..=u32::from(MAX_STEP)).map(|step| {
        // 17 and 60 have no common factor.
        let step = (step * 17 % 60) as u8;
        match noise.below(3) {
            0 => Start::Rest,
            1 => constant(noise.between(-9, 9), step),
            _ => moving(noise.between(-9, 9), noise.between(-9, 9), step),
        }
    }));
    starts.extend((0..=32).map(|bits: u32| {
        let sized = |bits: u32, sign: i32| bits.checked_sub(1).map_or(0, |bit| (1i32 << bit).wrapping_mul(sign));
        moving(sized(bits, 1 - 2 * (bits as i32 % 2)), sized((bits * 7) % 32, -1), 0)
    }));
    starts.resize(rig.channels(), Start::Rest);
    let mut coded = motion(3);
    let segments = |start: &Start| match start {
        Start::Moving { .. } => vec![Segment { mode: 0, w: 3, k: 0 }],
        _ => vec![],
    };
    coded.channels = starts.into_iter().map(|start| Channel { segments: segments(&start), start }).collect();
    Made { name: "starts", rig, coded, apart: false, index: 0, sections: &[] }
}

/// Nothing moves.
fn still() -> Made {
    let rig = figure(&[&PLACE, &EULER], 0);
    let mut coded = motion(5);
    let rest = Channel { start: Start::Rest, segments: vec![] };
    coded.channels = vec![rest; 6];
    coded.channels[1].start = constant(95, 22);
    coded.channels[5].start = constant(-33, 44);
    Made { name: "still", rig, coded, apart: false, index: 0, sections: &[] }
}

/// Twelve joints may choose, so that the bits take two bytes; every third one does.
fn exponential_choice() -> Made {
    let mut joints: Vec<&[Kind]> = vec![&EULER; 12];
    joints.insert(2, &[Kind::Xrotation]);
    let mut coded = motion(16);
    coded.exponentials = (0..12).map(|joint| joint % 3 == 1).collect();
    simple("exponential-choice", &joints, 0, coded)
}

/// The widest steps with the shortest lengths, where six steps of an acceleration do not fit 32 bits.
fn widest_steps() -> Made {
    let rig = figure(&[&EULER, &EULER], 0);
    let mut coded = motion(40);
    let mut noise = Noise::new(23);
    for step in (MAX_STEP - 5)..=MAX_STEP {
        let segments = fill(40, || {
            let mode = noise.below(2) as u8 * 16 + noise.below(2) as u8;
            small(mode, &mut noise)
        });
        coded.channels.push(Channel { start: moving(1, -1, step), segments });
    }
    Made { name: "widest-steps", rig, coded, apart: false, index: 0, sections: &[] }
}

/// Joints that rest, in a clip whose lengths are finer than the rig's; joints with six channels and with four angles beside one that
/// may choose.
fn rests_and_choices() -> Made {
    let six = [PLACE, EULER].concat();
    let four = [&EULER[..], &[Kind::Zrotation]].concat();
    let mut coded = motion(12);
    coded.length_exponent = -24;
    coded.exponentials = vec![true, false];
    let mut made = simple("rests-and-choices", &[&six, &four, &EULER, &PLACE], 0, coded);
    let rest = Channel { start: Start::Rest, segments: vec![] };
    for channel in [0, 2, 13, 14, 15] {
        made.coded.channels[channel] = rest.clone();
    }
    made
}

/// Joints with Euler angles in every order, with fewer and with more angles than three, and with several forms at once.
fn turn_orders() -> Made {
    use Kind::{Xrotation as X, Yrotation as Y, Zrotation as Z};
    let chain = [&[Y, X][..], &QUATERNION, &EXPONENTIAL].concat();
    let chosen = [&EXPONENTIAL[..], &[Z, Y, X]].concat();
    let mut coded = motion(6);
    coded.exponentials = [false, true].repeat(4);
    let orders = [[X, Y, Z], [X, Z, Y], [Y, X, Z], [Y, Z, X], [Z, X, Y], [Z, Y, X]];
    let joints =
        [&orders.each_ref().map(|order| &order[..])[..], &[&[Z], &[Y, X], &[Z, Y, Z], &[X, X], &chain, &chosen]].concat();
    simple("turn-orders", &joints, 0, coded)
}

/// Joints with Euler angles in every order, each a multiple of 45 degrees: rotations by half a turn, of whose matrix an element is -1, and those whose second
/// angle is a right angle.
fn half_turns() -> Made {
    use Kind::{Xrotation as X, Yrotation as Y, Zrotation as Z};
    let orders = [[X, Y, Z], [X, Z, Y], [Y, X, Z], [Y, Z, X], [Z, X, Y], [Z, Y, X]];
    let rig = figure(&orders.repeat(2).iter().map(|order| &order[..]).collect::<Vec<_>>(), 0);
    let mut coded = motion(8);
    coded.exponentials = vec![false; 12];
    // Of this step, a first position is in halves of 45 degrees, and a velocity in quarters of them.
    let angle = |first: i32, velocity: i32| moving(2 * ((first + 4) % 8 - 4), 4 * velocity, 58);
    let starts = (0..12).flat_map(|joint: i32| {
        // One angle is half a turn, one moves and one is 0, in each joint others; or all three move.
        let mut angles = [angle(4, 0), angle(joint / 3, 1), angle(0, 0)];
        angles.rotate_left(joint as usize % 3);
        if joint < 6 { angles } else { [angle(joint, 1), angle(2 * joint, 2), angle(3 * joint, joint % 3 + 1)] }
    });
    let coasting = || fill(8, || Segment { mode: 0, w: 0, k: 0 });
    coded.channels = starts.map(|start| Channel { start, segments: coasting() }).collect();
    Made { name: "half-turns", rig, coded, apart: false, index: 0, sections: &[] }
}

/// A loop with enough events that the fields before the first symbol cross from one block into the next.
fn events() -> Made {
    let mut coded = motion(120);
    coded.looped = true;
    let mut noise = Noise::new(17);
    let mut frame = 0;
    for id in 0..90 {
        coded.events.push(Event { frame, id: if id % 9 == 0 { u32::MAX - id } else { id * 40 } });
        frame = (frame + noise.below(3) as u32).min(119);
    }
    simple("events", &[&PLACE], 1, coded)
}

/// Events of which some have names, one of them a name of more bytes than a block, and snapshots before the names; the figure hangs along x,
/// and a joint of it with what hangs on it is no limb.
fn event_names() -> Made {
    let mut coded = motion(40);
    coded.events = [(0, 0), (7, 3), (7, 1), (30, 9), (39, 0)].map(|(frame, id)| Event { frame, id }).to_vec();
    coded.event_names = vec![pantin::LEFT_FOOT_DOWN.into(), String::new(), "\u{e9}t\u{e9}".into(), "long ".repeat(60)];
    let mut made = simple("event-names", &[&PLACE, &EULER, &EULER, &[]], 0, coded);
    made.rig.up = Up::new(0, true).unwrap_or_default();
    made.rig.joints[2].helper = true;
    made.index = 15;
    made
}

/// Two sections of types that this version does not define.
pub const SECTIONS: &[u8] = &[0, 3, 1, 2, 3, 0xff, 0];

/// Sections behind snapshots and names of events.
fn sections() -> Made {
    let mut coded = motion(24);
    coded.events = vec![Event { frame: 3, id: 0 }];
    coded.event_names = vec!["clap".into()];
    let mut made = simple("sections", &[&PLACE, &EULER], 1, coded);
    (made.index, made.sections) = (10, SECTIONS);
    made
}

/// A frame time that is no usual rate's.
fn odd_rate() -> Made {
    simple("odd-rate", &[&EULER], 0, Coded { frame_time_ns: 41_708_375, ..motion(12) })
}

/// Three hundred channels, a third of which moves.
fn crowd() -> Made {
    let rig = figure(&[&EULER as &[Kind]; 100], 0);
    let mut coded = motion(24);
    let mut noise = Noise::new(19);
    for channel in 0..300 {
        coded.channels.push(match channel % 3 {
            0 => lively(24, moving(noise.between(-90, 90), noise.between(-9, 9), 40 + channel as u8 % 7), &mut noise),
            1 => Channel { start: constant(noise.between(-99, 99), 44), segments: vec![] },
            _ => Channel { start: Start::Rest, segments: vec![] },
        });
    }
    Made { name: "channels-300", rig, coded, apart: false, index: 0, sections: &[] }
}

/// Channels that follow another, every way back that there is, some of them one that follows itself, among channels of every status;
/// of angles, of positions and of scalars with names by a list.
fn followers() -> Made {
    let places = 48..48 + 6 * 4;
    let mut rig = figure(&[vec![&EULER as &[Kind]; 12], vec![&PLACE as &[Kind]; 4 + 2 * 4]].concat(), 60);
    let names = pantin::names::LIVE_LINK.split(' ').filter(|&name| name != "TongueOut");
    rig.scalars.iter_mut().zip(names).for_each(|(scalar, name)| scalar.name = name.into());
    let mut coded = motion(30);
    let mut noise = Noise::new(29);
    let (mut moves, mut back) = (vec![], 0);
    for channel in 0..rig.channels() {
        let leader = moves.len().checked_sub(back % 32 + 1).map(|at| moves[at]);
        // Pairs of joints: an x that is constant or follows, behind a channel that moves or follows, and behind an x that rests.
        let ordered = places.contains(&channel).then(|| {
            let pair = (channel - places.start) / 6;
            let statuses = [0, 0, 2 + pair / 2, 1 + 2 * (pair % 2), 0, 2];
            [0, 1, 7, 2][statuses[(channel - places.start) % 6]]
        });
        let made = match (ordered.unwrap_or_else(|| noise.below(8)), leader) {
            (0, _) => Channel { start: Start::Rest, segments: vec![] },
            (1, _) => Channel { start: constant(noise.between(-99, 99), 44), segments: vec![] },
            (2..6, Some(leader)) => {
                back += 1;
                Channel { start: Start::Follows { leader }, segments: vec![] }
            }
            _ if ordered.is_some() => {
                Channel { start: moving(0, 1, 44), segments: fill(coded.frames, || Segment { mode: 15, w: 0, k: 0 }) }
            }
            _ => lively(coded.frames, moving(noise.between(-90, 90), noise.between(-9, 9), 40 + channel as u8 % 7), &mut noise),
        };
        if !matches!(made.start, Start::Rest | Start::Constant { .. }) {
            moves.push(channel);
        }
        coded.channels.push(made);
    }
    Made { name: "followers", rig, coded, apart: false, index: 13, sections: &[] }
}

/// The clips of the vector of a bank.
pub fn in_bank() -> Vec<Made> {
    let joints: [&[Kind]; 2] = [&PLACE, &EULER];
    let mut stepping = motion(30);
    stepping.looped = true;
    stepping.events = [(3, 0), (18, 1)].map(|(frame, id)| Event { frame, id }).to_vec();
    stepping.event_names = vec![pantin::LEFT_FOOT_DOWN.into(), pantin::RIGHT_FOOT_DOWN.into()];
    let mut walk = simple("walk", &joints, 1, stepping);
    walk.index = 8;
    let mut long = simple("a longer one", &joints, 1, motion(200));
    long.coded.frame_time_ns = 41_708_375;
    let mut last = simple("wave", &joints, 1, motion(9));
    last.apart = true;
    vec![walk, long, last]
}

/// All of them.
pub fn all() -> Vec<Made> {
    let mut apart = simple("rig-apart", &[&PLACE, &EULER, &EULER], 0, motion(20));
    apart.apart = true;
    let mut indexed = simple("index", &[&PLACE, &QUATERNION, &EULER], 2, motion(90));
    indexed.index = 7;
    vec![
        segments(),
        numbers(),
        starts(),
        still(),
        exponential_choice(),
        events(),
        event_names(),
        sections(),
        odd_rate(),
        widest_steps(),
        rests_and_choices(),
        turn_orders(),
        half_turns(),
        crowd(),
        followers(),
        apart,
        indexed,
        simple("quaternion", &[&QUATERNION, &QUATERNION], 0, motion(40)),
        simple("exponential-map", &[&EXPONENTIAL, &EXPONENTIAL], 0, motion(40)),
        simple("scalars", &[], 5, motion(40)),
        simple("mixed", &[&PLACE, &EULER, &QUATERNION, &EXPONENTIAL, &[], &[Kind::Xrotation]], 2, motion(30)),
        simple("empty", &[], 0, motion(4)),
        simple("frames-1", &[&EULER], 1, motion(1)),
        simple("frames-2", &[&EULER], 1, motion(2)),
        simple("frames-3", &[&EULER], 1, motion(3)),
    ]
}
