//! What a channel's start costs: its status and step are predicted from other channels', and predict others' in turn.

use super::cost::Costs;
use crate::encode::clip::{Start, step_change};
use crate::encode::entropy::cost;
use pantin::Kind;
use pantin::codec::layout::{FIRST_STEP, FOLLOW_BITS, MAX_STEP, STATUSES, STEP_BITS, STEP_CHANGES, status};
use pantin::codec::{Statuses, tables};

/// Bits of one channel's status and step, with what they change for the channels after it.
#[derive(Clone, Debug)]
pub struct StartCosts {
    statuses: [f64; STATUSES],
    steps: [f32; MAX_STEP as usize + 1],
}

impl Default for StartCosts {
    /// About what they cost where the others are unknown.
    fn default() -> StartCosts {
        StartCosts { statuses: [0.4, 1.0, 1.0, 2.0], steps: [3.5; MAX_STEP as usize + 1] }
    }
}

/// A start's status.
pub fn status_of(start: &Start) -> u8 {
    match start {
        Start::Rest => status::RESTS,
        Start::Constant { .. } => status::CONSTANT,
        Start::Moving { .. } => status::MOVES,
        Start::Follows { .. } => status::FOLLOWS,
    }
}

/// Index of the channel's step, if it has one.
pub fn step_of(start: &Start) -> Option<u8> {
    match *start {
        Start::Rest | Start::Follows { .. } => None,
        Start::Constant { step, .. } | Start::Moving { step, .. } => Some(step),
    }
}

/// Bits of a step after another of its class.
fn change(before: u8, step: u8) -> f64 {
    let symbol = step_change(before, step);
    cost(&tables::STEP_CHANGE, symbol.min(STEP_CHANGES)) + if symbol >= STEP_CHANGES { f64::from(STEP_BITS) } else { 0.0 }
}

impl StartCosts {
    /// The costs for one of the channels, whose kinds and, where they are known, starts are given.
    pub fn of<'s>(channel: usize, kinds: &[Kind], start: impl Fn(usize) -> Option<&'s Start>) -> StartCosts {
        let kind = kinds[channel];
        // A channel that is not known yet most likely moves.
        let status_at = |channel: usize| start(channel).map_or(status::MOVES, status_of);
        let mut before = Statuses::default();
        (0..channel).for_each(|other| before.put(kinds[other], status_at(other)));
        // The next channel, and the next of this kind, have this one in their contexts.
        let next = Some(channel + 1).filter(|&next| next < kinds.len());
        let of_kind = (channel + 1..kinds.len()).find(|&other| kinds[other] == kind);
        let last = next.max(of_kind).unwrap_or(channel);
        let statuses = std::array::from_fn(|own| {
            let mut statuses = before;
            let mut bits = cost(tables::status(statuses.context(kind)), own as u32);
            statuses.put(kind, own as u8);
            for (other, &kind) in kinds.iter().enumerate().take(last + 1).skip(channel + 1) {
                let theirs = status_at(other);
                if Some(other) == next || Some(other) == of_kind {
                    bits += cost(tables::status(statuses.context(kind)), u32::from(theirs));
                }
                statuses.put(kind, theirs);
            }
            bits
        });
        let class = |other: &usize| kinds[*other].is_position() == kind.is_position();
        let step_at = |other: usize| start(other).and_then(step_of);
        let before = (0..channel).rev().filter(class).find_map(step_at).unwrap_or(FIRST_STEP);
        let after = (channel + 1..kinds.len()).filter(class).find_map(step_at);
        let chain = |step: u8| change(before, step) + after.map_or(0.0, |after| change(step, after));
        let without = after.map_or(0.0, |after| change(before, after));
        StartCosts { statuses, steps: std::array::from_fn(|step| (chain(step as u8) - without) as f32) }
    }

    /// Bits of a step, beyond those of none.
    pub fn step(&self, step: u8) -> f64 {
        self.steps.get(usize::from(step)).copied().map_or(0.0, f64::from)
    }

    /// Bits of a whole start.
    pub fn bits(&self, start: &Start) -> f64 {
        let status = self.statuses[usize::from(status_of(start))];
        status
            + match *start {
                Start::Rest => 0.0,
                Start::Constant { p, step } => self.step(step) + Costs::get().position(p),
                Start::Moving { p, v, step } => self.step(step) + Costs::get().start(p, v),
                Start::Follows { .. } => f64::from(FOLLOW_BITS),
            }
    }
}
