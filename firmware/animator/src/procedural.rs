//! Motion without a clip: breath and blink.

use crate::layer::Weight;
use pantin::{Angle, ScalarRef};

/// A channel that a breath moves, and how far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BreathChannel {
    /// The index of the channel in a pose.
    pub channel: u16,
    /// The largest difference either way, in the channel's raw unit: an angle's in 2^-32 turns.
    pub amplitude: i32,
}

/// A slow sine on a few channels.
#[derive(Clone, Copy, Debug)]
pub struct Breath<'c> {
    channels: &'c [BreathChannel],
    /// In 2^-32 of a breath.
    phase: u32,
    rest: u32,
    period_us: u32,
}

impl<'c> Breath<'c> {
    /// A breath that takes a time (at least 1 us; people at rest: 4 to 5 s).
    pub const fn new(channels: &'c [BreathChannel], period_us: u32) -> Breath<'c> {
        Breath { channels, phase: 0, rest: 0, period_us: if period_us == 0 { 1 } else { period_us } }
    }

    /// Lets time pass, without drift.
    pub fn advance(&mut self, elapsed_us: u32) {
        let elapsed = elapsed_us.checked_rem(self.period_us).unwrap_or(0);
        let moved = (u64::from(elapsed) << 32) + u64::from(self.rest);
        let period = u64::from(self.period_us);
        self.phase = self.phase.wrapping_add(moved.checked_div(period).unwrap_or(0) as u32);
        self.rest = moved.checked_rem(period).unwrap_or(0) as u32;
    }

    /// Adds the breath to a pose, times a weight.
    pub fn apply(&self, pose: &mut [i32], weight: Weight) {
        let (sin, _) = pantin_math::trig::sin_cos(self.phase as i32);
        // Q15 by Q15: the sine's sign and the weight in one factor.
        let magnitude = Weight::from_bits(((sin.unsigned_abs() * u32::from(weight.to_bits())) >> 15) as u16);
        for channel in self.channels {
            if let Some(value) = pose.get_mut(usize::from(channel.channel)) {
                let moved = magnitude.of(channel.amplitude);
                *value = if sin < 0 { value.wrapping_sub(moved) } else { value.wrapping_add(moved) };
            }
        }
    }
}

/// Two scalars that close for a moment, now and then.
#[derive(Clone, Copy, Debug)]
pub struct Blink {
    lids: [Option<ScalarRef>; 2],
    /// Time until the next blink begins or, while one runs, since it began.
    left_us: u32,
    since_us: u32,
    random: u32,
}

/// A lid closes for this time and opens for twice as long.
const CLOSES_US: u32 = 70_000;

impl Blink {
    /// Blinks of the scalars of one or two lids (`EyeBlinkLeft`, `EyeBlinkRight`), 2 to 6 s apart. Equal seeds blink at equal times.
    pub fn new(lids: [Option<ScalarRef>; 2], seed: u32) -> Blink {
        let mut blink = Blink { lids, left_us: 0, since_us: u32::MAX, random: seed | 1 };
        blink.left_us = blink.pause();
        blink
    }

    /// 2 to 6 s.
    fn pause(&mut self) -> u32 {
        // Xorshift (Marsaglia 2003).
        self.random ^= self.random << 13;
        self.random ^= self.random >> 17;
        self.random ^= self.random << 5;
        2_000_000 + (self.random >> 10)
    }

    /// Lets time pass.
    pub fn advance(&mut self, elapsed_us: u32) {
        self.since_us = self.since_us.saturating_add(elapsed_us);
        match self.left_us.checked_sub(elapsed_us) {
            Some(left) => self.left_us = left,
            None => {
                self.since_us = 0;
                self.left_us = self.pause();
            }
        }
    }

    /// How far the lids are closed.
    pub fn closed(&self) -> Weight {
        let part = |over: u32, under: u32| (over << 15).checked_div(under).unwrap_or(0);
        Weight::from_bits(match self.since_us {
            since if since <= CLOSES_US => part(since, CLOSES_US),
            since if since <= 3 * CLOSES_US => part(3 * CLOSES_US - since, 2 * CLOSES_US),
            _ => 0,
        } as u16)
    }

    /// Closes the lids of a pose by as much as they are open.
    pub fn apply(&self, pose: &mut [i32]) {
        let closed = self.closed();
        for lid in self.lids.iter().flatten() {
            // A weight of 1: its range is 2^exponent.
            let one = i32::MAX >> lid.exponent().clamp(0, 30);
            if let Some(value) = pose.get_mut(lid.channel()) {
                *value = value.wrapping_add(closed.of(one.wrapping_sub(*value)));
            }
        }
    }
}

/// Whole degrees (-180 to 179) as an amplitude, in 2^-32 turns.
pub const fn degrees(degrees: i32) -> i32 {
    Angle::from_degrees(fixed::types::I16F16::from_bits(degrees << 16)).to_bits()
}
