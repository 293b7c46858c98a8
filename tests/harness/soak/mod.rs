//! A receiver that listens for hours of clip time, at simulated time: the line damages packets, both ends restart, the sender stalls, and their clocks
//! drift. Every frame is checked.

mod line;
mod listener;

use anyhow::{Result, ensure};
use line::Line;
use listener::Listener;
use pantin_line::sender::{LineSettings, Source};
use pantin_link::Channel;

/// Seconds between restarts of the receiver, on average.
const RECEIVER_RESTARTS: f64 = 600.0;
/// Seconds that HEAD and all STARTS packets take to come again: what a receiver that restarted waits for.
const ANNOUNCED: f64 = 6.0;

/// What was seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Frames that the receiver showed.
    pub frames: u64,
    /// Frames on which every channel was exact.
    pub exact: u64,
    /// Frames on which a channel that was reported as exact was not.
    pub wrong: u64,
    /// Frames long after any disturbance on which a channel was not exact, or time stood still.
    pub late: u64,
    /// Packets sent, and those that the line damaged or dropped.
    pub packets: u64,
    /// Packets damaged or dropped.
    pub harmed: u64,
    /// Restarts of the receiver.
    pub receiver_restarts: u32,
    /// Restarts of the sender.
    pub sender_restarts: u32,
    /// Stalls of the sender.
    pub stalls: u32,
}

/// Plays a clip around and around for this many hours. `each_minute` receives what was seen so far.
pub fn run(source: &Source, settings: LineSettings, hours: f64, seed: u64, mut each_minute: impl FnMut(&Seen)) -> Result<Seen> {
    let states = source.expected_states(settings.cycle);
    ensure!(!states.is_empty(), "the clip has no channel that moves");
    let frame = source.frame_seconds();
    let (mut memory, mut pose) = (vec![Channel::default(); source.channels()], vec![0; source.channels()]);
    let mut seen = Seen::default();
    let (mut time, end, mut minute) = (0.0, 3600.0 * hours, 60.0);
    let mut line = Line::new(source, settings, seed);
    while time < end {
        let restart = time + line.soon(RECEIVER_RESTARTS);
        let mut listener = Listener::new(source, settings, &mut memory, &mut pose);
        while time < restart.min(end) {
            time += frame;
            line.disturb(time, &mut seen);
            line.deliver(time, &mut seen, |byte| listener.push(byte));
            listener.step(&states, line.is_whole(time), &mut seen);
            if time > minute {
                minute += 60.0;
                each_minute(&seen);
            }
        }
        seen.receiver_restarts += u32::from(time < end);
        line.receiver_restarted(time);
    }
    Ok(seen)
}
