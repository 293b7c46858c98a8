//! Reads the channels of a key clip: how each begins, its grid and its key values.
//!
//! A rule that is broken is noted, as a `Result` a field would be much of an image's code; what follows is read to no effect, or not at all.

use super::grid::{Frames, Grid};
use super::layout::*;
use super::numbers::{Scale, divide};
use super::range::Bits;
use super::words;
use crate::channel::ChannelState;
use crate::layout::status;

/// A channel's keys in memory: for each key its value in thousandths and, in a spline, its second difference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Keys {
    pub(super) grid: Grid,
    pub(super) at: usize,
}

impl Keys {
    /// Those of a state.
    #[inline(never)]
    pub(super) fn of(states: &[ChannelState], state: &ChannelState) -> Keys {
        let word = u16::from_le_bytes([state.step, state.prev_sign as u8]);
        Keys { grid: Grid::at(states, word.into()), at: state.next.into() }
    }

    /// The value of a key in thousandths.
    #[inline(never)]
    pub(super) fn value(&self, states: &[ChannelState], key: usize) -> i32 {
        words::get(states, self.at + key * self.grid.stride())
    }

    fn set_value(&self, states: &mut [ChannelState], key: usize, thousandths: i32) {
        words::set(states, self.at + key * self.grid.stride(), thousandths);
    }
}

/// A channel of the rig.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channel {
    pub(super) slot: u16,
    pub(super) class: usize,
    /// `None` if its values cannot be coded.
    pub(super) scale: Option<Scale>,
    /// Its value at rest in thousandths.
    pub(super) rest: i32,
}

/// What predicts a channel's keys.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Source {
    /// The key before.
    Before,
    /// The channel itself half a cycle before.
    Half,
    /// The keys of an earlier channel.
    Leader,
}

/// How a channel's keys are predicted.
#[derive(Clone, Copy)]
struct Predictor {
    source: Source,
    negative: bool,
    /// Whether half a cycle is repeated without residuals.
    exact: bool,
    /// Where the leader's state is, and how many frames later it is read.
    leader: usize,
    shift: u32,
}

/// The reading of a clip's channels.
pub(super) struct Reading<'a, 'p> {
    bits: Bits<'a>,
    pub(super) states: &'p mut [ChannelState],
    pub(super) frames: Frames,
    /// Whether a rule is broken.
    pub(super) malformed: bool,
    /// Channels with keys so far.
    pub(super) moving: usize,
    /// Words in use.
    words: usize,
    grids: u32,
    /// The newest grid, and that of the last channel with keys.
    newest: usize,
    running: usize,
    /// Keys of the spline that has most.
    most_keys: usize,
    /// Statistics: the status before, the last quantum of each class, how far back the last leader was.
    status: u8,
    quanta: [u8; 3],
    distance: u32,
}

impl<'a, 'p> Reading<'a, 'p> {
    #[inline(always)]
    pub(super) fn new(bits: Bits<'a>, states: &'p mut [ChannelState], frames: Frames) -> Reading<'a, 'p> {
        Reading {
            bits,
            states,
            frames,
            malformed: false,
            moving: 0,
            words: 0,
            grids: 0,
            newest: 0,
            running: 0,
            most_keys: 0,
            status: status::RESTS,
            quanta: [FIRST_QUANTUM; 3],
            distance: 1,
        }
    }

    /// Reads the next channel; `value` becomes its value at frame 0 unless it rests or has keys.
    #[inline(never)]
    pub(super) fn channel(&mut self, channel: &Channel, value: &mut i32) {
        let class = channel.class;
        let before = 3 * usize::from(self.status) + class;
        self.status = if self.bits.bit(context::KEYED + before) {
            status::MOVES
        } else {
            u8::from(self.bits.bit(context::CONSTANT + before))
        };
        if self.status == status::RESTS {
            return;
        }
        let Some(scale) = channel.scale else { return self.fail() };
        let unit = self.quantum(class);
        let rest = divide(channel.rest.into(), unit) as i32;
        if self.status == status::CONSTANT {
            let (residual, _) = self.residual(0, 0);
            *value = scale.raw(self.thousandths(rest + residual, unit)) as i32;
            return;
        }
        let grid = self.grid();
        let keys = Keys { grid, at: self.words };
        self.take((grid.last() + 1) * grid.stride());
        if self.malformed {
            return;
        }
        let closed = self.bits.bit(context::CLOSED + 2 * class + usize::from(grid.last() == 1));
        let predictor = self.predictor(class, &grid);
        self.values(&keys, &predictor, rest, unit, closed);
        if let Some(state) = self.states.get_mut(self.moving) {
            (state.slot, state.mode, state.next) = (channel.slot, scale.0, keys.at as u16);
            (state.step, state.prev_sign) = (grid.at as u8, (grid.at >> 8) as i8);
        }
        self.moving += 1;
    }

    fn fail(&mut self) {
        self.malformed = true;
    }

    /// Takes words that no state of a channel needs, that of the running one included.
    #[inline(never)]
    fn take(&mut self, words: usize) {
        self.words += words;
        if self.words > MAX_WORDS || self.words > self.states.len().saturating_sub(self.moving + 1) * STATE_WORDS {
            self.words = 0;
            self.fail();
        }
    }

    /// The quantum of a channel in thousandths.
    fn quantum(&mut self, class: usize) -> u32 {
        let Some(last) = self.quanta.get_mut(class) else { return 1 };
        if !self.bits.bit(context::QUANTUM + class) {
            *last = self.bits.raw(QUANTUM_BITS) as u8;
        }
        if let Some(&quantum) = QUANTA.get(usize::from(*last)) {
            return quantum.into();
        }
        self.fail();
        1
    }

    /// The grid of a channel: that of the last one, an earlier one, or a new one.
    #[inline(never)]
    fn grid(&mut self) -> Grid {
        let mut interpolation = 4;
        if self.grids > 0 {
            let running = Grid::at(self.states, self.running);
            if self.bits.bit(context::SAME_GRID) {
                return running;
            }
            if !self.bits.bit(context::NEW_GRID) {
                let back = self.bits.raw(u32::BITS - (self.grids - 1).leading_zeros());
                self.malformed |= back >= self.grids;
                let mut grid = Grid::at(self.states, self.newest);
                for _ in 0..back {
                    grid = Grid::at(self.states, grid.before());
                }
                self.running = grid.at;
                return grid;
            }
            interpolation = running.interpolation();
        }
        let first = context::INTERPOLATION + 3 * usize::from(interpolation);
        let high = u8::from(self.bits.bit(first));
        let interpolation = high << 1 | u8::from(self.bits.bit(first + 1 + usize::from(high)));
        let grid = self.new_grid(interpolation);
        self.grids += 1;
        (self.newest, self.running) = (grid.at, grid.at);
        if grid.is_spline() {
            self.most_keys = self.most_keys.max(grid.last() + 1);
        }
        grid
    }

    /// Reads a new grid behind its interpolation.
    #[inline(never)]
    fn new_grid(&mut self, interpolation: u8) -> Grid {
        let (mut inner, mut end, mut half) = (0, self.frames.last, false);
        let mut last = 1;
        if !self.bits.bit(context::ENDS + usize::from(interpolation)) {
            half = self.frames.has_half() && self.bits.bit(context::HALF);
            inner = self.bits.gamma(context::COUNT);
            last = inner + 1;
            if half {
                end >>= 1;
                last *= 2;
            }
        }
        let at = self.words;
        self.malformed |= inner >= end;
        self.take(Grid::words(last));
        if self.malformed {
            return Grid::put(self.states, at, 1, interpolation, false, 0);
        }
        let grid = Grid::put(self.states, at, last, interpolation, half, self.newest);
        let mut frame = 0;
        for key in 0..=inner {
            grid.set_time(self.states, key as usize, frame);
            if half {
                grid.set_time(self.states, (key + inner + 1) as usize, frame + end);
            }
            if key < inner {
                frame += self.gap(end - frame, inner - key - 1);
            }
        }
        grid.set_time(self.states, last as usize, self.frames.last);
        grid
    }

    /// Frames to the next key time, of `room` frames to the end, if `after` times follow before that.
    fn gap(&mut self, room: u32, after: u32) -> u32 {
        // At least 1: there are fewer inner times than frames.
        let left = room - after - 1;
        let raw = gap_bits(left, after);
        let high = self.bits.unary(context::GAP + if raw == 0 { 0 } else { context::LONG }, (left - 1) >> raw);
        let gap = high << raw | self.bits.raw(raw);
        self.malformed |= gap >= left;
        1 + gap.min(left - 1)
    }

    #[inline(never)]
    fn predictor(&mut self, class: usize, grid: &Grid) -> Predictor {
        let mut predictor = Predictor { source: Source::Before, negative: false, exact: false, leader: 0, shift: 0 };
        if grid.has_half() && self.bits.bit(context::BY_HALF) {
            predictor.source = Source::Half;
            predictor.negative = self.bits.bit(context::SIGN);
            predictor.exact = self.bits.bit(context::EXACT);
        } else if self.moving > 0 && self.bits.bit(context::BY_LEADER + class) {
            predictor.source = Source::Leader;
            if !self.bits.bit(context::SAME_DISTANCE) {
                self.distance = 1 + self.bits.gamma(context::DISTANCE);
            }
            // Beyond all states if there are too few channels.
            predictor.leader = self.moving.wrapping_sub(self.distance as usize);
            predictor.negative = self.bits.bit(context::SIGN + 1);
            if self.frames.has_half() && self.bits.bit(context::SHIFT) {
                predictor.shift = self.frames.last >> 1;
            }
        }
        predictor
    }

    /// The value that the leader has at its own key of a frame, in thousandths.
    #[inline(never)]
    fn led(&mut self, leader: usize, mut frame: u32) -> i32 {
        let Some(state) = self.states.get(leader).filter(|_| leader < self.moving) else {
            self.fail();
            return 0;
        };
        let keys = Keys::of(self.states, state);
        let value = |key| keys.value(self.states, key);
        let mut drift = 0;
        if self.frames.looped && frame >= self.frames.last {
            frame -= self.frames.last;
            drift = value(keys.grid.last()) - value(0);
        }
        let key = keys.grid.key_at(self.states, frame);
        let value = value(key) + drift;
        if keys.grid.time(self.states, key) != frame {
            self.fail();
        }
        value
    }

    /// Reads the key values of a channel.
    #[inline(never)]
    fn values(&mut self, keys: &Keys, predictor: &Predictor, rest: i32, unit: u32, closed: bool) {
        let last = keys.grid.last();
        let (mut before, mut offset) = ([0; 2], 0);
        let mut value = rest;
        for key in 0..=last {
            if closed && key == last {
                let first = keys.value(self.states, 0);
                return keys.set_value(self.states, key, first);
            }
            let base = match predictor.source {
                Source::Half if key >= last / 2 && key < last => Some(keys.value(self.states, key - last / 2)),
                Source::Leader => {
                    let frame = keys.grid.time(self.states, key) + predictor.shift;
                    Some(self.led(predictor.leader, frame))
                }
                _ => None,
            };
            let other = usize::from(base.is_some());
            if let Some(base) = base {
                value = divide(base.into(), unit) as i32;
                value = if predictor.negative { -value } else { value } + offset;
            }
            if other == 0 || !predictor.exact {
                let class = before.get_mut(other);
                let (residual, next) = self.residual(other, class.as_deref().copied().unwrap_or(0));
                if let Some(class) = class {
                    *class = next;
                }
                // Below 2^29, but for values behind one that is out of bounds.
                value = value.wrapping_add(residual);
                if key == 0 && predictor.source == Source::Leader {
                    offset = residual;
                }
            }
            let thousandths = self.thousandths(value, unit);
            keys.set_value(self.states, key, thousandths);
        }
    }

    /// A number, and the class of its length: `other` is 1 if anything but the key before predicts, `class` that of the length before.
    #[inline(never)]
    fn residual(&mut self, other: usize, class: usize) -> (i32, usize) {
        let length = self.bits.unary(context::LENGTH + (4 * other + class) * context::LONG, MAX_LENGTH);
        let mut size = 0;
        if length > 0 {
            let negative = self.bits.bit(context::NEGATIVE + other);
            size = (1 << (length - 1) | self.bits.raw(length - 1)) as i32;
            if negative {
                size = -size;
            }
        }
        (size, length_class(length))
    }

    /// A value in quanta of this many thousandths, in thousandths.
    #[inline(never)]
    fn thousandths(&mut self, value: i32, unit: u32) -> i32 {
        // Below 2^29 times 5000.
        let thousandths = i64::from(value) * i64::from(unit);
        if thousandths.abs() < MAX_THOUSANDTHS {
            return thousandths as i32;
        }
        self.fail();
        0
    }

    /// Where the words behind the keys begin that the solver takes, three for each key of the longest spline, and how many keys that is. The states must
    /// be exactly as many as the clip needs.
    pub(super) fn finish(&mut self) -> [usize; 2] {
        let scratch = self.words;
        self.words += 3 * self.most_keys;
        let free = self.states.len().saturating_sub(self.moving) * STATE_WORDS;
        self.malformed |= self.words > MAX_WORDS || self.words > free || self.words + STATE_WORDS <= free;
        [scratch, self.most_keys]
    }
}
