//! A clip that plays in lent memory by time: any display rate, speeds of -4 to 4, without drift.

use crate::Error;
use crate::layer::Weight;
use crate::root::{Root, Seam};
use fixed::types::{I16F16, U0F16};
use pantin::{ChannelState, Clip, DetachedPlayer, Player, Pose};

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
    seam: Option<Seam>,
}

impl<'a, 'm> Track<'a, 'm> {
    /// Starts a clip at frame 0 and speed 1. `states` needs an element for each moving channel of each clip that is to play here,
    /// `pose` needs one for each channel of the rig.
    pub fn new(clip: Clip<'a>, states: &'m mut [ChannelState], pose: &'m mut [i32]) -> Result<Self, Error> {
        let player = Player::new(clip, states, pose)?.detach();
        Ok(Track { player, states, pose, rest: 0, speed: I16F16::ONE, ended: false, seam: None })
    }

    /// This clip at this instant, in other memory.
    pub(crate) fn in_memory<'n>(self, states: &'n mut [ChannelState], pose: &'n mut [i32]) -> Track<'a, 'n> {
        let Track { player, rest, speed, ended, seam, .. } = self;
        Track { player, states, pose, rest, speed, ended, seam }
    }

    /// Moving channels and channels of the clip: the least memory.
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
        (self.rest, self.ended, self.seam) = (0, false, None);
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
        self.ended = false;
    }

    /// Goes to a frame, or to the last one if there are fewer, without passing events.
    pub fn seek(&mut self, frame: u32) {
        self.go_to(frame.min(self.clip().frames() - 1));
        (self.rest, self.ended) = (0, false);
    }

    /// Goes to an instant between frames.
    pub(crate) fn seek_part(&mut self, frame: u32, part: U0F16) {
        self.seek(frame);
        self.rest = i64::from(part.to_bits()) * i64::from(self.clip().frame_time_ns());
    }

    /// The pose of [`Track::frame`] itself.
    pub fn pose(&self) -> Pose<'_> {
        self.player.pose(self.pose)
    }

    /// Writes the pose of this instant to `out`, on a straight line a channel between frames.
    pub fn sample(&self, out: &mut [i32]) {
        if let (len, Some(values)) = (out.len(), self.pose.get(..out.len().min(self.pose.len())))
            && let Some(out) = out.get_mut(..len.min(values.len()))
        {
            out.copy_from_slice(values);
        }
        self.add_part(out);
    }

    /// Adds what the channels move between the frame and this instant.
    pub(crate) fn add_part(&self, out: &mut [i32]) {
        if self.rest == 0 {
            return;
        }
        let part = Weight::from_bits(self.part().to_bits() >> 1);
        for state in self.states.get(..self.player.moving()).unwrap_or_default() {
            if let Some(value) = out.get_mut(state.slot()) {
                let [v, ..] = state.rates();
                *value = value.wrapping_add(part.of(v));
            }
        }
    }

    pub(crate) fn values(&self) -> &[i32] {
        self.pose
    }

    pub(crate) fn seam(&self) -> Option<Seam> {
        self.seam
    }

    /// Slot and change of each moving channel from this frame to the next; nothing moves in a clip that has ended or is held.
    pub(crate) fn velocities(&self) -> impl Iterator<Item = (usize, i32)> + '_ {
        let last = self.player.frame() + 1 >= self.clip().frames() && !self.clip().looped();
        let moving = if last || self.ended { 0 } else { self.player.moving() };
        self.states.get(..moving).unwrap_or_default().iter().map(|state| {
            let [v, ..] = state.rates();
            (state.slot(), v)
        })
    }

    fn go_to(&mut self, frame: u32) {
        let frame = frame.min(self.clip().frames().saturating_sub(1));
        let ahead = frame.wrapping_sub(self.player.frame());
        if ahead <= 8 {
            (0..ahead).for_each(|_| self.player.step(self.states, self.pose));
        } else {
            self.player.seek(frame, self.states, self.pose);
        }
    }

    /// Lets time pass, for a clip that plays as a layer: without events and root motion.
    pub fn update(&mut self, elapsed_us: u32) {
        self.advance(elapsed_us, None);
    }

    /// Goes on by one frame of the clip, whatever its speed; a loop goes on from its last frame to its first.
    pub(crate) fn step(&mut self, root: Option<&Root<'_>>) -> Passage {
        let (from, from_rest) = (self.player.frame(), self.rest != 0);
        let mut passage = Passage { from, from_rest, to: from, to_rest: false, laps: 0, forward: true };
        self.rest = 0;
        if from + 1 < self.clip().frames() {
            self.player.step(self.states, self.pose);
        } else if self.clip().looped() {
            if let (None, Some(root)) = (self.seam, root) {
                self.learn_seam(root);
            }
            self.player.seek(0, self.states, self.pose);
            passage.laps = 1;
        } else {
            self.ended = true;
        }
        passage.to = self.player.frame();
        passage
    }

    /// [`Animator::step`](crate::Animator::step) for a clip that plays as a layer.
    pub fn step_frame(&mut self) {
        self.step(None);
    }

    /// Lets time pass. `root` is that of the figure that travels with this clip, if one does.
    pub(crate) fn advance(&mut self, elapsed_us: u32, root: Option<&Root<'_>>) -> Passage {
        let (from, from_rest) = (self.player.frame(), self.rest != 0);
        let forward = self.speed >= 0;
        let frame_time = i64::from(self.clip().frame_time_ns()) << 16;
        // Below 2^42 times 2^18, and 2^48.
        self.rest += i64::from(elapsed_us) * 1000 * i64::from(self.speed.to_bits());
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
        let frames = i64::from(self.clip().frames());
        let (target, mut laps) = (i64::from(from) + steps, 0);
        let mut to = target;
        if self.clip().looped() {
            if !(0..frames).contains(&target) {
                laps = target.checked_div_euclid(frames).unwrap_or(0).clamp(-MOST_LAPS, MOST_LAPS);
                to = target.checked_rem_euclid(frames).unwrap_or(0);
            }
        } else {
            let last = frames - 1;
            self.ended |= target > last || target < 0 || (target == last && self.rest > 0);
            if target >= last || target < 0 {
                (to, self.rest) = (target.max(0).min(last), 0);
            }
        }
        let to = to as u32;
        if laps != 0
            && self.seam.is_none()
            && let Some(root) = root
        {
            self.learn_seam(root);
        }
        self.go_to(to);
        Passage { from, from_rest, to, to_rest: self.rest != 0, laps: laps as i32, forward }
    }

    /// Goes to the last frame and to the first, and compares them.
    #[inline(never)]
    fn learn_seam(&mut self, root: &Root<'_>) {
        self.go_to(self.clip().frames() - 1);
        let mut next = root.sample(&self.pose());
        // The root moves on as it did: its channels and their velocities.
        next.advance(root, &self.pose(), || self.velocities());
        self.player.seek(0, self.states, self.pose);
        let first = root.sample(&self.pose());
        self.seam = Some(Seam::between(root, &first, &next, self.clip()));
    }
}
