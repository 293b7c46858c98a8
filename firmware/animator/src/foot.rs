//! A foot that stays where it came down.

use crate::Error;
use crate::groups::Group;
use crate::root::Placement;
use crate::transition::{AGAIN, Cubic, Offset};
use crate::two_bone::{Limb, Limits, Reach};
use pantin::{Clip, Rig};

/// Where a foot is in its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The clip moves it.
    Free,
    /// It stays at a place of the world; the second number is the least height of the ankle since it came down.
    Locked([i64; 2], i32),
    /// It goes back to the clip's motion in some updates.
    Released(u8),
}

/// Keeps a foot in its place in the world from the moment at which it bears weight until the clip lifts it or carries it on. The ankle's height and
/// its rotation stay the clip's.
#[derive(Clone, Debug)]
pub struct FootLock<'a> {
    limb: Limb<'a>,
    up: usize,
    negative: bool,
    state: State,
    /// What is left of the lock after it ends, along the two horizontal axes.
    offsets: [Offset; 2],
    release: u8,
}

impl<'a> FootLock<'a> {
    /// The lock of the foot whose ankle has this name. After a lock the foot goes back to the clip's motion in `release` updates.
    pub fn new(clip: &Clip<'a>, groups: &[Group], ankle: &str, limits: Limits, release: u8) -> Result<FootLock<'a>, Error> {
        let limb = Limb::to(clip, groups, ankle, limits)?;
        let rig: Rig<'_> = clip.rig();
        let (up, negative) = (rig.up().axis(), rig.up().is_negative());
        Ok(FootLock { limb, up, negative, state: State::Free, offsets: [Offset::ZERO; 2], release })
    }

    /// Whether the foot is held.
    pub fn is_locked(&self) -> bool {
        matches!(self.state, State::Locked(..))
    }

    /// Lets the foot go, as when a transition begins.
    pub fn release(&mut self) {
        if self.is_locked() {
            self.state = State::Released(self.release.max(1));
        }
    }

    /// Corrects the pose of an update. `down` says that the foot's event (`left_foot_down`, `right_foot_down`) was passed in it. Call it once an
    /// update, after layers. The limb's reach is returned; without a lock there is no error.
    pub fn update(&mut self, pose: &mut [i32], placement: Placement, down: bool) -> Reach {
        let ankle = self.limb.end(pose);
        let of = |axis: usize| ankle.get(axis % 3).copied().unwrap_or(0);
        let (flat, height) = ([of(self.up + 1), of(self.up + 2)], if self.negative { -of(self.up) } else { of(self.up) });
        if down {
            // Where the foot is now, with what is left of the last lock: nothing jumps.
            let [a, b] = flat;
            let [left_a, left_b] = self.left();
            self.state = State::Locked(placement.to_world([a.wrapping_add(left_a), b.wrapping_add(left_b)]), height);
        }
        if let State::Locked(anchor, least) = self.state {
            let length = self.limb.length();
            let wanted = placement.to_pose(anchor);
            let [a, b] = [0, 1].map(|at: usize| {
                let of = |v: [i32; 2]| v.get(at).copied().unwrap_or(0);
                of(wanted).wrapping_sub(of(flat))
            });
            let least = least.min(height);
            self.state = State::Locked(anchor, least);
            for (offset, d) in self.offsets.iter_mut().zip([a, b]) {
                *offset = Offset { d, ..Offset::ZERO };
            }
            // Lifted by a sixteenth of the limb, or carried on by an eighth: the step is over.
            let far = |x: i32| x.unsigned_abs() > (length >> 3).unsigned_abs();
            if height.wrapping_sub(least) > length >> 4 || far(a) || far(b) {
                self.state = State::Released(self.release.max(1));
                let cubic = Cubic::new(self.release.max(1));
                // The difference grows because the clip moves on; that velocity is the clip's, and is not carried on.
                self.offsets.iter_mut().for_each(|offset| cubic.solve(offset));
            }
        } else if let State::Released(left) = self.state {
            let left = left.saturating_sub(1);
            self.offsets.iter_mut().for_each(Offset::step);
            if AGAIN.contains(&left) {
                let cubic = Cubic::new(left);
                self.offsets.iter_mut().for_each(|offset| cubic.solve(offset));
            }
            self.state = if left == 0 { State::Free } else { State::Released(left) };
        }
        if self.state == State::Free {
            self.offsets = [Offset::ZERO; 2];
            return Reach { error: 0, within: true };
        }
        let [left_a, left_b] = self.left();
        let mut target = ankle;
        for (axis, left) in [(self.up + 1, left_a), (self.up + 2, left_b)] {
            if let Some(own) = target.get_mut(axis % 3) {
                *own = own.wrapping_add(left);
            }
        }
        self.limb.reach(pose, target, None)
    }

    fn left(&self) -> [i32; 2] {
        if self.state == State::Free { [0; 2] } else { self.offsets.map(|offset| offset.d) }
    }
}
