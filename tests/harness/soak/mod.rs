//! A receiver that listens for hours of clip time, at simulated time: the line damages packets, both ends restart, the sender stalls, and their clocks
//! drift. Every frame is checked.

use anyhow::{Result, ensure};
use pantin_line::sender::{LineSettings, Schedule, Sender, Source, TimedPacket};
use pantin_link::packet::Receiver;
use pantin_link::{Channel, Link, MAX_PACKET, QUEUE_PACKETS};

use crate::lossy::{Damage, Lossy};

/// What the line does for a while, each in turn.
const DAMAGES: [Damage; 6] = [
    Damage { loss: 0.05, flips: 0.0 },
    Damage { loss: 0.3, flips: 0.0 },
    Damage { loss: 0.0, flips: 1e-4 },
    Damage { loss: 0.1, flips: 1e-3 },
    Damage { loss: 1.0, flips: 0.0 },
    Damage { loss: 0.0, flips: 1e-2 },
];
/// Seconds that the line damages, and is whole, at most.
const DAMAGING: f64 = 4.0;
const WHOLE: f64 = 12.0;
/// Seconds between restarts of the receiver, restarts of the sender and stalls of the sender, on average.
const RECEIVER_RESTARTS: f64 = 600.0;
const SENDER_RESTARTS: f64 = 1020.0;
const STALLS: f64 = 420.0;
/// Seconds of the longest stall.
const STALL: f64 = 6.0;
/// Largest difference of the clocks' speeds, in parts per million: two cheap crystals, one of them warm.
const DRIFT_PPM: f64 = 200.0;
/// Seconds in which the drift goes from one end to the other and back.
const DRIFT_SECONDS: f64 = 1800.0;
/// Frames after a disturbance, more than the cycle and the look-ahead, after which every channel must be exact.
const MARGIN_FRAMES: f64 = 30.0;
/// Seconds that HEAD and all STARTS packets take to come again: what a receiver that restarted waits for.
const ANNOUNCED: f64 = 6.0;

/// Frames in a row that may stand still while the clock waits for the sender's.
const MAX_STILL: u32 = 2;

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

/// The sender's side of the line, in the receiver's time.
struct Sending<'s> {
    schedule: Schedule<'s>,
    /// The receiver's time at the sender's time 0, by stalls and restarts.
    offset: f64,
    next: Option<TimedPacket>,
}

impl Sending<'_> {
    /// The next packet, and when it has arrived.
    fn arrival(&mut self, line: LineSettings) -> Option<f64> {
        let next = self.next.as_ref()?;
        let there = next.at + next.bytes.len() as f64 / line.rate;
        Some(there + self.offset + drift(there + self.offset))
    }
}

/// By how many seconds a packet arrives later than without drift.
fn drift(time: f64) -> f64 {
    let turn = std::f64::consts::TAU / DRIFT_SECONDS;
    DRIFT_PPM / 1e6 * (time * turn).sin() / turn
}

/// Plays a clip around and around for this many hours. `each_minute` receives what was seen so far.
pub fn run(source: &Source, line: LineSettings, hours: f64, seed: u64, mut each_minute: impl FnMut(&Seen)) -> Result<Seen> {
    let states = source.expected_states(line.cycle);
    ensure!(!states.is_empty(), "the clip has no channel that moves");
    let mut noise = Lossy::new(seed);
    let mut soon = |seconds: f64| (0.2 + 1.6 * noise.chance()) * seconds;
    let channels = source.channels();
    let frame = source.frame_seconds();
    let settle = f64::from(line.cycle + line.ahead) * frame + MARGIN_FRAMES * frame;
    let (mut states_memory, mut pose) = (vec![Channel::default(); channels], vec![0; channels]);
    let mut seen = Seen::default();
    let (mut session, mut time, end) = (0u16, 0.0, 3600.0 * hours);
    let (mut sender_restart, mut stall) = (soon(SENDER_RESTARTS), soon(STALLS));
    let (mut damage, mut damage_end) = (Damage::default(), soon(WHOLE));
    // Until then the receiver may lack states.
    let mut settled = settle + ANNOUNCED;
    let mut minute = 60.0;
    let mut sending = begin(source, line, &mut session, 0.0);
    let mut lossy = Lossy::new(seed + 1);
    while time < end {
        let restart = time + soon(RECEIVER_RESTARTS);
        let mut link = Link::<QUEUE_PACKETS>::new(source.form(), &mut states_memory, &mut pose);
        let mut receiver = if line.parity { Receiver::<MAX_PACKET>::with_parity() } else { Receiver::new() };
        let (mut before, mut still) = (None, 0);
        while time < restart.min(end) {
            time += frame;
            if time > damage_end {
                let damages = damage != Damage::default();
                (damage, damage_end) = if damages {
                    settled = settled.max(time + settle);
                    (Damage::default(), time + soon(WHOLE))
                } else {
                    (DAMAGES[(soon(1e6) as usize) % DAMAGES.len()], time + soon(DAMAGING))
                };
            }
            if time > sender_restart {
                sending = begin(source, line, &mut session, time);
                (sender_restart, settled) = (time + soon(SENDER_RESTARTS), settled.max(time + settle + ANNOUNCED));
                seen.sender_restarts += 1;
            }
            if time > stall {
                let stopped = soon(STALL / 1.8);
                sending.offset += stopped;
                (stall, settled) = (time + soon(STALLS), settled.max(time + stopped + settle));
                seen.stalls += 1;
            }
            while sending.arrival(line).is_some_and(|arrival| arrival <= time) {
                let Some(packet) = std::mem::replace(&mut sending.next, sending.schedule.next()) else { break };
                let (bytes, harmed) = lossy.pass(&packet.bytes, damage);
                seen.packets += 1;
                seen.harmed += u64::from(harmed);
                for byte in bytes {
                    if let Some(packet) = receiver.push(byte) {
                        // Chance may make a packet of another rig's clip.
                        let _ = link.receive(&packet);
                    }
                }
            }
            link.step();
            seen.frames += 1;
            let agrees = link.frame().is_none_or(|frame| {
                states.iter().all(|(channel, states)| {
                    let state = link.channels().get(usize::from(*channel)).and_then(Channel::state);
                    state.is_none_or(|state| states.get(frame as usize) == Some(&state))
                })
            });
            seen.wrong += u64::from(!agrees);
            seen.exact += u64::from(link.is_synced());
            still = if link.now() == before { still + 1 } else { 0 };
            before = link.now();
            let whole = damage == Damage::default() && time > settled;
            seen.late += u64::from(whole && !(link.is_synced() && still <= MAX_STILL));
            if time > minute {
                minute += 60.0;
                each_minute(&seen);
            }
        }
        seen.receiver_restarts += u32::from(time < end);
        settled = settled.max(time + settle + ANNOUNCED);
    }
    Ok(seen)
}

/// A sender that starts now.
fn begin<'s>(source: &'s Source, line: LineSettings, session: &mut u16, now: f64) -> Sending<'s> {
    *session = session.wrapping_add(1);
    let mut schedule = Sender::new(*session).clip(source, line, None);
    let next = schedule.next();
    let first = next.as_ref().map_or(0.0, |packet| packet.at);
    Sending { schedule, offset: now - first, next }
}
