//! A clip that plays in lent memory by time: any display rate, speeds of -4 to 4, without drift.

use crate::Error;
use crate::groups::nearest;
use crate::layer::Weight;
use crate::root::{Root, RootSample, Seam};
use crate::transition::Offset;
use fixed::types::{I16F16, U0F16};
use pantin::{Angle, ChannelState, Clip, DetachedPlayer, LoopStart, Player, Pose};

/// Copies as many values as both have: by sixteens, which takes a quarter of the instructions of the library's copy on a small processor.
pub(crate) fn copy(to: &mut [i32], from: &[i32]) {
    let len = to.len().min(from.len());
    let (to, from) = (to.get_mut(..len).unwrap_or_default(), from.get(..len).unwrap_or_default());
    let ((to, to_rest), (from, from_rest)) = (to.as_chunks_mut::<16>(), from.as_chunks::<16>());
    for (to, from) in to.iter_mut().zip(from) {
        *to = *from;
    }
    for (to, from) in to_rest.iter_mut().zip(from_rest) {
        *to = *from;
    }
}

/// Laps of a loop in one update; time beyond them is dropped.
const MOST_LAPS: i64 = 64;

const LEAST_SPEED: I16F16 = I16F16::from_bits(-4 << 16);
const GREATEST_SPEED: I16F16 = I16F16::from_bits(4 << 16);

/// A stretch of play.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Passage {
    pub(crate) from: u32,
    /// Whether the instant lies after its frame, not on it.
    pub(crate) from_rest: bool,
    pub(crate) to: u32,
    pub(crate) to_rest: bool,
    /// How often the seam of the loop was passed; negative backwards.
    pub(crate) laps: i32,
    pub(crate) forward: bool,
}

/// What a figure has beside the track that it travels with.
pub(crate) struct Traveller<'r, 'a> {
    pub(crate) root: &'r Root<'a>,
    /// Its offsets, while no transition needs them.
    pub(crate) spare: Option<&'r mut [Offset]>,
}

/// What a [`Traveller`] keeps of a loop, so that laps do not read it again: in the offset of each state, its value and velocity at frame 0.
#[derive(Clone, Copy, Debug)]
struct Kept {
    start: LoopStart,
    /// Whether the accelerations of the offsets are the velocities that lead from the last frame to frame 0.
    ways: bool,
}

/// One clip at play: a player, the time after its frame, and a speed.
#[derive(Debug)]
pub struct Track<'a, 'm> {
    player: DetachedPlayer<'a>,
    states: &'m mut [ChannelState],
    pose: &'m mut [i32],
    /// Time after the frame, in 2^-16 ns: below the time of a frame.
    rest: i64,
    speed: I16F16,
    ended: bool,
    /// Whether it had ended before the time that passed last: then nothing moves.
    stands: bool,
    seam: Option<Seam>,
    /// Whether the velocities lead from the last frame of a loop to frame 0.
    closed: bool,
    /// None while the offsets serve a transition.
    kept: Option<Kept>,
}

impl<'a, 'm> Track<'a, 'm> {
    /// Starts a clip at frame 0 and speed 1. `states` needs an element for each moving channel of each clip that is to play here,
    /// `pose` needs one for each channel of the rig.
    pub fn new(clip: Clip<'a>, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Self, Error> {
        let player = Player::new(clip, states, pose)?.detach();
        Ok(Track::of_player(player, states, pose))
    }

    /// A player in its memory, at frame 0.
    pub(crate) fn of_player(player: DetachedPlayer<'a>, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Self {
        Track {
            player,
            states,
            pose,
            rest: 0,
            speed: I16F16::ONE,
            ended: false,
            stands: false,
            seam: None,
            closed: false,
            kept: None,
        }
    }

    /// A clip that is started again before it plays: how its channels start is read if the memory is perhaps too small, and else not.
    pub(crate) fn idle(clip: Clip<'a>, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Self, Error> {
        match DetachedPlayer::idle(clip, states.len()).filter(|_| clip.rig().channels() <= pose.len()) {
            Some(player) => Ok(Track::of_player(player, states, pose)),
            None => Track::new(clip, states, pose),
        }
    }

    /// This clip at this instant, in other memory.
    pub(crate) fn in_memory<'n>(self, states: &'n mut [ChannelState], pose: &'n mut [i32]) -> Track<'a, 'n> {
        let Track { player, rest, speed, ended, stands, seam, closed, kept, .. } = self;
        Track { player, states, pose, rest, speed, ended, stands, seam, closed, kept }
    }

    /// States of the player and channels of the clip: the least memory.
    pub(crate) fn needed(&self) -> [usize; 2] {
        [self.player.moving(), self.clip().rig().channels()]
    }

    /// Plays another clip of any rig that the memory holds, from a frame (from the last one if there are fewer) and at a speed of -4 to 4
    /// (others are cut off). On an error the old clip plays on.
    pub fn start(&mut self, clip: Clip<'a>, frame: u32, speed: I16F16) -> Result<(), Error> {
        let mut player = match Player::new(clip, self.states, self.pose) {
            Ok(player) => player,
            Err(error) => {
                let (old, at) = (*self.player.clip(), self.player.frame());
                if let Ok(mut player) = Player::new(old, self.states, self.pose) {
                    player.go_to(at);
                    self.player = player.detach();
                }
                return Err(error.into());
            }
        };
        player.go_to(frame);
        self.player = player.detach();
        (self.rest, self.ended, self.seam, self.closed, self.kept) = (0, false, None, false, None);
        self.set_speed(speed);
        Ok(())
    }

    /// The clip.
    pub fn clip(&self) -> &Clip<'a> {
        self.player.clip()
    }

    /// The frame at or before this instant.
    pub fn frame(&self) -> u32 {
        self.player.frame()
    }

    /// How far this instant is on the way from that frame to the next.
    pub fn part(&self) -> U0F16 {
        let frame_time = i64::from(self.clip().frame_time_ns());
        if self.rest == 0 {
            return U0F16::ZERO;
        }
        U0F16::from_bits(self.rest.checked_div(frame_time).unwrap_or(0) as u16)
    }

    /// Whether a clip that is no loop was played past its last frame, or backwards past frame 0.
    pub fn ended(&self) -> bool {
        self.ended
    }

    /// The speed: 1 is the clip's own.
    pub fn speed(&self) -> I16F16 {
        self.speed
    }

    /// Plays at a speed of -4 to 4 from here on; others are cut off. Speed 0 holds the pose.
    pub fn set_speed(&mut self, speed: I16F16) {
        self.speed = speed.clamp(LEAST_SPEED, GREATEST_SPEED);
        (self.ended, self.stands) = (false, false);
    }

    /// Goes to a frame, or to the last one if there are fewer, without passing events.
    pub fn seek(&mut self, frame: u32) {
        self.go_to(frame, None);
        (self.rest, self.ended, self.stands) = (0, false, false);
    }

    /// Goes to an instant between frames.
    pub(crate) fn seek_part(&mut self, frame: u32, part: U0F16) {
        self.seek(frame);
        self.rest = i64::from(part.to_bits()) * i64::from(self.clip().frame_time_ns());
        if self.rest != 0 {
            self.close(None);
        }
    }

    /// The pose of [`Track::frame`] itself.
    pub fn pose(&self) -> Pose<'_> {
        self.player.pose(self.pose)
    }

    /// Writes the pose of this instant to `out`, on a straight line a channel between frames.
    pub fn sample(&self, out: &mut [i32]) {
        copy(out, self.pose);
        self.add_part(out);
    }

    /// Adds what the channels move between the frame and this instant.
    pub(crate) fn add_part(&self, out: &mut [i32]) {
        self.add_part_of(Weight::ONE, out);
    }

    /// Adds a weight of what the channels move between the frame and this instant.
    pub(crate) fn add_part_of(&self, weight: Weight, out: &mut [i32]) {
        if self.rest == 0 {
            return;
        }
        // Below 2^30.
        let part = u32::from(self.part().to_bits() >> 1) * u32::from(weight.to_bits());
        let part = Weight::from_bits((part >> 15) as u16);
        for state in self.states.get(..self.player.moving_channels()).unwrap_or_default() {
            if let Some(value) = out.get_mut(state.slot()) {
                let [v, ..] = state.rates();
                *value = value.wrapping_add(part.of(v));
            }
        }
    }

    pub(crate) fn values(&self) -> &[i32] {
        self.pose
    }

    /// A channel of this instant.
    pub(crate) fn value(&self, slot: usize) -> i32 {
        let value = self.pose.get(slot).copied().unwrap_or(0);
        let states = self.states.get(..self.player.moving_channels()).unwrap_or_default();
        let Some(state) = states.iter().find(|state| self.rest != 0 && state.slot() == slot) else { return value };
        let [v, ..] = state.rates();
        value.wrapping_add(Weight::from_bits(self.part().to_bits() >> 1).of(v))
    }

    /// The moving channels and the pose's values; `None` for a key clip, whose states are not moved by additions alone.
    pub(crate) fn moving(&mut self) -> Option<(&mut [ChannelState], &mut [i32])> {
        let moving = self.player.moving_channels();
        // Behind the moving channels of a key clip are its keys.
        let states = self.states.get_mut(..moving).filter(|_| self.player.moving() == moving)?;
        Some((states, self.pose))
    }

    /// A frame on, which is not the last, with the acceleration and slope that were added to a channel.
    pub(crate) fn step_added(&mut self, added: &mut dyn FnMut(usize) -> [i32; 2]) {
        self.player.step_added(added, self.states, self.pose);
    }

    /// Whether this instant is this time in ns after its frame.
    pub(crate) fn stands_at(&self, rest_ns: u32) -> bool {
        self.rest == i64::from(rest_ns) << 16
    }

    /// Sets the time in ns after the frame, below that of a frame.
    pub(crate) fn set_rest(&mut self, rest_ns: u32) {
        self.rest = i64::from(rest_ns) << 16;
    }

    pub(crate) fn seam(&self) -> Option<&Seam> {
        self.seam.as_ref()
    }

    /// Slot and change of each moving channel from this frame to the next. A clip that comes to its end moves on in this instant, so that a transition takes its
    /// motion over; then nothing moves.
    pub(crate) fn velocities(&self) -> impl Iterator<Item = (usize, i32)> + '_ {
        let moving = if self.stands { 0 } else { self.player.moving_channels() };
        self.states.get(..moving).unwrap_or_default().iter().map(|state| {
            let [v, ..] = state.rates();
            (state.slot(), v)
        })
    }

    /// Keeps how the loop begins, at its frame 0.
    #[inline(never)]
    pub(crate) fn keep_start(&mut self, spare: &mut [Offset]) {
        let Some(start) = self.player.loop_start().filter(|_| self.clip().looped()) else { return };
        for (kept, state) in spare.iter_mut().zip(self.states.iter().take(self.player.moving_channels())) {
            let [v, ..] = state.rates();
            (kept.d, kept.v) = (self.pose.get(state.slot()).copied().unwrap_or(0), v);
        }
        self.kept = Some(Kept { start, ways: false });
    }

    /// Forgets what was kept in offsets that a transition takes.
    pub(crate) fn leave_offsets(&mut self) {
        self.kept = None;
    }

    #[inline(never)]
    fn go_to(&mut self, frame: u32, traveller: Option<&Traveller<'_, '_>>) {
        let frame = frame.min(self.clip().frames().saturating_sub(1));
        self.closed &= frame == self.player.frame();
        if frame < self.player.frame()
            && let (Some(kept), Some(spare)) = (self.kept, traveller.and_then(|traveller| traveller.spare.as_deref()))
        {
            self.player.restart(kept.start, spare.iter().map(|kept| [kept.d, kept.v]), self.states, self.pose);
        }
        let ahead = frame.wrapping_sub(self.player.frame());
        if ahead <= 8 {
            (0..ahead).for_each(|_| self.player.step(self.states, self.pose));
        } else {
            self.player.seek(frame, self.states, self.pose);
        }
    }

    /// Goes from the last frame of a loop to frame 0. In the first lap, learns where a lap takes the root.
    #[inline(never)]
    fn lap(&mut self, traveller: Option<&mut Traveller<'_, '_>>) {
        // Without the lap to come, the root moves on as it did.
        let root = traveller.as_ref().map(|traveller| traveller.root).filter(|_| self.seam.is_none());
        let next = root.map(|root| (root, self.root_at(root, &|p, [v, ..]| p.wrapping_add(v))));
        self.go_to(0, traveller.as_deref());
        if let Some((root, next)) = next {
            let first = self.root_at(root, &|p, _| p);
            self.seam = Some(Seam::between(root, &first, &next, self.player.clip()));
        }
        if let Some(spare) = traveller.filter(|_| self.kept.is_none()).and_then(|traveller| traveller.spare.as_deref_mut()) {
            self.keep_start(spare);
        }
    }

    /// Lets time pass, for a clip that plays as a layer: without events and root motion.
    pub fn update(&mut self, elapsed_us: u32) {
        self.advance(u64::from(elapsed_us) * 1000, None);
    }

    /// Goes on by one frame of the clip, whatever its speed; a loop goes on from its last frame to its first.
    pub(crate) fn step(&mut self, traveller: Option<&mut Traveller<'_, '_>>) -> Passage {
        let (from, from_rest) = (self.player.frame(), self.rest != 0);
        let mut passage = Passage { from, from_rest, to: from, to_rest: false, laps: 0, forward: true };
        (self.rest, self.stands) = (0, self.ended);
        if from + 1 < self.clip().frames() {
            self.go_to(from + 1, None);
        } else if self.clip().looped() {
            self.lap(traveller);
            passage.laps = 1;
        } else {
            self.ended = true;
        }
        passage.to = self.player.frame();
        passage
    }

    /// [`Track::step`] to a frame that is not behind the last one, and whether there is such a frame; otherwise it does nothing.
    #[inline(always)]
    pub(crate) fn step_inside(&mut self) -> bool {
        if self.player.frame() + 1 >= self.clip().frames() {
            return false;
        }
        (self.rest, self.closed) = (0, false);
        self.player.step(self.states, self.pose);
        true
    }

    /// [`Animator::step`](crate::Animator::step) for a clip that plays as a layer.
    pub fn step_frame(&mut self) {
        if !self.step_inside() {
            self.step(None);
        }
    }

    /// Lets time pass, up to 2^42 ns, also for the figure that travels with this clip, if one does. Returns the time that is left after the end of a clip
    /// that is no loop, too.
    pub(crate) fn advance(&mut self, elapsed_ns: u64, mut traveller: Option<&mut Traveller<'_, '_>>) -> (Passage, u64) {
        let (from, from_rest) = (self.player.frame(), self.rest != 0);
        let forward = self.speed >= 0;
        self.stands = self.ended;
        let frame_time = i64::from(self.clip().frame_time_ns()) << 16;
        // Below 2^42 times 2^18, and 2^48.
        self.rest += elapsed_ns as i64 * i64::from(self.speed.to_bits());
        let steps = self.take_steps(frame_time);
        let frames = i64::from(self.clip().frames());
        let (target, mut laps, mut left) = (i64::from(from) + steps, 0, 0);
        let mut to = target;
        if self.clip().looped() {
            if !(0..frames).contains(&target) {
                laps = target.checked_div_euclid(frames).unwrap_or(0).clamp(-MOST_LAPS, MOST_LAPS);
                to = target.checked_rem_euclid(frames).unwrap_or(0);
            }
        } else {
            let last = frames - 1;
            // Below 2^61: no more than the time that passed.
            let over = if target < 0 { -(target * frame_time + self.rest) } else { (target - last) * frame_time + self.rest };
            if target >= last || target < 0 {
                (to, self.rest) = (target.max(0).min(last), 0);
                self.ended |= over > 0;
                left = over.unsigned_abs().checked_div(self.speed.to_bits().unsigned_abs().into()).unwrap_or(0);
            }
        }
        let to = to as u32;
        if laps != 0 && self.seam.is_none() && traveller.is_some() {
            self.go_to(u32::MAX, None);
            self.lap(traveller.as_deref_mut());
        } else if laps > 0 && self.kept.is_none() {
            self.lap(traveller.as_deref_mut());
        }
        self.go_to(to, traveller.as_deref());
        if self.rest != 0 {
            self.close(traveller);
        }
        (Passage { from, from_rest, to, to_rest: self.rest != 0, laps: laps as i32, forward }, left)
    }

    /// Takes whole frames out of the time after the frame: as many as come back.
    fn take_steps(&mut self, frame_time: i64) -> i64 {
        let mut steps = 0i64;
        while self.rest >= frame_time && steps < 4 {
            (self.rest, steps) = (self.rest - frame_time, steps + 1);
        }
        while self.rest < 0 && steps > -4 {
            (self.rest, steps) = (self.rest + frame_time, steps - 1);
        }
        if !(0..frame_time).contains(&self.rest) {
            steps += self.rest.checked_div_euclid(frame_time).unwrap_or(0);
            self.rest = self.rest.checked_rem_euclid(frame_time).unwrap_or(0);
        }
        steps
    }

    /// On the last frame of a loop, lets the velocities lead to frame 0: those of the root to where the next lap begins, which is learnt here.
    #[inline(never)]
    fn close(&mut self, traveller: Option<&mut Traveller<'_, '_>>) {
        if self.closed || !self.clip().looped() || self.player.frame() + 1 < self.clip().frames() {
            return;
        }
        self.closed = true;
        let Some(Traveller { root, spare }) = traveller else { return self.player.lead_to_start(self.states, self.pose) };
        let (kept, states) = (self.kept, self.player.moving_channels());
        if let (Some(Kept { ways: true, .. }), Some(spare)) = (kept, &spare) {
            for (kept, state) in spare.iter().zip(self.states.iter_mut().take(states)) {
                state.set_rates([kept.w, kept.d, 0]);
            }
            return;
        }
        self.lead_root(root);
        if let (Some(kept), Some(spare)) = (&mut self.kept, spare) {
            for (kept, state) in spare.iter_mut().zip(self.states.iter().take(states)) {
                [kept.w, ..] = state.rates();
            }
            kept.ways = true;
        }
    }

    /// Lets the velocities lead to frame 0, for a figure with this root.
    fn lead_root(&mut self, root: &Root<'_>) {
        // Without the lap to come, the root moves on as it did.
        let next = self.seam.is_none().then(|| self.root_at(root, &|p, [v, ..]| p.wrapping_add(v)));
        self.player.lead_to_start(self.states, self.pose);
        let first = &|_, [_, first, _]: [i32; 3]| first;
        let seam = match (self.seam, next) {
            (None, Some(next)) => Seam::between(root, &self.root_at(root, first), &next, self.player.clip()),
            (Some(seam), _) => seam,
            (None, None) => return,
        };
        self.seam = Some(seam);
        let mut turns = self.root_turns(root, first);
        let range = root.turns.range();
        let own = turns.get_mut(..range.len()).unwrap_or_default();
        if seam.yaw != Angle::ZERO {
            root.turn_by(&root.yaw_by(seam.yaw), own, None);
            nearest(root.turns.shape, own, self.pose.get(range.clone()).unwrap_or_default());
        }
        for state in self.states.get_mut(..self.player.moving_channels()).unwrap_or_default() {
            let (slot, p) = (state.slot(), self.pose.get(state.slot()).copied().unwrap_or(0));
            let [_, first, k] = state.rates();
            let place = root.place.iter().zip(seam.place).find(|(channel, _)| channel.map(usize::from) == Some(slot));
            let turn = slot.checked_sub(range.start).and_then(|at| own.get(at)).filter(|_| seam.yaw != Angle::ZERO);
            let to = match (place, turn) {
                (Some((_, way)), _) => first.wrapping_add(way as i32),
                (_, Some(turn)) => *turn,
                _ => continue,
            };
            state.set_rates([to.wrapping_sub(p), first, k]);
        }
    }

    /// The channels that turn the root, with values made of their own and of their rates.
    fn root_turns(&self, root: &Root<'_>, value: &dyn Fn(i32, [i32; 3]) -> i32) -> [i32; 4] {
        let (range, mut turns) = (root.turns.range(), [0; 4]);
        for (turn, p) in turns.iter_mut().zip(self.pose.get(range.clone()).unwrap_or_default()) {
            *turn = *p;
        }
        for state in self.states.get(..self.player.moving_channels()).unwrap_or_default() {
            if let Some(turn) = state.slot().checked_sub(range.start).and_then(|at| turns.get_mut(at)) {
                *turn = value(*turn, state.rates());
            }
        }
        turns
    }

    /// The root with values made of those of its channels and of their rates.
    #[inline(never)]
    fn root_at(&self, root: &Root<'_>, value: &dyn Fn(i32, [i32; 3]) -> i32) -> RootSample {
        let place = root.place.map(|channel| {
            let slot = usize::from(channel?);
            let p = self.pose.get(slot).copied()?;
            let state = self.states.get(..self.player.moving_channels())?.iter().find(|state| state.slot() == slot);
            Some(state.map_or(p, |state| value(p, state.rates())))
        });
        let turns = self.root_turns(root, value);
        let own = turns.get(..root.turns.range().len()).unwrap_or_default();
        // Less than a whole rotation does not turn from lap to lap.
        let yaw = root.yaw_of_turns(own).unwrap_or(Angle::ZERO);
        RootSample { place: place.map(|place| place.unwrap_or(0)), yaw }
    }
}
