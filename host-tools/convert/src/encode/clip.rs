//! A clip's bytes: the file's head, the rig, the motion's blocks.

use super::entropy::{Alphabet, Sink, Symbols};
use super::segment::{Running, Segment};
use super::{index, varint};
use crate::memory::Memory;
use anyhow::{Context, Result, bail, ensure};
use pantin::Event;
use pantin::codec::keys::{KEY_VERSION, KEYS};
use pantin::codec::layout::*;
use pantin::codec::{Statuses, crc, step_size};

/// How a channel begins, in multiples of its grids, which need not divide the range of raw values: those may wrap, these not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// It rests where the rig has it: an offset, or zero.
    Rest,
    /// It holds one value.
    Constant {
        /// The value in [`position_grid`]s.
        p: i32,
        /// Index of the channel's step.
        step: u8,
    },
    /// It moves.
    Moving {
        /// Value at frame 0 in [`position_grid`]s.
        p: i32,
        /// Difference from frame 0 to frame 1 in [`velocity_grid`]s.
        v: i32,
        /// Index of the channel's step.
        step: u8,
    },
    /// It moves as a channel before it.
    Follows {
        /// The channel's index.
        leader: usize,
    },
}

/// First values are multiples of this: half a channel step.
pub fn position_grid(step: u8) -> i32 {
    (step_size(step) >> 1).max(1) as i32
}

/// First velocities are multiples of this: a quarter of a channel step.
pub fn velocity_grid(step: u8) -> i32 {
    (step_size(step) >> 2).max(1) as i32
}

/// A channel as it is coded.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// How it begins.
    pub start: Start,
    /// Its segments; none unless it moves by its own.
    pub segments: Vec<Segment>,
}

/// A motion as it is coded: one channel for each of the rig's, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Coded {
    /// Number of frames.
    pub frames: u32,
    /// Time from one frame to the next.
    pub frame_time_ns: u32,
    /// A position's raw value times 2^exponent is in source units.
    pub length_exponent: i8,
    /// For each joint that may choose (`pantin::codec::has_choice`): whether its rotation is an exponential map.
    pub exponentials: Vec<bool>,
    /// The channels.
    pub channels: Vec<Channel>,
    /// Event markers, in time order.
    pub events: Vec<Event>,
    /// Names of the events, by id; empty for an id without one.
    pub event_names: Vec<String>,
    /// Whether frame 0 follows the last frame.
    pub looped: bool,
}

/// Where the bytes of a motion went.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sizes {
    /// Fields before the first symbol.
    pub head: usize,
    /// Symbols: how channels begin, and their segments.
    pub symbols: usize,
    /// CRCs.
    pub crc: usize,
}

/// The file: with `rig` in it, or with the id of `rig` if `apart`.
pub fn encode(coded: &Coded, rig: &[u8], apart: bool) -> Result<Vec<u8>> {
    file(coded, rig, apart, None)
}

/// The file with a snapshot each `spacing` frames, for players that seek much.
pub fn encode_with_index(coded: &Coded, rig: &[u8], apart: bool, spacing: u32, memory: Memory) -> Result<Vec<u8>> {
    let plain = encode(coded, rig, apart)?;
    let clip = pantin::Clip::with_rig(&plain, rig).context("the clip that was just made does not open")?;
    let bytes = file(coded, rig, apart, Some(&index::payload(clip, spacing, memory)?))?;
    index::check(&bytes, rig, spacing)?;
    Ok(bytes)
}

fn file(coded: &Coded, rig: &[u8], apart: bool, index: Option<&[u8]>) -> Result<Vec<u8>> {
    ensure!((1..=MAX_FRAMES).contains(&coded.frames), "{} frames; a clip holds 1 to {MAX_FRAMES}", coded.frames);
    let mut flags = if apart { 0 } else { HAS_RIG };
    if coded.looped {
        flags |= LOOPED;
    }
    if coded.exponentials.contains(&true) {
        flags |= HAS_EXPONENTIALS;
    }
    if !coded.events.is_empty() {
        flags |= HAS_EVENTS;
    }
    if index.is_some() {
        flags |= HAS_INDEX;
    }
    if !coded.event_names.is_empty() {
        flags |= HAS_EVENT_NAMES;
    }
    ensure!(coded.events.is_sorted_by_key(|event| event.frame), "event markers must be in the order of their frames");
    if let Some(event) = coded.events.last().filter(|event| event.frame >= coded.frames) {
        bail!("an event marker at frame {}; the last frame is {}", event.frame, coded.frames - 1);
    }
    let parsed = pantin::Rig::new_checked(rig).context("the rig that was just made does not open")?;
    let mut payload = head(coded, flags, apart.then(|| parsed.id()));
    ensure!(coded.channels.len() == parsed.channels(), "a rig of {} channels for {}", parsed.channels(), coded.channels.len());
    let mut gathered = Symbols::default();
    symbols(coded, &parsed, &mut gathered);
    payload.extend(gathered.finish());
    let mut out = assembled(flags, rig, &payload, index);
    put_event_names(&mut out, &coded.event_names);
    Ok(out)
}

/// The names of events, if there are any, behind the rest of a file.
pub fn put_event_names(out: &mut Vec<u8>, event_names: &[String]) {
    if event_names.is_empty() {
        return;
    }
    let mut names = Vec::new();
    event_names.iter().for_each(|name| varint::put_name(&mut names, name));
    names.extend_from_slice(&crc::of(&names).to_le_bytes());
    varint::put(out, names.len() as u32);
    out.extend_from_slice(&names);
}

/// A file up to its names of events: the rig is part of it if the flags say so, motion and index are payloads. [`KEYS`] among the flags makes it a
/// key clip.
pub fn assembled(flags: u8, rig: &[u8], motion: &[u8], index: Option<&[u8]>) -> Vec<u8> {
    let version = if flags & KEYS == 0 { VERSION } else { KEY_VERSION };
    let mut out = vec![MAGIC[0], MAGIC[1], version, flags & !KEYS];
    if flags & HAS_RIG != 0 {
        varint::put(&mut out, rig.len() as u32);
        out.extend_from_slice(rig);
    }
    let len = blocks_len(motion.len()) as u32;
    varint::put(&mut out, len);
    let last = put_blocks(&mut out, motion, crc::of_prefix(flags, len));
    if let Some(index) = index {
        let len = blocks_len(index.len()) as u32;
        varint::put(&mut out, len);
        put_blocks(&mut out, index, pantin::codec::index_seed(last, len));
    }
    out
}

/// Bytes of `payload` bytes in blocks.
pub fn blocks_len(payload: usize) -> usize {
    payload + payload.div_ceil(BLOCK_BYTES) * CRC_BYTES
}

/// Cuts `payload` into blocks with a CRC each, the first of which goes on from `crc`; returns the last.
pub fn put_blocks(out: &mut Vec<u8>, payload: &[u8], mut crc: u16) -> u16 {
    let mut last = crc;
    for block in payload.chunks(BLOCK_BYTES) {
        last = crc::update(crc, block);
        out.extend_from_slice(block);
        out.extend_from_slice(&last.to_le_bytes());
        crc = crc::INITIAL;
    }
    last
}

/// The first fields of a motion's head.
#[derive(Clone, Copy, Debug)]
pub struct Head {
    /// Time from one frame to the next.
    pub frame_time_ns: u32,
    /// Number of frames.
    pub frames: u32,
    /// Exponent of the unit of positions.
    pub length_exponent: i8,
    /// The id of a rig that is not in the file.
    pub rig_id: Option<u32>,
    /// The states that a key clip needs.
    pub states: Option<u32>,
}

impl Head {
    /// Their bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        match FRAME_TIMES_NS.iter().skip(1).position(|&time| time == self.frame_time_ns) {
            Some(index) => out.push(index as u8 + 1),
            None => {
                out.push(0);
                out.extend_from_slice(&self.frame_time_ns.to_le_bytes());
            }
        }
        varint::put(&mut out, self.frames);
        out.push(self.length_exponent as u8);
        out.extend(self.rig_id.iter().flat_map(|id| id.to_le_bytes()));
        self.states.iter().for_each(|&states| varint::put(&mut out, states));
        out
    }
}

fn head(coded: &Coded, flags: u8, rig_id: Option<u32>) -> Vec<u8> {
    let &Coded { frame_time_ns, frames, length_exponent, .. } = coded;
    let mut out = Head { frame_time_ns, frames, length_exponent, rig_id, states: None }.bytes();
    if flags & HAS_EXPONENTIALS != 0 {
        let bits = |chunk: &[bool]| chunk.iter().enumerate().fold(0, |byte, (bit, &set)| byte | u8::from(set) << bit);
        out.extend(coded.exponentials.chunks(8).map(bits));
    }
    put_events(&mut out, &coded.events);
    out
}

/// The event markers, if there are any.
pub fn put_events(out: &mut Vec<u8>, events: &[Event]) {
    if events.is_empty() {
        return;
    }
    varint::put(out, events.len() as u32);
    let mut before = 0;
    for event in events {
        varint::put(out, event.frame - before);
        varint::put(out, event.id);
        before = event.frame;
    }
}

/// The change from one index of a step to the next as a zigzag number.
pub fn step_change(before: u8, step: u8) -> u32 {
    let change = i32::from(step) - i32::from(before);
    ((change << 1) ^ (change >> 31)) as u32
}

/// Predicts channel steps as `pantin::Opening` does.
struct Opening {
    statuses: Statuses,
    steps: [u8; 2],
}

impl Opening {
    /// `moving` lists the channels before that move.
    fn put(&mut self, start: &Start, kind: pantin::Kind, moving: &[usize], out: &mut dyn Sink) {
        let (status, step, p) = match *start {
            Start::Rest => (status::RESTS, 0, 0),
            Start::Constant { p, step } => (status::CONSTANT, step, p),
            Start::Moving { p, step, .. } => (status::MOVES, step, p),
            Start::Follows { .. } => (status::FOLLOWS, 0, 0),
        };
        out.symbol(Alphabet::Status(self.statuses.context(kind)), u32::from(status));
        self.statuses.put(kind, status);
        if let Start::Follows { leader } = *start {
            // The fit chooses leaders that are near enough.
            let back = moving.iter().rev().position(|&channel| channel == leader).unwrap_or(0);
            out.bits(back as u32, FOLLOW_BITS);
            return;
        }
        if status == status::RESTS {
            return;
        }
        let before = std::mem::replace(&mut self.steps[usize::from(kind.is_position())], step);
        let change = step_change(before, step);
        out.symbol(Alphabet::StepChange, change.min(STEP_CHANGES));
        if change >= STEP_CHANGES {
            out.bits(u32::from(step), STEP_BITS);
        }
        out.magnitude(Alphabet::Position, p);
        if let Start::Moving { v, .. } = *start {
            out.magnitude(Alphabet::Velocity, v);
        }
    }
}

/// All symbols, in the order in which a player reads them.
pub fn symbols(coded: &Coded, rig: &pantin::Rig<'_>, out: &mut dyn Sink) {
    let mut opening = Opening { statuses: Statuses::default(), steps: [FIRST_STEP; 2] };
    let kinds = rig.joints().flat_map(|joint| joint.kinds).chain(std::iter::repeat(pantin::Kind::Scalar));
    let (mut running, mut moving) = (Vec::new(), Vec::new());
    for (index, (channel, kind)) in coded.channels.iter().zip(kinds).enumerate() {
        opening.put(&channel.start, kind, &moving, out);
        if matches!(channel.start, Start::Moving { .. } | Start::Follows { .. }) {
            moving.push(index);
        }
        if let Start::Moving { v, step, .. } = channel.start {
            let v = v.wrapping_mul(velocity_grid(step));
            running.push((index, 0, Running { v, w: 0, k: 0, turn: 0, mode: START_MODE, step }, 0));
        }
    }
    for frame in 0..(coded.frames as usize).saturating_sub(2) {
        for (index, next, state, due) in running.iter_mut().filter(|(.., due)| *due == frame) {
            let segment = coded.channels[*index].segments[*next];
            *next += 1;
            state.put_mode(segment.mode, out);
            state.start(segment, Some(&mut *out));
            state.run(segment.length());
            *due += segment.length();
        }
    }
}
