//! A foot that stays where it came down.

use crate::Error;
use crate::ease::{Ease, part};
use crate::groups::Group;
use crate::root::Placement;
use crate::two_bone::{Limb, Limits, Reach};
use pantin::{Clip, Rig};

/// Where a foot is in its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The clip moves it.
    Free,
    /// It stays at a place of the world; the second number is the least height of the ankle since it came down.
    Locked([i64; 2], i32),
    /// It goes back to the clip's motion, since this many us.
    Released(u32),
}

/// Keeps a foot in its place in the world from the moment at which it bears weight until the clip lifts it or carries it on. The ankle's height and
/// its rotation stay the clip's. A foot that is let go starts with its own velocity, and is back in the clip's motion after the time of the release, at
/// any display rate.
#[derive(Clone, Debug)]
pub struct FootLock<'a> {
    limb: Limb<'a>,
    up: usize,
    negative: bool,
    state: State,
    /// What is left of the lock after it ends, along the two horizontal axes.
    distances: [Ease; 2],
    release_us: u32,
}

impl<'a> FootLock<'a> {
    /// The lock of the foot whose ankle has this name. After a lock the foot goes back to the clip's motion in `release_us` microseconds (200,000 suits a
    /// walk).
    pub fn new(clip: &Clip<'a>, groups: &[Group], ankle: &str, limits: Limits, release_us: u32) -> Result<FootLock<'a>, Error> {
        let limb = Limb::to(clip, groups, ankle, limits)?;
        let rig: Rig<'_> = clip.rig();
        let (up, negative) = (rig.up().axis(), rig.up().is_negative());
        Ok(FootLock { limb, up, negative, state: State::Free, distances: [Ease::default(); 2], release_us })
    }

    /// Whether the foot is held.
    pub fn is_locked(&self) -> bool {
        matches!(self.state, State::Locked(..))
    }

    /// Lets the foot go, as when a transition begins.
    pub fn release(&mut self) {
        if self.is_locked() {
            self.state = State::Released(0);
        }
    }

    /// Corrects the pose of an update, `elapsed_us` after the last one. `down` says that the foot's event (`left_foot_down`, `right_foot_down`) was passed
    /// in it. Call it once an update, after layers. The limb's reach is returned; without a lock there is no error.
    pub fn update(&mut self, pose: &mut [i32], placement: Placement, down: bool, elapsed_us: u32) -> Reach {
        if let State::Released(since) = self.state {
            let since = since.saturating_add(elapsed_us);
            self.state = if since < self.release_us { State::Released(since) } else { State::Free };
        }
        let ankle = self.limb.end(pose);
        let of = |axis: usize| ankle.get(axis % 3).copied().unwrap_or(0);
        let (flat, height) = ([of(self.up + 1), of(self.up + 2)], if self.negative { -of(self.up) } else { of(self.up) });
        if down {
            // Where the foot is now, with what is left of the last lock: nothing jumps.
            let [a, b] = flat;
            let [left_a, left_b] = self.left();
            self.distances = [left_a, left_b].map(Ease::at_rest);
            self.state = State::Locked(placement.to_world([a.wrapping_add(left_a), b.wrapping_add(left_b)]), height);
        }
        if let State::Locked(anchor, least) = self.state {
            self.hold(placement.to_pose(anchor), flat, elapsed_us);
            let (length, least) = (self.limb.length(), least.min(height));
            // Lifted by a sixteenth of the limb, or carried on by an eighth: the step is over.
            let far = self.distances.iter().any(|own| own.d.unsigned_abs() > (length >> 3).unsigned_abs());
            let over = height.wrapping_sub(least) > length >> 4 || far;
            self.state = if over { State::Released(0) } else { State::Locked(anchor, least) };
        }
        if self.state == State::Free {
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

    /// Keeps the foot at a place of the pose, and its distance's velocity.
    fn hold(&mut self, wanted: [i32; 2], flat: [i32; 2], elapsed_us: u32) {
        for ((own, wanted), flat) in self.distances.iter_mut().zip(wanted).zip(flat) {
            own.hold(wanted.wrapping_sub(flat), elapsed_us, self.release_us);
        }
    }

    fn left(&self) -> [i32; 2] {
        let part = match self.state {
            State::Free => return [0; 2],
            State::Locked(..) => 0,
            State::Released(since) => part(since, self.release_us),
        };
        self.distances.map(|own| own.at(part))
    }
}
