//! Vectors of key clips, in a folder of their own: decoders of version 1 do not play them.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use hostile::noise::Noise;
use pantin::codec::{keys as layout, layout::HAS_SECTIONS};
use pantin::{ChannelState, Clip, Event, Kind, Player};
use pantin_convert::bank::{self, Named};
use pantin_convert::encode::keys::{self, Curve, KeyMotion, KeyedChannel};
use pantin_convert::encode::rig;
use pantin_convert::fit::raw::clip_length_exponent;
use pantin_convert::import::{self, ImportOptions};
use pantin_convert::key_clip;
use pantin_convert::motion::Rig;
use serde_json::json;

use super::synthetic::{self, figure};
use super::{Vector, json};
use crate::paths;

/// Where they are.
pub fn folder() -> PathBuf {
    paths::root().join("tests/key-vectors")
}

const EULER: [Kind; 3] = [Kind::Zrotation, Kind::Xrotation, Kind::Yrotation];
const PLACE: [Kind; 3] = [Kind::Xposition, Kind::Yposition, Kind::Zposition];
const PLACED: [Kind; 6] = [Kind::Xposition, Kind::Yposition, Kind::Zposition, Kind::Zrotation, Kind::Xrotation, Kind::Yrotation];
const QUATERNION: [Kind; 4] = [Kind::Wquaternion, Kind::Xquaternion, Kind::Yquaternion, Kind::Zquaternion];
const EXPONENTIAL: [Kind; 3] = [Kind::Xexponential, Kind::Yexponential, Kind::Zexponential];

/// Motions of ours that are vectors.
const OWN: [&str; 6] = ["walk", "run", "greet", "library/dance", "face/yawn", "emotes/loving"];

/// All clips, each with a name of its own.
pub fn all() -> Result<Vec<Vector>> {
    let mut vectors = made()?;
    for motion in OWN {
        let path = paths::root().join("motions").join(motion).with_extension("keys");
        let source = import::load(&path, &ImportOptions::new()).with_context(|| motion.to_owned())?.motion;
        let rig = rig::encode(&source.rig)?;
        let (time, exponent) = ((source.frame_time * 1e9).round() as u32, clip_length_exponent(&source.rig, &source.values));
        let clip = key_clip(&source, &rig, (time, exponent), false).with_context(|| motion.to_owned())?;
        vectors.push(Vector { name: motion.replace('/', "-"), clip, rig: None });
    }
    Ok(vectors)
}

/// Clips of noise.
fn made() -> Result<Vec<Vector>> {
    let every = [0, 1, 2, 3];
    let mut vectors = vec![
        noisy("kinds", &[&PLACED, &QUATERNION, &EXPONENTIAL, &EULER], 3, (40, false), &every)?,
        noisy("loop", &[&PLACED, &EULER, &EULER, &EULER, &EULER], 2, (48, true), &every)?,
        noisy("odd-loop", &[&PLACED, &EULER, &EULER], 2, (33, true), &every)?,
        noisy("linear", &[&PLACED, &EULER], 1, (90, true), &[0])?,
        noisy("catmull-rom", &[&PLACED, &EULER], 1, (90, false), &[1])?,
        noisy("natural", &[&PLACED, &EULER], 1, (90, true), &[2])?,
        noisy("discrete", &[&PLACED, &EULER], 1, (90, true), &[3])?,
        noisy("long-spans", &[&PLACED], 1, (1500, false), &every)?,
        noisy("frames-2", &[&PLACED], 1, (2, false), &every)?,
        noisy("frames-2-loop", &[&PLACED], 1, (2, true), &every)?,
        noisy("frame-1-loop", &[&PLACE], 1, (1, true), &every)?,
        noisy("channels-300", &[&PLACED[..]; 50], 0, (30, true), &every)?,
    ];
    vectors.push(most_frames()?);
    vectors.push(still()?);
    vectors.push(steep()?);
    vectors.push(with_events()?);
    vectors.push(rig_apart()?);
    vectors.push(with_sections()?);
    vectors.extend(malformed()?);
    Ok(vectors)
}

fn motion(frames: u32, looped: bool) -> KeyMotion {
    KeyMotion {
        frames,
        frame_time_ns: 33_333_333,
        length_exponent: -20,
        channels: vec![],
        events: vec![],
        event_names: vec![],
        looped,
    }
}

fn vector(name: &str, motion: &KeyMotion, figure: &Rig, apart: bool) -> Result<Vector> {
    let rig = rig::encode(figure)?;
    let clip = keys::encode(motion, &rig, apart).with_context(|| name.to_owned())?;
    let opened = Clip::with_rig(&clip, &rig)?;
    let (mut states, mut pose) = (vec![ChannelState::NEW; opened.moving()], vec![0; opened.rig().channels()]);
    ensure!(!Player::new(opened, &mut states, &mut pose)?.is_malformed(), "{name}: malformed");
    Ok(Vector { name: name.into(), clip, rig: apart.then_some(rig) })
}

/// A clip whose channels are noise: some rest, some are constant, some do what others do.
fn noisy(name: &str, joints: &[&[Kind]], scalars: usize, length: (u32, bool), interpolations: &[u8]) -> Result<Vector> {
    let figure = figure(joints, scalars);
    let motion = noise(&figure, length, interpolations, name.len());
    vector(name, &motion, &figure, false)
}

fn noise(figure: &Rig, (frames, looped): (u32, bool), interpolations: &[u8], seed: usize) -> KeyMotion {
    let mut motion = motion(frames, looped);
    let mut noise = Noise::new(u64::from(frames) + seed as u64);
    for (_, kind) in figure.channel_kinds() {
        let channel = channel(&motion, kind, interpolations, &mut noise);
        motion.channels.push(channel);
    }
    motion
}

/// A bank of key clips and a clip of segments.
pub fn bank() -> Result<Vec<u8>> {
    let segments = synthetic::in_bank().into_iter().next().context("a clip of the bank of version 1")?;
    let rig = rig::encode(&segments.rig)?;
    let named = |name: &str, clip: Vec<u8>| Named { name: name.into(), place: name.into(), clip, rig: rig.as_slice().into() };
    let keyed = |name: &str, length| -> Result<Named> {
        let motion = noise(&segments.rig, length, &[0, 1, 2, 3], name.len());
        Ok(named(name, keys::encode(&motion, &rig, true)?))
    };
    let clips =
        [keyed("keys", (36, false))?, named(segments.name, segments.vector()?.clip), keyed("keys of a loop", (24, true))?];
    bank::encode(&clips)
}

/// The greatest value of a kind in thousandths.
fn most(kind: Kind) -> i32 {
    if kind.is_position() {
        60_000
    } else if kind.is_quaternion() || kind == Kind::Scalar {
        1000
    } else {
        170_000
    }
}

fn channel(motion: &KeyMotion, kind: Kind, interpolations: &[u8], noise: &mut Noise) -> KeyedChannel {
    let last = if motion.looped { motion.frames } else { motion.frames - 1 };
    let most = most(kind);
    let quantum = i32::from(layout::QUANTA[noise.below(8)]).min(most);
    let value = |noise: &mut Noise| quantum * noise.between(-most / quantum, most / quantum);
    let curves: Vec<&Curve> = motion
        .channels
        .iter()
        .filter_map(|channel| match channel {
            KeyedChannel::Keyed(curve) if curve.values.iter().all(|value| value.abs() <= most) => Some(curve),
            _ => None,
        })
        .collect();
    match noise.below(12) {
        0 => KeyedChannel::Rest,
        1 => KeyedChannel::Constant(value(noise)),
        2..=5 if !curves.is_empty() => follower(curves[noise.below(curves.len())], last, motion.looped, noise),
        _ if last == 0 => KeyedChannel::Constant(value(noise)),
        kind => {
            let interpolation = interpolations[noise.below(interpolations.len())];
            let times = match curves.last() {
                Some(curve) if kind > 8 => curve.times.clone(),
                _ => times(last, motion.looped, noise),
            };
            // Second differences of a spline with a key a frame are at most twelve times the values: they fit 32 bits.
            let part = if interpolation > layout::interpolation::CATMULL_ROM { 13 } else { 1 };
            let mut values: Vec<i32> = times.iter().map(|_| value(noise) / quantum / part * quantum).collect();
            if noise.below(3) > 0 {
                values[times.len() - 1] = values[0];
            }
            if kind == 7 {
                mirror(&times, &mut values, last, noise);
            }
            KeyedChannel::Keyed(Curve { interpolation, times, values })
        }
    }
}

/// Key times; of a loop often those of its first half twice.
fn times(last: u32, looped: bool, noise: &mut Noise) -> Vec<u32> {
    let half = looped && last.is_multiple_of(2) && noise.below(2) == 0;
    let end = if half { last / 2 } else { last };
    let dense = noise.below(4) == 0;
    let mut times: Vec<u32> = (0..end).filter(|&time| time == 0 || dense || noise.below(1 + end as usize / 5) == 0).collect();
    if half {
        times.extend(times.clone().into_iter().map(|time| time + end));
    }
    times.push(last);
    times
}

/// Makes the second half what the first one is, or its opposite, as far as it has keys for it.
fn mirror(times: &[u32], values: &mut [i32], last: u32, noise: &mut Noise) {
    let sign = if noise.below(2) == 0 { 1 } else { -1 };
    for key in 0..times.len() - 1 {
        let before = times[key].checked_sub(last / 2).and_then(|time| times.binary_search(&time).ok());
        if let Some(before) = before {
            values[key] = sign * values[before];
        }
    }
}

/// A channel that does nearly what an earlier one does, its opposite, or the same half a cycle later.
fn follower(leader: &Curve, last: u32, looped: bool, noise: &mut Noise) -> KeyedChannel {
    let sign = if noise.below(2) == 0 { 1 } else { -1 };
    let half = last / 2;
    let shifts = looped && last.is_multiple_of(2) && noise.below(2) == 0;
    let Curve { interpolation, ref times, ref values } = *leader;
    let count = times.len() - 1;
    let drift = values[count] - values[0];
    let at = |time: u32| {
        let (time, drift) = if time >= last { (time - last, drift) } else { (time, 0) };
        times.binary_search(&time).ok().map(|key| values[key] + drift)
    };
    let shifted: Option<Vec<i32>> = times.iter().map(|&time| at(time + half)).collect();
    let mut values = match shifted {
        Some(shifted) if shifts => shifted,
        _ => values.clone(),
    };
    for value in &mut values {
        *value = sign * *value + if noise.below(4) == 0 { noise.between(-20, 20) } else { 0 };
    }
    KeyedChannel::Keyed(Curve { interpolation, times: times.clone(), values })
}

/// As many frames as a key clip may have.
fn most_frames() -> Result<Vector> {
    let mut motion = motion(layout::MAX_KEY_FRAMES, true);
    let end = layout::MAX_KEY_FRAMES;
    let curve = |interpolation, times: Vec<u32>, values: Vec<i32>| KeyedChannel::Keyed(Curve { interpolation, times, values });
    motion.channels = vec![
        curve(2, vec![0, 1, 4000, 8000, end], vec![0, 1000, -170_000, 90_000, 0]),
        curve(3, vec![0, 3000, end], vec![0, 360_000, 720_000]),
        curve(1, vec![0, 8190, end], vec![-5000, 5000, -5000]),
        curve(0, vec![0, end], vec![0, 60_000]),
    ];
    vector("most-frames", &motion, &figure(&[&[EULER[0], EULER[1], EULER[2], PLACE[0]]], 0), false)
}

/// Nothing moves.
fn still() -> Result<Vector> {
    let mut motion = motion(20, false);
    motion.channels = [0, 1, 2].map(|value| if value == 0 { KeyedChannel::Rest } else { KeyedChannel::Constant(value) }).to_vec();
    vector("still", &motion, &figure(&[&PLACE], 0), false)
}

/// Angles that turn by several turns from key to key, at odd rates.
fn steep() -> Result<Vector> {
    let mut motion = motion(12, false);
    motion.frame_time_ns = 12_345_678;
    motion.channels = [0, 1, 2, 3]
        .map(|interpolation| {
            let values = vec![0, 1_000_000, -720_000, 5_400_000, 0];
            let values = values.into_iter().map(|value| value / if interpolation > 1 { 20 } else { 1 }).collect();
            KeyedChannel::Keyed(Curve { interpolation, times: vec![0, 3, 4, 9, 11], values })
        })
        .to_vec();
    vector("steep", &motion, &figure(&[&EULER, &[Kind::Xrotation]], 0), false)
}

fn with_events() -> Result<Vector> {
    let mut motion = motion(30, true);
    motion.channels.push(KeyedChannel::Keyed(Curve { interpolation: 3, times: vec![0, 10, 30], values: vec![0, 500, 0] }));
    motion.events = [(0, 1), (0, 0), (12, 1), (29, 7)].map(|(frame, id)| Event { frame, id }).to_vec();
    motion.event_names = vec!["clap".into(), "left_foot_down".into()];
    vector("events", &motion, &figure(&[], 1), false)
}

fn rig_apart() -> Result<Vector> {
    let mut motion = motion(30, false);
    motion.channels.push(KeyedChannel::Keyed(Curve { interpolation: 2, times: vec![0, 10, 29], values: vec![0, 90_000, 0] }));
    vector("rig-apart", &motion, &figure(&[&[Kind::Xrotation]], 0), true)
}

fn with_sections() -> Result<Vector> {
    let mut made = with_events()?;
    made.name = "sections".into();
    made.clip[3] |= HAS_SECTIONS;
    made.clip.extend([200, 2, 1, 2]);
    hostile::fix::key_clip(&mut made.clip);
    Ok(made)
}

/// Clips that break a rule: the rig rests at all frames.
fn malformed() -> Result<Vec<Vector>> {
    let figure = figure(&[&EULER], 0);
    let rig = rig::encode(&figure)?;
    let mut motion = motion(30, false);
    let curve = |times: &[u32], values: &[i32]| {
        KeyedChannel::Keyed(Curve { interpolation: 2, times: times.to_vec(), values: values.to_vec() })
    };
    motion.channels = vec![KeyedChannel::Constant(5000), curve(&[0, 10, 29], &[0, 90_000, 0]), KeyedChannel::Rest];
    let whole = keys::encode(&motion, &rig, false)?;
    let mut out = Vec::new();
    let mut put = |name: &str, clip: Vec<u8>| out.push(Vector { name: format!("malformed-{name}"), clip, rig: None });
    // Behind magic, version, flags, the rig and its length, the motion's length, then rate, frames and exponent: the states.
    let states_at = 4 + 1 + rig.len() + 1 + 3;
    for (name, by) in [("few-states", -1), ("many-states", 1)] {
        let mut clip = whole.clone();
        clip[states_at] = (i32::from(clip[states_at]) + by) as u8;
        hostile::fix::key_clip(&mut clip);
        put(name, clip);
    }
    motion.channels[1] = curve(&[0, 1, 2, 29], &[0, 60_000_000, -60_000_000, 0]);
    put("acceleration", keys::encode(&motion, &rig, false)?);
    let mut noise = Noise::new(7);
    for name in ["noise", "more-noise"] {
        let mut clip = whole.clone();
        let count = clip.len();
        clip[states_at + 1..count - 2].iter_mut().for_each(|byte| *byte = noise.below(256) as u8);
        hostile::fix::key_clip(&mut clip);
        put(name, clip);
    }
    Ok(out)
}

/// The text of `tables.json`: the constants of key clips.
pub fn tables() -> String {
    json::text(&[
        ("version", json!(layout::KEY_VERSION)),
        ("known_flags", json!(layout::KEY_FLAGS)),
        ("max_frames", json!(layout::MAX_KEY_FRAMES)),
        ("max_states", json!(layout::MAX_STATES)),
        ("max_words", json!(layout::MAX_WORDS)),
        ("state_words", json!(layout::STATE_WORDS)),
        ("part_frames", json!(layout::PART_FRAMES)),
        ("quanta", json!(layout::QUANTA)),
        ("quantum_bits", json!(layout::QUANTUM_BITS)),
        ("first_quantum", json!(layout::FIRST_QUANTUM)),
        ("max_thousandths", json!(layout::MAX_THOUSANDTHS)),
        ("angle_factor", json!(layout::ANGLE_FACTOR)),
        ("angle_shift", json!(layout::ANGLE_SHIFT)),
        ("decimal_factor", json!(layout::DECIMAL_FACTOR)),
        ("decimal_shift", json!(layout::DECIMAL_SHIFT)),
        ("max_fraction", json!(layout::MAX_FRACTION)),
        ("chance_bits", json!(layout::CHANCE_BITS)),
        ("chances", json!(layout::CHANCES)),
        ("rates", json!(layout::RATES)),
        ("max_gamma", json!(layout::MAX_GAMMA)),
        ("max_length", json!(layout::MAX_LENGTH)),
        ("contexts", json!(layout::context::COUNT_OF_ALL)),
    ])
}

/// The committed ones, by name.
pub fn load() -> Result<Vec<Vector>> {
    super::load(&folder())
}

/// The file of the constants.
pub fn tables_path(folder: &Path) -> PathBuf {
    folder.join(super::constants::NAME)
}
