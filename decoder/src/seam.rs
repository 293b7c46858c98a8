//! From a loop's last frame to frame 0: how far each channel moves in between.

use crate::channel::ChannelState;
use crate::clip::Clip;
use crate::joint::Joint;
use crate::kind::Kind;
use core::cell::Cell;

/// A position that does not come back to within this of its start goes on as it did: a walk that travels.
const RETURNS_CM: i64 = 5;
/// An eighth of a turn, or a half as a component of a quaternion. Where the motion leads farther than this from frame 0, the joint turns on from lap
/// to lap, or the same rotation has other numbers there: its rotation goes on as it did.
const FAR: u32 = 1 << 29;

/// The moving channels of a loop's last frame, wherever their values are.
trait Last {
    /// The state of a moving channel, with the velocity that leads on; `None` behind the last one.
    fn state(&self, index: usize) -> Option<ChannelState>;
    /// Its value at frame 0.
    fn first(&self, index: usize) -> i32;
    /// Takes the way to frame 0.
    fn put(&self, index: usize, way: i32);
}

/// A length in raw units of position channels, rounded down; at most 2^31.
fn raw_of_cm(clip: &Clip<'_>, cm: i64) -> u32 {
    let (micro_cm, shift) = (cm * 1_000_000, i32::from(clip.length_exponent()));
    // Below 2^23 times 2^31.
    let scaled = if shift >= 0 { micro_cm >> shift } else { micro_cm << shift.unsigned_abs().min(31) };
    scaled.checked_div(clip.rig().unit_micro_cm().into()).unwrap_or(0).clamp(0, 1 << 31) as u32
}

/// Puts the way of each moving channel: to its value at frame 0, or on as it went.
#[inline(never)]
fn each_way(clip: &Clip<'_>, pose: &[i32], last: &dyn Last) {
    let bound = raw_of_cm(clip, RETURNS_CM);
    let way = |index: usize, state: &ChannelState| {
        let p = pose.get(state.slot()).copied().unwrap_or(0);
        last.first(index).wrapping_sub(p)
    };
    let gap = |index: usize, state: &ChannelState| way(index, state).wrapping_sub(state.v).unsigned_abs();
    let mut from = 0;
    for joint in clip.rig().joints() {
        let own = |index: usize| last.state(index).and_then(|state| Some((kind_of(&joint, &state)?, state)));
        let (mut end, mut turns_on) = (from, false);
        while let Some((kind, state)) = own(end) {
            turns_on |= !kind.is_position() && gap(end, &state) > FAR;
            end += 1;
        }
        for index in from..end {
            let Some((kind, state)) = own(index) else { continue };
            let on = if kind.is_position() { gap(index, &state) > bound } else { turns_on };
            last.put(index, if on { state.v } else { way(index, &state) });
        }
        from = end;
    }
    // Scalars.
    while let Some(state) = last.state(from) {
        last.put(from, way(from, &state));
        from += 1;
    }
}

/// The kind of a channel, if it is of this joint.
fn kind_of(joint: &Joint<'_>, state: &ChannelState) -> Option<Kind> {
    { joint.kinds }.nth(usize::from(state.slot.checked_sub(joint.first_channel)?))
}

/// A pose that holds the values of frame 0 and becomes one on the way there.
struct Between<'p> {
    states: &'p [ChannelState],
    pose: &'p [i32],
    out: &'p [Cell<i32>],
    /// In 2^-16.
    part: u16,
}

impl Between<'_> {
    fn of(&self, index: usize) -> Option<(&Cell<i32>, i32)> {
        let slot = self.states.get(index)?.slot();
        Some((self.out.get(slot)?, *self.pose.get(slot)?))
    }
}

impl Last for Between<'_> {
    fn state(&self, index: usize) -> Option<ChannelState> {
        self.states.get(index).copied()
    }

    fn first(&self, index: usize) -> i32 {
        self.of(index).map_or(0, |(out, _)| out.get())
    }

    fn put(&self, index: usize, way: i32) {
        if let Some((out, p)) = self.of(index) {
            out.set(p.wrapping_add(((i64::from(way) * i64::from(self.part)) >> 16) as i32));
        }
    }
}

/// Writes to `out`, as long as the pose of a loop's last frame, the pose `part` (in 2^-16) of the way to frame 0. Behind the states of the channels are
/// those that hold a key clip's keys.
pub(crate) fn interpolate(clip: &Clip<'_>, states: &[ChannelState], moving: usize, pose: &[i32], part: u16, out: &mut [i32]) {
    #[cfg_attr(not(feature = "keys"), expect(unused_variables))]
    let Some((states, words)) = states.split_at_checked(moving) else { return };
    for (out, value) in out.iter_mut().zip(pose) {
        *out = *value;
    }
    let between = Between { states, pose, out: Cell::from_mut(out).as_slice_of_cells(), part };
    let put = |index: usize, value| {
        if let Some((out, _)) = between.of(index) {
            out.set(value);
        }
    };
    #[cfg(feature = "keys")]
    if clip.has_keys() {
        states.iter().enumerate().for_each(|(index, state)| put(index, crate::keys::first_value(state, words)));
        return each_way(clip, pose, &between);
    }
    clip.first_values(&mut |index, value| {
        let leader = states.get(index).and_then(ChannelState::follows).map(|back| between.first(index.wrapping_sub(back)));
        put(index, leader.unwrap_or(value));
    });
    each_way(clip, pose, &between);
}

/// States on the last frame: the value at frame 0 is in w, the velocity that leads on is in k, neither of which is needed there.
struct InPlace<'s>(&'s [Cell<ChannelState>]);

impl Last for InPlace<'_> {
    fn state(&self, index: usize) -> Option<ChannelState> {
        self.0.get(index).map(Cell::get)
    }

    fn first(&self, index: usize) -> i32 {
        self.state(index).map_or(0, |state| state.w)
    }

    fn put(&self, index: usize, way: i32) {
        if let Some(cell) = self.0.get(index) {
            cell.set(ChannelState { v: way, ..cell.get() });
        }
    }
}

/// Makes the velocities on a loop's last frame those that lead to frame 0. The accelerations become the values there.
pub(crate) fn close(clip: &Clip<'_>, states: &mut [ChannelState], moving: usize, pose: &[i32]) {
    #[cfg_attr(not(feature = "keys"), expect(unused_variables))]
    let Some((states, words)) = states.split_at_mut_checked(moving) else { return };
    let states = InPlace(Cell::from_mut(states).as_slice_of_cells());
    #[cfg(feature = "keys")]
    if clip.has_keys() {
        for cell in states.0 {
            let state = cell.get();
            cell.set(ChannelState { w: crate::keys::first_value(&state, words), k: 0, ..state });
        }
        return each_way(clip, pose, &states);
    }
    clip.first_values(&mut |index, value| {
        let Some(state) = states.state(index) else { return };
        let leader = state.follows().map(|back| states.first(index.wrapping_sub(back)));
        if let Some(cell) = states.0.get(index) {
            cell.set(ChannelState { w: leader.unwrap_or(value), k: 0, ..state });
        }
    });
    each_way(clip, pose, &states);
}
