//! The line of the soak test and the sender at its end: what goes wrong, and when.

use pantin_line::sender::{LineSettings, Schedule, Sender, Source, TimedPacket};

use super::{ANNOUNCED, Seen};
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
/// Seconds between restarts of the sender, and between its stalls, on average.
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

/// A line that damages packets for a while and is whole for a while, and its sender, which restarts and stalls. Times are the receiver's, in seconds.
pub(super) struct Line<'s> {
    source: &'s Source,
    settings: LineSettings,
    /// Chooses when what happens.
    noise: Lossy,
    /// Damages packets.
    lossy: Lossy,
    sending: Sending<'s>,
    session: u16,
    sender_restart: f64,
    stall: f64,
    damage: Damage,
    /// When the damage changes.
    damage_end: f64,
    /// Seconds after a disturbance in which the receiver may lack states.
    settle: f64,
    /// When it must have all again.
    settled: f64,
}

impl<'s> Line<'s> {
    pub fn new(source: &'s Source, settings: LineSettings, seed: u64) -> Line<'s> {
        let frame = source.frame_seconds();
        let settle = f64::from(settings.cycle + settings.ahead) * frame + MARGIN_FRAMES * frame;
        let mut session = 0;
        let mut line = Line {
            source,
            settings,
            noise: Lossy::new(seed),
            lossy: Lossy::new(seed + 1),
            sending: begin(source, settings, &mut session, 0.0),
            session,
            sender_restart: 0.0,
            stall: 0.0,
            damage: Damage::default(),
            damage_end: 0.0,
            settle,
            settled: settle + ANNOUNCED,
        };
        (line.sender_restart, line.stall) = (line.soon(SENDER_RESTARTS), line.soon(STALLS));
        line.damage_end = line.soon(WHOLE);
        line
    }

    /// A duration by chance: 0.2 to 1.8 of these seconds.
    pub fn soon(&mut self, seconds: f64) -> f64 {
        (0.2 + 1.6 * self.noise.chance()) * seconds
    }

    /// The receiver may lack states until then.
    fn unsettle(&mut self, until: f64) {
        self.settled = self.settled.max(until);
    }

    /// A receiver that restarts waits for all announcements again.
    pub fn receiver_restarted(&mut self, time: f64) {
        self.unsettle(time + self.settle + ANNOUNCED);
    }

    /// Whether every channel must be exact.
    pub fn is_whole(&self, time: f64) -> bool {
        self.damage == Damage::default() && time > self.settled
    }

    /// Changes the damage, restarts the sender and stalls it, each when its time has come.
    pub fn disturb(&mut self, time: f64, seen: &mut Seen) {
        if time > self.damage_end {
            if self.damage == Damage::default() {
                self.damage = DAMAGES[(self.soon(1e6) as usize) % DAMAGES.len()];
                self.damage_end = time + self.soon(DAMAGING);
            } else {
                self.unsettle(time + self.settle);
                (self.damage, self.damage_end) = (Damage::default(), time + self.soon(WHOLE));
            }
        }
        if time > self.sender_restart {
            self.sending = begin(self.source, self.settings, &mut self.session, time);
            self.sender_restart = time + self.soon(SENDER_RESTARTS);
            self.unsettle(time + self.settle + ANNOUNCED);
            seen.sender_restarts += 1;
        }
        if time > self.stall {
            let stopped = self.soon(STALL / 1.8);
            self.sending.offset += stopped;
            self.stall = time + self.soon(STALLS);
            self.unsettle(time + stopped + self.settle);
            seen.stalls += 1;
        }
    }

    /// Passes on the bytes of the packets that have arrived, as the line leaves them.
    pub fn deliver(&mut self, time: f64, seen: &mut Seen, mut receive: impl FnMut(u8)) {
        while self.sending.arrival(self.settings).is_some_and(|arrival| arrival <= time) {
            let Some(packet) = std::mem::replace(&mut self.sending.next, self.sending.schedule.next()) else { break };
            let (bytes, harmed) = self.lossy.pass(&packet.bytes, self.damage);
            seen.packets += 1;
            seen.harmed += u64::from(harmed);
            bytes.into_iter().for_each(&mut receive);
        }
    }
}

/// A sender that starts now.
fn begin<'s>(source: &'s Source, line: LineSettings, session: &mut u16, now: f64) -> Sending<'s> {
    *session = session.wrapping_add(1);
    let mut schedule = Sender::new(*session).clip(source, line, None);
    let next = schedule.next();
    let first = next.as_ref().map_or(0.0, |packet| packet.at);
    Sending { schedule, offset: now - first, next }
}
