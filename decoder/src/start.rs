//! How channels begin: at rest, with a constant, or with a position and a velocity.

use crate::bytes::unzigzag;
use crate::channel::{ChannelState, step_size};
use crate::clip::Clip;
use crate::entropy::{Cursor, Symbols, Table};
use crate::kind::Kind;
use crate::layout::{FIRST_STEP, FOLLOW_BITS, MAX_STEP, STEP_BITS, STEP_CHANGES, status};
use crate::play_state::{self, Channels};
use crate::rig::{ChannelIter, Rig};
use crate::tables;

/// What the channels read so far tell about the next one.
#[derive(Clone, Copy, Debug)]
struct ChannelStart {
    statuses: Statuses,
    steps: [u8; 2],
}

impl Default for ChannelStart {
    fn default() -> Self {
        ChannelStart { statuses: Statuses::default(), steps: [FIRST_STEP; 2] }
    }
}

impl ChannelStart {
    /// Reads the next channel's start: its position to `value` unless it rests or follows, velocity and index of its step to `state` if it
    /// moves. One that follows has the index [`MAX_STEP`] + how many of the moving channels before it it goes back. Returns whether it moves.
    #[inline(never)]
    fn read(&mut self, symbols: &mut Symbols<'_>, kind: Kind, value: &mut i32, state: &mut ChannelState) -> bool {
        let status = symbols.symbol(tables::status(self.statuses.context(kind))) as u8;
        self.statuses.put(kind, status);
        if status == status::RESTS {
            return false;
        }
        if status == status::FOLLOWS {
            state.step = MAX_STEP + 1 + symbols.bits(FOLLOW_BITS) as u8;
            return true;
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
        *value = magnitude(symbols, &tables::POSITION).wrapping_mul((grid >> 1).max(1) as i32);
        if status == status::CONSTANT {
            return false;
        }
        state.v = magnitude(symbols, &tables::VELOCITY).wrapping_mul((grid >> 2).max(1) as i32);
        state.step = step;
        true
    }
}

/// The statuses so far, as far as they tell about the next one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Statuses {
    last: u8,
    /// Of the last channel of each kind, two bits each.
    of_kinds: u32,
}

impl Statuses {
    /// Which of a status's contexts ([`crate::layout::STATUS_CONTEXTS`]) a channel of this kind has.
    pub fn context(&self, kind: Kind) -> u8 {
        let of_kind = (self.of_kinds >> (2 * kind as u32)) as u8 & 3;
        (u8::from(kind.is_position()) << 4) | (self.last << 2) | of_kind
    }

    /// Notes the channel's status.
    pub fn put(&mut self, kind: Kind, status: u8) {
        let shift = 2 * kind as u32;
        self.of_kinds = self.of_kinds & !(3 << shift) | u32::from(status & 3) << shift;
        self.last = status & 3;
    }
}

/// A signed number: the symbol is its length in bits, then come the bits below the highest, then the sign.
fn magnitude(symbols: &mut Symbols<'_>, table: &Table) -> i32 {
    let bits = symbols.symbol(table);
    let Some(below) = bits.checked_sub(1) else { return 0 };
    let value = (1 << below.min(31)) | symbols.long_bits(below.min(31)) as i32;
    if symbols.bits(1) == 0 { value } else { value.wrapping_neg() }
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
    /// In a function of its own, so that a second copy is not on the stack while the starts are read.
    #[inline(never)]
    pub(crate) fn new(rig: &Rig<'a>, length_exponent: i8) -> ChannelStarts<'a> {
        let shift = i32::from(rig.length_exponent()) - i32::from(length_exponent);
        ChannelStarts { slots: rig.slots(), opening: ChannelStart::default(), shift, slot: 0, moving: 0 }
    }

    /// Reads on, up to the last position at which a start is sure to be whole, and returns whether that were all. `states` and `pose` take what
    /// they have room for.
    #[inline(never)]
    pub(crate) fn read(&mut self, symbols: &mut Symbols<'_>, dry_at: u32, states: &mut [ChannelState], pose: &mut [i32]) -> bool {
        while symbols.at.position <= dry_at {
            let Some((kind, rest)) = self.slots.next() else {
                let states = states.get_mut(..usize::from(self.moving)).unwrap_or(&mut []);
                play_state::follow(&mut Channels { states, pose });
                return true;
            };
            let mut value = shifted(rest, self.shift);
            let mut state = ChannelState { slot: self.slot, ..ChannelState::NEW };
            if self.opening.read(symbols, kind, &mut value, &mut state) {
                if let Some(place) = states.get_mut(usize::from(self.moving)) {
                    *place = state;
                }
                self.moving += 1;
            }
            if let Some(place) = pose.get_mut(usize::from(self.slot)) {
                *place = value;
            }
            self.slot += 1;
        }
        false
    }
}

impl Clip<'_> {
    /// The values at frame 0 of the moving channels, one after the other, by their numbers; those of channels that follow mean nothing.
    #[inline(never)]
    pub(crate) fn first_values(&self, each: &mut dyn FnMut(usize, i32)) {
        let input = self.input();
        let mut starts = ChannelStarts::new(&self.rig(), self.length_exponent());
        let mut symbols = Symbols { at: Cursor::start(&input, self.symbols()), input };
        let mut moving = 0;
        for (kind, rest) in starts.slots.by_ref() {
            let (mut value, mut state) = (shifted(rest, starts.shift), ChannelState::NEW);
            if starts.opening.read(&mut symbols, kind, &mut value, &mut state) {
                each(moving, value);
                moving += 1;
            }
        }
    }
}

/// A rest offset in the clip's unit, rounded down.
pub(crate) fn shifted(rest: i32, shift: i32) -> i32 {
    if shift >= 0 { rest.wrapping_shl(shift as u32) } else { rest >> shift.unsigned_abs().min(31) }
}
