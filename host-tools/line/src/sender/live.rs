//! Motion coded while it is made: each segment as soon as the frames are known that it may cover. It goes on from the state that the receivers
//! have, so that nothing adds up.

use super::pack::pack;
use super::refresh::ScheduledMessage;
use super::schedule::{ByteCounts, LineSettings, Schedule, TimedPacket};
use super::source::Source;
use pantin::Form;
use pantin::codec::layout::{LENGTHS, MAX_FRAMES, MAX_STEP};
use pantin::codec::{segment, step_size};
use pantin_link::{ChannelKind, Head, MAX_PACE, pace};
use pantin_link::{Message, Refresh, units};
use std::collections::VecDeque;

/// A line that is this many frames behind, or as many as packets are sent ahead, carries no more until it has caught up.
const MOST_BEHIND: u32 = 6;

/// How long frames wait for others before they are sent: less delay takes more of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LiveTiming {
    /// Index of the longest segment's length.
    longest: usize,
    /// Frames that share packets.
    together: u32,
}

impl LiveTiming {
    /// Segments of up to 8 frames, and packets of two: a face of 60 weights on a slow line.
    pub const FACE: LiveTiming = LiveTiming { longest: 6, together: 2 };
    /// Segments of up to 2 frames, and packets of one: a body that is to be shown soon.
    pub const BODY: LiveTiming = LiveTiming { longest: 1, together: 1 };

    /// A segment that begins at a frame is known this many frames later.
    fn look(self) -> u32 {
        u32::from(LENGTHS[self.longest]) + 1
    }

    /// Frames from when one is made until it is shown, but for the time that the line takes.
    pub fn delay(self, line: &LineSettings) -> u32 {
        self.look() + self.together + line.ahead
    }
}

/// A channel that is made while it is sent.
#[derive(Clone, Copy, Debug)]
pub struct LiveChannel {
    /// What it may be off by, in raw units: at least 1.
    pub bound: i32,
    /// How far it may go, from one end to the other, in raw units.
    pub way: u32,
    /// Whether values wrap as angles do: the way from one to the next is the short one around.
    pub wraps: bool,
}

#[derive(Clone, Debug)]
struct ChannelEncoder {
    channel: u16,
    step: u8,
    bound: i64,
    wraps: bool,
    longest: usize,
    /// The frames after which its second refresh comes: refreshes of all channels at one frame would hold up the line.
    spread: u32,
    state: [i32; 4],
    due: u32,
    /// The frame by which a refresh must come.
    by: u32,
}

/// Codes frames as they come.
#[derive(Debug)]
pub struct Live<'s> {
    schedule: Schedule<'s>,
    line: LineSettings,
    timing: LiveTiming,
    begin: u32,
    channels: Vec<ChannelEncoder>,
    /// Frames from the one on that is coded next.
    frames: VecDeque<Vec<i32>>,
    next: u32,
    told: Vec<ScheduledMessage>,
    omitted_messages: u32,
}

impl Source {
    /// Motion that is yet to be made: all channels of the pose.
    pub fn live(form: Form, frame_time_ns: u32, making: &[LiveChannel]) -> Source {
        let frames = (500_000_000 / frame_time_ns.max(1)).max(1);
        let start = |making: &LiveChannel| {
            let step = (0..=MAX_STEP).rev().find(|&step| step_size(step) <= making.bound.max(1) as u32).unwrap_or(0);
            let wanted = u64::from(making.way) * 4 / u64::from(frames);
            let pace = (0..=MAX_PACE).find(|&index| pace(index) as u64 >= wanted).unwrap_or(MAX_PACE);
            ChannelKind::Moving { step, pace }
        };
        let head = Head { form, frames: MAX_FRAMES, frame_time_ns, channels: making.len() as u16, ..Head::default() };
        Source { head, starts: making.iter().map(start).collect(), tracks: vec![], events: vec![] }
    }
}

impl<'s> Live<'s> {
    pub(super) fn new(
        source: &'s Source,
        head: Head,
        (line, timing): (LineSettings, LiveTiming),
        making: &[LiveChannel],
        sequence: u8,
    ) -> Self {
        let (mut channels, making_count) = (vec![], making.len() as u32);
        for (channel, (start, making)) in source.starts.iter().zip(making).enumerate() {
            if let &ChannelKind::Moving { step, .. } = start {
                let (channel, bound) = (channel as u16, i64::from(making.bound));
                let (wraps, longest) = (making.wraps, timing.longest);
                let spread = line.cycle * (u32::from(channel) + 1) / making_count.max(1);
                channels.push(ChannelEncoder { channel, step, bound, wraps, longest, spread, state: [0; 4], due: 0, by: 0 });
            }
        }
        let start = -f64::from(timing.delay(&line)) * source.frame_seconds();
        let schedule = Schedule::new(source, head, line, Some(0), sequence, start);
        let (frames, begin) = (VecDeque::new(), head.begin);
        Live { schedule, line, timing, begin, channels, frames, next: 0, told: vec![], omitted_messages: 0 }
    }

    /// Takes the next frame, and hands on what is to leave now.
    pub fn push(&mut self, pose: &[i32]) -> Vec<TimedPacket> {
        self.frames.push_back(pose.to_vec());
        if self.frames.len() as u32 > self.timing.look() {
            self.code();
            self.frames.pop_front();
            self.next += 1;
        }
        let made = self.next + self.frames.len() as u32;
        let now = (f64::from(made) - f64::from(self.timing.delay(&self.line))) * self.schedule.frame_seconds();
        let behind = self.schedule.idle_until(now);
        if self.next > 0 && self.next.is_multiple_of(self.timing.together) {
            let told = std::mem::take(&mut self.told);
            // Receivers notice, and wait for the next refresh.
            if behind > f64::from(self.line.ahead.max(MOST_BEHIND)) * self.schedule.frame_seconds() {
                self.omitted_messages += told.len() as u32;
            } else {
                self.schedule.add(pack(&told, self.begin));
            }
        }
        self.schedule.by_ref().collect()
    }

    /// What the line has carried.
    pub fn bytes(&self) -> ByteCounts {
        self.schedule.bytes()
    }

    /// Messages that the line had no room for.
    pub fn omitted_messages(&self) -> u32 {
        self.omitted_messages
    }

    /// Codes the frame in front.
    fn code(&mut self) {
        for coding in &mut self.channels {
            let goal = |ahead: usize| {
                self.frames.get(ahead).and_then(|pose| pose.get(usize::from(coding.channel))).copied().unwrap_or(0)
            };
            let goals: Vec<i32> = (0..=self.timing.look() as usize).map(goal).collect();
            if coding.due == self.next {
                let message = coding.choose(&goals, self.next, self.line.cycle);
                coding.state = message.apply(coding.state, coding.step);
                coding.due += u32::from(message.run);
                self.told.push(ScheduledMessage { frame: self.next, channel: coding.channel, message });
            }
            let [p, v, w, k] = coding.state;
            coding.state = [p.wrapping_add(v), v.wrapping_add(w), w.wrapping_add(k), k];
        }
    }
}

impl ChannelEncoder {
    /// The longest segment from here on that stays within the bound; `goals` are this frame's value and those after it.
    fn choose(&mut self, goals: &[i32], frame: u32, cycle: u32) -> Message {
        let refresh = (frame == 0 || frame + u32::from(LENGTHS[self.longest]) > self.by).then(|| {
            self.by = frame + if frame == 0 { self.spread } else { cycle };
            let [p, v] = if frame == 0 { [goals[0], goals[1].wrapping_sub(goals[0])] } else { [self.state[0], self.state[1]] };
            let unit = units(self.step);
            let rounded = |value: i32, unit: i32| (i64::from(value) + i64::from(unit / 2)).div_euclid(i64::from(unit)) as i32;
            Refresh { p: rounded(p, unit[0]), v: rounded(v, unit[1]), w: 0 }
        });
        let from = Message { mode: 0, run: 1, w: 0, k: 0, refresh }.apply(self.state, self.step);
        let fits = (1..=self.longest)
            .rev()
            .find_map(|index| self.segment(index, from, goals).filter(|(_, off)| *off <= self.bound).map(|(w, _)| (index, w)));
        let (index, w) = fits.unwrap_or_else(|| (0, self.segment(0, from, goals).map_or(0, |(w, _)| w)));
        Message { mode: index as u8, run: LENGTHS[index], w, k: 0, refresh }
    }

    /// The acceleration in steps that comes nearest to the goals over a segment of this length, and how far it is off at most.
    fn segment(&self, index: usize, [p, v, ..]: [i32; 4], goals: &[i32]) -> Option<(i32, i64)> {
        let unit = i64::from(segment::step(index as u8, self.step));
        let last = usize::from(LENGTHS[index]) + 1;
        // What is left at frame j, and what a step of acceleration does there.
        let rest = |j: usize| {
            let rest = i64::from(goals[j]) - i64::from(p) - j as i64 * i64::from(v);
            // An angle's way is the short one around.
            if self.wraps { i64::from(rest as i32) } else { rest }
        };
        let by = |j: usize| (j * (j - 1) / 2) as i64 * unit;
        let product: f64 = (2..=last).map(|j| rest(j) as f64 * by(j) as f64).sum();
        let square: f64 = (2..=last).map(|j| by(j) as f64 * by(j) as f64).sum();
        let w = (product / square).round() as i64;
        let off = (2..=last).map(|j| (rest(j) - w * by(j)).abs()).max()?;
        Some((i32::try_from(w).ok()?, off))
    }
}
