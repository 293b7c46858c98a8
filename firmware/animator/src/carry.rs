//! A transition in the decoder's own state: most of its frames take no additions of their own.
//!
//! The three additions are linear modulo 2^32, so that the sum of a channel and of its offset moves by them as both do. Where a segment begins, the
//! decoder reads it by the clip's own acceleration and slope: those of the offset are taken out before, and put back after. This is exact. It lasts while
//! clip and transition go on by the same frames: at speed 1, up to the last frame of the clip, and to where the cubics are solved again.

use crate::animator::Animator;
use crate::layer::Weight;
use crate::track::Passage;
use crate::transition::{Cubic, Offset};
use fixed::types::I16F16;
use pantin::ChannelState;

/// Most frames that an update goes on by with carried offsets.
const MOST_FRAMES: u8 = 8;

/// Frames that are left of a transition where it is no longer worth it to begin.
const FEW: u8 = 2;

/// Offsets that the states of the clip's moving channels hold, too. The offsets themselves stay what they were when that began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carried {
    /// Frames since then.
    frames: u8,
    /// Whether channels that the clip does not move have offsets.
    others: bool,
}

/// Adds to the rates of a state, or takes from them.
#[inline(always)]
fn add(state: &mut ChannelState, sign: i32, [v, w, k]: [i32; 3]) {
    let [own_v, own_w, own_k] = state.rates();
    let sum = |own: i32, x: i32| own.wrapping_add(x.wrapping_mul(sign));
    state.set_rates([sum(own_v, v), sum(own_w, w), sum(own_k, k)]);
}

impl Animator<'_, '_> {
    /// The whole frames that clip and transition both go on by in a time, and the time in ns in the frame after; `None` if they part.
    fn together(&self, elapsed_ns: u64) -> Option<(u8, u32)> {
        let (frame_time, mut rest) = (u64::from(self.track.clip().frame_time_ns()), u64::from(self.rest_ns) + elapsed_ns);
        if self.left == 0 || self.track.speed() != I16F16::ONE || !self.track.stands_at(self.rest_ns) {
            return None;
        }
        let mut frames = 0;
        while rest >= frame_time {
            (rest, frames) = (rest - frame_time, frames + 1);
            if frames > MOST_FRAMES {
                return None;
            }
        }
        Some((frames, rest as u32))
    }

    /// Goes on by a time with carried offsets; `None`, and none are carried, if clip and transition part in it.
    pub(crate) fn play_carried(&mut self, elapsed_ns: u64) -> Option<Passage> {
        let way = self.together(elapsed_ns);
        self.run_carried(way)
    }

    /// Goes on by a frame with carried offsets, to the frame itself.
    pub(crate) fn step_carried(&mut self) -> Option<Passage> {
        self.run_carried((self.left > 0).then_some((1, 0)))
    }

    /// [`Animator::step_carried`] to a frame that is neither one of the last nor one where the cubics are solved, while offsets are carried; false otherwise.
    #[inline(always)]
    pub(crate) fn step_within_carried(&mut self) -> bool {
        let Some(mut carried) = self.carried.filter(|_| self.left > FEW + 1 && self.may_carry(1, 0)) else { return false };
        let left = self.left - 1;
        if self.solves_at(left) {
            return false;
        }
        self.left = left;
        self.track.set_rest(0);
        self.carry_on(&mut carried);
        self.carried = Some(carried);
        true
    }

    #[inline(never)]
    fn run_carried(&mut self, way: Option<(u8, u32)>) -> Option<Passage> {
        let way = way.filter(|&(frames, rest_ns)| self.may_carry(frames, rest_ns));
        let Some(((frames, rest_ns), mut carried)) = way.and_then(|way| Some((way, self.carry()?))) else {
            self.leave_carried();
            return None;
        };
        let (from, from_rest) = (self.track.frame(), !self.track.stands_at(0));
        for _ in 0..frames {
            self.carry_on(&mut carried);
        }
        self.carried = Some(carried);
        self.left -= frames;
        self.rest_ns = rest_ns;
        self.track.set_rest(rest_ns);
        if self.left == 0 {
            self.drop_carried();
        } else if frames > 0 && self.solves_at(self.left) {
            if rest_ns == 0 && !carried.others {
                self.solve_carried(carried);
            } else {
                self.leave_carried();
                self.solve_again();
            }
        }
        let to = self.track.frame();
        Some(Passage { from, from_rest, to, to_rest: rest_ns != 0, laps: 0, forward: true })
    }

    /// Whether this many frames, and a time in the frame after, lead neither to the last frame nor past one where the cubics are solved. Between the last
    /// frames the way of the clip and that of the offset are rounded each by itself.
    fn may_carry(&self, frames: u8, rest_ns: u32) -> bool {
        let Some(left) = self.left.checked_sub(frames) else { return false };
        let lasts = self.left > FEW || (self.carried.is_some() && rest_ns == 0);
        let solved = frames > 1 && (left + 1..self.left).any(|at| self.solves_at(at));
        lasts && !solved && self.track.frame() + u32::from(frames) + 1 < self.track.clip().frames()
    }

    /// Solves the cubics again where carried offsets, all of moving channels, stand on a frame: their accelerations and slopes change, in the states too.
    #[inline(never)]
    fn solve_carried(&mut self, carried: Carried) {
        let cubic = Cubic::new(self.left);
        let Some((states, _)) = self.track.moving() else { return };
        for state in states {
            let Some(offset) = self.offsets.get_mut(state.slot()).filter(|offset| **offset != Offset::ZERO) else { continue };
            let was = offset.after(carried.frames);
            *offset = was;
            cubic.solve(offset);
            add(state, 1, [0, offset.w.wrapping_sub(was.w), offset.k.wrapping_sub(was.k)]);
        }
        self.carried = Some(Carried { frames: 0, ..carried });
    }

    /// At the end of a transition, where differences and velocities are 0: takes what is left out of the states. The offsets mean nothing then.
    #[inline(never)]
    fn drop_carried(&mut self) {
        let Some(Carried { frames, .. }) = self.carried.take() else { return };
        let Some((states, _)) = self.track.moving() else { return };
        for state in states {
            let Some(&Offset { w, k, .. }) = self.offsets.get(state.slot()) else { continue };
            add(state, -1, [0, w.wrapping_add(k.wrapping_mul(frames.into())), k]);
        }
    }

    /// Puts the offsets into the states unless they are there; `None` for a clip whose channels follow others, or which has keys.
    #[inline(never)]
    fn carry(&mut self) -> Option<Carried> {
        if self.carried.is_some() {
            return self.carried;
        }
        let some = self.offsets.iter().filter(|offset| !offset.is_zero()).count();
        let (states, values) = self.track.moving()?;
        if states.iter().any(|state| state.follows().is_some()) {
            return None;
        }
        let mut carried = 0;
        for state in states {
            let (own, value) = (self.offsets.get_mut(state.slot()), values.get_mut(state.slot()));
            let (Some(offset), Some(value)) = (own, value) else { continue };
            if offset.is_zero() {
                *offset = Offset::ZERO;
                continue;
            }
            carried += 1;
            *value = value.wrapping_add(offset.d);
            add(state, 1, [offset.v, offset.w, offset.k]);
        }
        self.carried = Some(Carried { frames: 0, others: carried < some });
        self.carried
    }

    /// A frame on.
    fn carry_on(&mut self, carried: &mut Carried) {
        let (offsets, frames) = (&*self.offsets, i32::from(carried.frames));
        self.track.step_added(&mut |slot| {
            offsets.get(slot).map_or([0; 2], |&Offset { w, k, .. }| [w.wrapping_add(k.wrapping_mul(frames)), k])
        });
        carried.frames += 1;
    }

    /// Takes the offsets out of the states, and brings them to this frame.
    pub(crate) fn leave_carried(&mut self) {
        if let Some(carried) = self.carried.take() {
            self.take_out(carried);
        }
    }

    #[inline(never)]
    fn take_out(&mut self, carried: Carried) {
        for offset in self.offsets.iter_mut().filter(|offset| **offset != Offset::ZERO) {
            *offset = offset.after(carried.frames);
        }
        let Some((states, values)) = self.track.moving() else { return };
        for state in states {
            let (Some(offset), Some(value)) = (self.offsets.get(state.slot()), values.get_mut(state.slot())) else { continue };
            *value = value.wrapping_sub(offset.d);
            add(state, -1, [offset.v, offset.w, offset.k]);
        }
    }

    /// Adds to the pose what the states do not hold: the offsets of channels that the clip does not move.
    pub(crate) fn add_others(&mut self, carried: Carried, part: Weight) {
        if !carried.others {
            return;
        }
        let Some((states, _)) = self.track.moving() else { return };
        let (mut states, mut next) = (states.iter(), None);
        for (slot, (out, offset)) in self.pose.iter_mut().zip(self.offsets.iter()).enumerate() {
            while next.is_none_or(|next| next < slot) {
                next = Some(states.next().map_or(usize::MAX, ChannelState::slot));
            }
            if next != Some(slot) && !offset.is_zero() {
                let offset = offset.after(carried.frames);
                *out = out.wrapping_add(offset.d).wrapping_add(part.of(offset.v));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::Workspace;
    use crate::transition::Transition;
    use pantin::{Clip, Player};

    fn clip(bytes: &'static [u8]) -> Clip<'static> {
        Clip::new_checked(bytes).unwrap()
    }

    #[test]
    fn carried_offsets_are_those_that_are_added_frame_by_frame() {
        let (walk, run) = (clip(include_bytes!("../../../motions/walk.ptn")), clip(include_bytes!("../../../motions/run.ptn")));
        for (from, to, frames) in [(walk, run, 3), (run, walk, 12), (walk, run, 20), (run, walk, 40), (walk, walk, 35)] {
            for by_time in [false, true] {
                let mut memory = Workspace::<64, 64>::new();
                let mut animator = Animator::new(from, memory.lend()).unwrap();
                animator.seek(7);
                animator.switch(to, 1, I16F16::ONE, Transition::Inertialized(frames)).unwrap();
                let mut offsets = animator.offsets.to_vec();
                let (mut states, mut values) = ([ChannelState::NEW; 64], [0; 64]);
                let mut player = Player::new(to, &mut states, &mut values).unwrap();
                player.seek(1);
                let mut carried = 0;
                for left in (0..frames).rev().take(to.frames() as usize - 2) {
                    if by_time {
                        // Half of a frame twice; what was lost of a ns comes from the next.
                        let half = u64::from(to.frame_time_ns() / 2);
                        animator.play(half).1.unwrap();
                        animator.play(u64::from(to.frame_time_ns()) - half).1.unwrap();
                    } else {
                        animator.step().unwrap();
                    }
                    player.step();
                    offsets.iter_mut().for_each(Offset::step);
                    if left > 0 && animator.solves_at(left) {
                        offsets.iter_mut().for_each(|offset| Cubic::new(left).solve(offset));
                    }
                    carried += u32::from(animator.carried.is_some());
                    let root = animator.root.place.map(|channel| channel.map(usize::from));
                    for (slot, (offset, value)) in offsets.iter().zip(player.pose().values).enumerate() {
                        if !root.contains(&Some(slot)) {
                            assert_eq!(
                                animator.pose[slot],
                                value.wrapping_add(offset.d),
                                "{frames}, {left} left, channel {slot}"
                            );
                        }
                    }
                }
                assert!(carried > 0 || frames < 4, "{frames}");
            }
        }
    }
}
