//! How channels begin: at rest, with a constant, or with a position and a velocity.

use crate::bytes::unzigzag;
use crate::channel::{ChannelState, step_size};
use crate::entropy::{Symbols, Table};
use crate::kind::Kind;
use crate::layout::{FIRST_STEP, FOLLOW_BITS, MAX_STEP, STEP_BITS, STEP_CHANGES, status};
use crate::play_state::{self, Channels};
use crate::rig::{ChannelIter, Rig};
use crate::tables;

/// What the channels read so far tell about the next one.
#[derive(Clone, Copy, Debug)]
struct ChannelStart {
    status: u8,
    steps: [u8; 2],
}

impl Default for ChannelStart {
    fn default() -> Self {
        ChannelStart { status: 0, steps: [FIRST_STEP; 2] }
    }
}

impl ChannelStart {
    /// The next channel's start: its position unless it rests, and velocity and index of its step if it moves. One that follows
    /// has the index [`MAX_STEP`] + how many of the moving channels before it it goes back.
    #[inline(never)]
    fn read(&mut self, symbols: &mut Symbols<'_>, kind: Kind) -> (Option<i32>, Option<(i32, u8)>) {
        let status = symbols.symbol(tables::status(self.status)) as u8;
        self.status = status;
        if status == status::RESTS {
            return (None, None);
        }
        if status == status::FOLLOWS {
            return (None, Some((0, MAX_STEP + 1 + symbols.bits(FOLLOW_BITS) as u8)));
        }
        let class = usize::from(kind.is_position());
        let change = symbols.symbol(&tables::STEP_CHANGE);
        let step = if change < STEP_CHANGES {
            self.steps.get(class).copied().unwrap_or(FIRST_STEP).wrapping_add(unzigzag(change) as u8)
        } else {
            symbols.bits(STEP_BITS) as u8
        };
        let step = step.min(MAX_STEP);
        if let Some(last) = self.steps.get_mut(class) {
            *last = step;
        }
        let grid = step_size(step);
        let p = magnitude(symbols, &tables::POSITION).wrapping_mul((grid >> 1).max(1) as i32);
        if status == status::CONSTANT {
            return (Some(p), None);
        }
        let v = magnitude(symbols, &tables::VELOCITY).wrapping_mul((grid >> 2).max(1) as i32);
        (Some(p), Some((v, step)))
    }
}

/// A signed number: the symbol is its length in bits, then come the bits below the highest, then the sign.
fn magnitude(symbols: &mut Symbols<'_>, table: &Table) -> i32 {
    let bits = symbols.symbol(table);
    let Some(below) = bits.checked_sub(1) else { return 0 };
    let value = (1 << below.min(31)) | symbols.long_bits(below.min(31)) as i32;
    if symbols.bits(1) == 0 { value } else { value.wrapping_neg() }
}

/// What became of reading the starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Opened {
    /// All are read.
    Done,
    /// The input ran dry: go on when it holds more.
    NeedMore,
    /// There are more moving channels than states.
    Full,
}

/// Reads the starts of a rig's channels, one after the other.
#[derive(Clone, Debug)]
pub(crate) struct ChannelStarts<'a> {
    slots: ChannelIter<'a>,
    opening: ChannelStart,
    /// Steps of the rig's offsets in those of the clip: 2^shift.
    shift: i32,
    slot: u16,
    /// Moving channels so far.
    pub(crate) moving: u16,
}

impl<'a> ChannelStarts<'a> {
    pub(crate) fn new(rig: &Rig<'a>, length_exponent: i8) -> ChannelStarts<'a> {
        let shift = i32::from(rig.length_exponent()) - i32::from(length_exponent);
        ChannelStarts { slots: rig.slots(), opening: ChannelStart::default(), shift, slot: 0, moving: 0 }
    }

    /// Reads on, up to the last position at which a start is sure to be whole. `pose` has a value for every channel.
    pub(crate) fn read(
        &mut self,
        symbols: &mut Symbols<'_>,
        dry_at: u32,
        states: &mut [ChannelState],
        pose: &mut [i32],
    ) -> Opened {
        while symbols.at.position <= dry_at {
            let Some((kind, rest)) = self.slots.next() else {
                let states = states.get_mut(..usize::from(self.moving)).unwrap_or(&mut []);
                play_state::follow(&mut Channels { states, pose });
                return Opened::Done;
            };
            let (p, start) = self.opening.read(symbols, kind);
            if let Some(value) = pose.get_mut(usize::from(self.slot)) {
                *value = p.unwrap_or(shifted(rest, self.shift));
            }
            if let Some((v, step)) = start {
                let Some(state) = states.get_mut(usize::from(self.moving)) else { return Opened::Full };
                *state = ChannelState { v, slot: self.slot, step, ..ChannelState::default() };
                self.moving += 1;
            }
            self.slot += 1;
        }
        Opened::NeedMore
    }

    /// Number of moving channels, all starts being at hand.
    pub(crate) fn count(self, symbols: &mut Symbols<'_>) -> usize {
        let ChannelStarts { mut opening, slots, .. } = self;
        slots.filter(|&(kind, _)| opening.read(symbols, kind).1.is_some()).count()
    }
}

/// A rest offset in the clip's unit, rounded down.
fn shifted(rest: i32, shift: i32) -> i32 {
    if shift >= 0 { rest.wrapping_shl(shift as u32) } else { rest >> shift.unsigned_abs().min(31) }
}
