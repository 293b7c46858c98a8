//! Plans what is sent of each channel, and when: its segments, split so that none lasts longer than the refresh cycle allows.

use super::source::{MovingChannel, Segment, Source};
use super::writer::Writer;
use pantin::codec::layout::segment_type;
use pantin_link::wire::Coder;
use pantin_link::{Message, Refresh, units};

/// A message and where it belongs.
#[derive(Clone, Debug)]
pub(crate) struct ScheduledMessage {
    /// Frames from the clip's first.
    pub frame: u32,
    pub channel: u16,
    pub message: Message,
}

/// All messages of a round of the clip, in the order in which they are sent; every channel is refreshed after `cycle` frames at most.
pub(crate) fn round(source: &Source, cycle: u32) -> Vec<ScheduledMessage> {
    let mut told = vec![];
    for (index, track) in source.tracks.iter().enumerate() {
        // The first refreshes all fall together; the second ones are spread.
        let first = (index as u32 + 1) * cycle / source.tracks.len() as u32;
        tell(track, source.head.frames, cycle, first.max(1), &mut told);
    }
    told.sort_by_key(|told| (told.frame, told.channel));
    told
}

/// Longest run of a message.
const LONGEST: u32 = 127;

fn tell(track: &MovingChannel, frames: u32, cycle: u32, first: u32, told: &mut Vec<ScheduledMessage>) {
    // The frame by which the next refresh must come.
    let mut by = first.min(cycle);
    let ends = track.segments.iter().skip(1).map(|segment| segment.frame).chain([frames]);
    for (segment, end) in track.segments.iter().zip(ends) {
        let mut at = segment.frame;
        while at < end {
            let mut refresh = at == 0 || at != segment.frame;
            let mut next = end.min(at + LONGEST);
            if next > by || (refresh && at > 0) {
                // QueuedPacket for the next message would be too long.
                (refresh, by) = (refresh || at > 0, if at > 0 { at + cycle } else { by });
                next = next.min(by);
            }
            told.push(ScheduledMessage {
                frame: at,
                channel: track.channel,
                message: message(track, segment, at, next, refresh),
            });
            at = next;
        }
    }
}

fn message(track: &MovingChannel, segment: &Segment, at: u32, next: u32, refresh: bool) -> Message {
    let Segment { frame, mut mode, mut w, k } = *segment;
    if at != frame && mode >> 4 == segment_type::WK {
        // The acceleration has run on from what was told.
        (mode, w) = (segment_type::K << 4 | mode & 15, 0);
    }
    let message = Message { mode, run: (next - at) as u8, w, k, refresh: None };
    let refresh = refresh.then(|| {
        let state = track.states[at as usize];
        let [p, v, w] = [0, 1, 2].map(|i| rounded(state[i], units(track.step)[i]));
        Refresh { p, v, w: if message.is_new()[0] { 0 } else { w } }
    });
    Message { refresh, ..message }
}

fn rounded(value: i32, unit: i32) -> i32 {
    (i64::from(value) + i64::from(unit / 2)).div_euclid(i64::from(unit)) as i32
}

/// A message's fields, without its place.
pub(crate) fn fields(message: &Message) -> Writer {
    let mut writer = Writer::default();
    message.code(&mut writer);
    writer
}

/// Writes a place `passed` channels on.
pub(crate) fn pass(writer: &mut Writer, mut passed: u32) {
    use pantin_link::wire::PASS;
    while passed >= PASS {
        writer.symbol(&pantin_link::tables::PLACE, PASS);
        passed -= PASS;
    }
    writer.symbol(&pantin_link::tables::PLACE, passed);
}

/// The states that every synchronized receiver has: p, v, w, k by frame for each transmitted channel, with its place in the pose.
pub(crate) fn expected_states(source: &Source, cycle: u32) -> Vec<(u16, Vec<[i32; 4]>)> {
    let mut all: Vec<(u16, Vec<[i32; 4]>)> = source.tracks.iter().map(|track| (track.channel, vec![])).collect();
    let told = round(source, cycle);
    for (track, (channel, states)) in source.tracks.iter().zip(&mut all) {
        let mut own = told.iter().filter(|told| told.channel == *channel).peekable();
        let mut state = [0; 4];
        for frame in 0..source.head.frames {
            if let Some(told) = own.next_if(|told| told.frame == frame) {
                state = told.message.apply(state, track.step);
            }
            states.push(state);
            let [p, v, w, k] = state;
            state = [p.wrapping_add(v), v.wrapping_add(w), w.wrapping_add(k), k];
        }
    }
    all
}
