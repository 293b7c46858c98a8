//! One channel: its state, and the three additions.

use crate::layout::{LENGTHS, MAX_STEP, START_MODE};

/// A moving channel between two frames: 20 bytes. Its position p stands in the pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ChannelState {
    /// Velocity, acceleration, slope: what p, v and w grow by (docs/METHOD.md 2.2).
    pub(crate) v: i32,
    pub(crate) w: i32,
    pub(crate) k: i32,
    /// Index of p in the pose.
    pub(crate) slot: u16,
    /// The frame at which the running segment ends, modulo 256.
    pub(crate) due: u8,
    /// Mode of the running segment.
    pub(crate) mode: u8,
    /// Index of the channel's step; above MAX_STEP by how many moving channels back the one stands that it follows.
    pub(crate) step: u8,
    /// Sign of the acceleration that the last new one took over from, 0 if it was small: a context of the next.
    pub(crate) prev_sign: i8,
    /// While a seek runs: the number of another channel whose segment ends at the same frame. Otherwise 0.
    pub(crate) next: u16,
}

impl Default for ChannelState {
    fn default() -> Self {
        ChannelState::NEW
    }
}

impl ChannelState {
    /// What fills memory before a player takes it: `static STATES: ... = [ChannelState::NEW; N]`.
    pub const NEW: ChannelState =
        ChannelState { v: 0, w: 0, k: 0, slot: 0, due: 0, mode: START_MODE, step: 0, prev_sign: 0, next: 0 };

    /// Becomes `other`, field by field: as a whole it would drag the library's memory move into small images.
    pub(crate) fn become_as(&mut self, other: &ChannelState) {
        (self.v, self.w, self.k) = (other.v, other.w, other.k);
        (self.slot, self.due, self.mode, self.step, self.prev_sign) =
            (other.slot, other.due, other.mode, other.step, other.prev_sign);
    }

    /// Index in the pose of the channel that this is the state of.
    pub fn slot(&self) -> usize {
        usize::from(self.slot)
    }

    /// Index of the channel's step: FORMAT.md 7. None for a channel that follows.
    pub fn step_index(&self) -> Option<u8> {
        (self.step <= MAX_STEP).then_some(self.step)
    }

    /// How many moving channels before this one its leader stands; none if it leads itself.
    pub fn follows(&self) -> Option<usize> {
        self.step.checked_sub(MAX_STEP).filter(|&back| back > 0).map(usize::from)
    }

    /// Velocity, acceleration and slope: v, w, k.
    pub fn rates(&self) -> [i32; 3] {
        [self.v, self.w, self.k]
    }

    /// Changes velocity, acceleration and slope, for a program that leads a channel elsewhere than its clip does.
    pub fn set_rates(&mut self, [v, w, k]: [i32; 3]) {
        (self.v, self.w, self.k) = (v, w, k);
    }

    /// Mode of the running segment.
    pub fn mode(&self) -> u8 {
        self.mode
    }

    /// The frame at which the running segment ends, modulo 256.
    pub fn due(&self) -> u8 {
        self.due
    }

    /// Frames of the running segment, 0 if there was none yet.
    pub(crate) fn segment_frames(&self) -> u8 {
        if self.mode == START_MODE { 0 } else { segment_frames(self.mode) }
    }

    /// The three additions: a frame on.
    #[inline(always)]
    pub(crate) fn add(&mut self, pose: &mut [i32]) {
        // Every state's slot is in the pose.
        let Some(p) = pose.get_mut(usize::from(self.slot)) else { return };
        *p = p.wrapping_add(self.v);
        self.v = self.v.wrapping_add(self.w);
        self.w = self.w.wrapping_add(self.k);
    }

    /// `n` frames at once, backwards if negative, bit for bit what `n` times the three additions give; |n| < 2^9.
    #[inline(always)]
    pub(crate) fn hop(&mut self, p: &mut i32, n: i32) {
        // C(n, 2) < 2^18.
        let c2 = (n * (n - 1)) >> 1;
        let grow = |a: i32, b: i32, x: i32| a.wrapping_add(b.wrapping_mul(x));
        *p = grow(grow(*p, n, self.v), c2, self.w);
        self.v = grow(self.v, n, self.w);
        if self.k != 0 {
            // C(n, 3) = C(n, 2) (n - 2) / 3 is whole: times the inverse of 3 modulo 2^32, it is divided.
            *p = grow(*p, c2.wrapping_mul(n - 2).wrapping_mul(0xaaaa_aaab_u32 as i32), self.k);
            self.v = grow(self.v, c2, self.k);
            self.w = grow(self.w, n, self.k);
        }
    }
}

/// Frames of a segment of this mode.
pub const fn segment_frames(mode: u8) -> u8 {
    LENGTHS[(mode & 15) as usize]
}

/// A channel's step in raw units: 1, 1, 2, 3, 4, 6, 8, 12, ...
pub const fn step_size(index: u8) -> u32 {
    (mantissa(index) << (index >> 1)) >> 1
}

/// A channel's step is this times a power of two.
#[inline(always)]
pub(crate) const fn mantissa(index: u8) -> u32 {
    2 | (index & 1) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATE: ChannelState =
        ChannelState { v: 3, w: -5, k: 70, slot: 9, due: 11, mode: 0x23, step: 4, prev_sign: -1, next: 17 };

    #[test]
    fn a_state_says_what_it_holds() {
        assert_eq!((STATE.slot(), STATE.rates(), STATE.mode(), STATE.due()), (9, [3, -5, 70], 0x23, 11));
        assert_eq!((STATE.segment_frames(), ChannelState::NEW.segment_frames()), (LENGTHS[3], 0));
        for (step, index, follows) in [(0, Some(0), None), (MAX_STEP, Some(MAX_STEP), None), (MAX_STEP + 3, None, Some(3))] {
            let state = ChannelState { step, ..STATE };
            assert_eq!((state.step_index(), state.follows()), (index, follows), "{step}");
        }
        let mut other = ChannelState::default();
        other.become_as(&STATE);
        assert_eq!(other, ChannelState { next: 0, ..STATE });
        assert_eq!([0, 1, 2, 3, 4, 5, 6, 7].map(step_size), [1, 1, 2, 3, 4, 6, 8, 12]);
    }

    #[test]
    fn a_hop_is_that_many_additions_and_back() {
        for k in [0, 70, i32::MIN + 1] {
            for n in [0, 1, 2, 3, 100, 511] {
                let (mut hopped, mut added) = (ChannelState { k, slot: 0, ..STATE }, ChannelState { k, slot: 0, ..STATE });
                let (mut p, mut pose) = (-1000, [-1000]);
                hopped.hop(&mut p, n);
                (0..n).for_each(|_| added.add(&mut pose));
                assert_eq!((hopped, p), (added, pose[0]), "{n} frames, k {k}");
                hopped.hop(&mut p, -n);
                assert_eq!((hopped, p), (ChannelState { k, slot: 0, ..STATE }, -1000), "{n} frames back, k {k}");
            }
        }
    }
}
