//! A figure that plays one clip. `switch.rs` lets it go over to others.

use crate::Error;
use crate::carry::Carried;
use crate::events::{EventQueue, EventsLost};
use crate::groups::{self, Group};
use crate::layer::{Weight, blend, mix_all};
use crate::mask::{Mask, Run};
use crate::memory::Memory;
use crate::root::{self, Placement, Root, Travel};
use crate::track::{Passage, Track, Traveller, copy};
use crate::transition::{AGAIN, Cubic, Offset};
use fixed::types::{I16F16, U0F16};
use pantin::{Clip, DetachedPlayer, FormRef, Player, Pose, WrongForm};

/// What the figure's root does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum RootMotion {
    /// The figure travels: [`Animator::placement`].
    #[default]
    Travel,
    /// The figure stays where it is; its heading changes by clips alone.
    InPlace,
}

/// Plays one clip after another with transitions, root motion and events. See the crate's page for the order of work in a frame.
#[derive(Debug)]
pub struct Animator<'a, 'm> {
    pub(crate) track: Track<'a, 'm>,
    pub(crate) offsets: &'m mut [Offset],
    pub(crate) pose: &'m mut [i32],
    pub(crate) groups: &'m mut [Group],
    pub(crate) used_groups: usize,
    /// Frames of the transition that are left, and how many are when velocities have died out, if that is before its end; the time in the frame that
    /// runs, in ns.
    pub(crate) left: u8,
    pub(crate) left_then: u8,
    pub(crate) rest_ns: u32,
    pub(crate) carried: Option<Carried>,
    /// Index of the joint that carries the figure.
    pub(crate) carrier: usize,
    pub(crate) root: Root<'a>,
    pub(crate) travel: Travel,
    /// The root's horizontal place in the clip, with what the transition adds.
    pub(crate) place: [i32; 2],
    pub(crate) motion: RootMotion,
    pub(crate) events: EventQueue,
    /// Where the figure is now, and where it was when an increment was last taken.
    pub(crate) now: Placement,
    pub(crate) before: Placement,
}

impl<'a, 'm> Animator<'a, 'm> {
    /// Starts a clip at frame 0, at the world's origin. A rig that has scalars alone is [`Error::NoCarrier`]: a [`Track`] plays it.
    ///
    /// The figure is carried by the rig's first joint with positions: its horizontal place and its turn about the vertical axis are the figure's.
    /// [`Animator::carried_by`] takes another joint.
    pub fn new(clip: Clip<'a>, memory: Memory<'m>) -> Result<Self, Error> {
        let carrier = root::first_with_positions(&clip.rig());
        Self::carried_by(carrier, clip, memory)
    }

    /// [`Animator::new`] for a figure that is carried by the joint of an index, as where captures hang on a joint that stands still.
    pub fn carried_by(carrier: usize, clip: Clip<'a>, memory: Memory<'m>) -> Result<Self, Error> {
        let player = Player::new(clip, memory.states, memory.values)?.detach();
        Self::of_player(carrier, player, memory)
    }

    /// [`Animator::carried_by`] for a player that is in the memory, at frame 0.
    pub(crate) fn of_player(carrier: usize, player: DetachedPlayer<'a>, memory: Memory<'m>) -> Result<Self, Error> {
        let Memory { states, values, offsets, pose, groups } = memory;
        let clip = player.clip();
        let needed = clip.rig().channels();
        let check = |what, given| if given < needed { Err(Error::TooSmall { what, needed, given }) } else { Ok(()) };
        check("offsets", offsets.len())?;
        check("values of the pose", pose.len())?;
        let (offsets, pose) = (offsets.get_mut(..needed).unwrap_or_default(), pose.get_mut(..needed).unwrap_or_default());
        let used_groups = groups::set_up(&clip.rig(), clip.form_ref(), groups)?;
        let root = Root::of(&clip.rig(), groups, carrier).ok_or(Error::NoCarrier)?;
        let track = Track::of_player(player, states, values);
        let mut animator = Animator {
            track,
            offsets,
            pose,
            groups,
            used_groups,
            left: 0,
            left_then: 0,
            rest_ns: 0,
            carried: None,
            carrier,
            root,
            travel: Travel::NONE,
            place: [0; 2],
            motion: RootMotion::Travel,
            events: EventQueue::new(),
            now: Placement::default(),
            before: Placement::default(),
        };
        animator.track.keep_start(animator.offsets);
        animator.events.at(animator.track.clip(), 0);
        animator.compose();
        animator.travel = Travel::new(Placement::default(), animator.place.map(i64::from));
        Ok(animator)
    }

    /// The clip that plays: its frame, its speed, whether it has ended. During a transition its pose can have a part of it.
    pub fn track(&self) -> &Track<'a, 'm> {
        &self.track
    }

    /// The pose of this instant. The root's horizontal position channels are 0: [`Animator::placement`] says where the figure is.
    pub fn pose(&self) -> Pose<'_> {
        Pose { values: self.pose, form: self.form() }
    }

    /// The values of [`Animator::pose`], for layers, procedural motion and inverse kinematics. They last until the next update.
    pub fn pose_mut(&mut self) -> &mut [i32] {
        self.pose
    }

    /// What the values mean: the form of the clip that plays.
    pub fn form(&self) -> FormRef<'a> {
        self.track.clip().form_ref()
    }

    /// The groups of channels, for layers.
    pub fn groups(&self) -> &[Group] {
        self.groups.get(..self.used_groups).unwrap_or_default()
    }

    /// The pose, and the groups of its channels: what a layer is applied to.
    pub fn parts(&mut self) -> (&mut [i32], &[Group], FormRef<'a>) {
        let form = self.form();
        (self.pose, self.groups.get(..self.used_groups).unwrap_or_default(), form)
    }

    /// The events that were passed and not yet taken.
    pub fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// Frames until the transition that runs has ended; 0 if none runs.
    pub fn transition_left(&self) -> u8 {
        self.left
    }

    /// Plays at a speed of -4 to 4 from here on; others are cut off. The velocity of the pose jumps: a [`Animator::switch`] to the same clip
    /// at another speed does not.
    pub fn set_speed(&mut self, speed: I16F16) {
        self.track.set_speed(speed);
    }

    /// Whether the figure travels.
    pub fn set_root_motion(&mut self, motion: RootMotion) {
        let placement = self.placement();
        self.motion = motion;
        self.settle(placement);
    }

    /// Begins at a frame, at the world's origin.
    pub(crate) fn begin_at(&mut self, frame: u32) {
        self.leave_carried();
        self.track.seek(frame);
        self.compose();
        self.settle(Placement::default());
    }

    /// Puts the figure to a place in the world.
    pub fn set_placement(&mut self, placement: Placement) {
        self.settle(placement);
    }

    /// Makes the root's present place stand at a placement. What was not yet taken of the increments stays.
    fn settle(&mut self, placement: Placement) {
        self.travel = Travel::new(placement, self.place.map(i64::from));
        let increment = self.now.since(&self.before);
        self.locate();
        self.before = self.now.since(&increment);
    }

    /// Where the figure is, and how it is turned.
    pub fn placement(&self) -> Placement {
        self.now
    }

    /// Finds where the figure is, after everything that moves it.
    pub(crate) fn locate(&mut self) {
        self.now = match self.motion {
            RootMotion::Travel => self.travel.placement(self.place, self.track.seam()),
            RootMotion::InPlace => Placement { place: self.travel.anchor, heading: self.travel.heading.angle },
        };
    }

    /// Takes what the placement has changed by since the last call, or since the start: through updates, seeks and switches, but not by
    /// [`Animator::set_placement`]. The sum of all increments is the difference of the placements, exactly. A switch to a clip with another unit of length
    /// brings what was not yet taken to that unit, too.
    pub fn take_increment(&mut self) -> Placement {
        let increment = self.now.since(&self.before);
        self.before = self.now;
        increment
    }

    fn transition_part(&self) -> U0F16 {
        let frame_time = u64::from(self.track.clip().frame_time_ns());
        U0F16::from_bits((u64::from(self.rest_ns) << 16).checked_div(frame_time).unwrap_or(0) as u16)
    }

    /// Takes the way of the laps and the events of a stretch of play.
    fn pass(&mut self, passage: &Passage) {
        if passage.laps != 0
            && let Some(seam) = self.track.seam()
        {
            self.travel.pass(passage.laps, seam);
        }
        self.events.pass(self.track.clip(), passage);
    }

    /// Lets time pass, up to 71 minutes; more than 64 laps of a loop at once are cut off. The error says that events were lost; the rest is done.
    pub fn update(&mut self, elapsed_us: u32) -> Result<(), EventsLost> {
        let (left_ns, outcome) = self.play(u64::from(elapsed_us) * 1000);
        self.hold(left_ns);
        outcome
    }

    /// Lets time pass up to the end of a clip that is no loop, and returns the time in ns that is left.
    pub(crate) fn play(&mut self, elapsed_ns: u64) -> (u64, Result<(), EventsLost>) {
        let lost = self.events.lost();
        let left_ns = if let Some(passage) = self.play_carried(elapsed_ns) {
            self.pass(&passage);
            0
        } else {
            let spare = (self.left == 0).then_some(&mut *self.offsets);
            let (passage, left_ns) = self.track.advance(elapsed_ns, Some(&mut Traveller { root: &self.root, spare }));
            self.pass(&passage);
            self.run_transition(elapsed_ns.saturating_sub(left_ns));
            left_ns
        };
        self.compose();
        self.locate();
        (left_ns, self.events.check(lost))
    }

    /// Lets time pass after the end of the clip: a transition still runs.
    pub(crate) fn hold(&mut self, elapsed_ns: u64) {
        if self.left > 0 && elapsed_ns > 0 {
            self.leave_carried();
            self.run_transition(elapsed_ns);
            self.compose();
            self.locate();
        }
    }

    /// Goes on by exactly one frame of the clip, forwards and whatever its speed: for a program that shows one picture for each frame. Where this
    /// serves it is cheaper than [`Animator::update`]. A transition goes on by a frame too.
    pub fn step(&mut self) -> Result<(), EventsLost> {
        let lost = self.events.lost();
        if !self.step_within() {
            let passage = self.step_track();
            self.pass(&passage);
        }
        self.compose();
        self.locate();
        self.events.check(lost)
    }

    /// Goes on by a frame in the middle of a clip without events, if nothing but the additions is to be done, as mostly; false otherwise.
    #[inline(always)]
    fn step_within(&mut self) -> bool {
        if self.track.clip().event_count() != 0 {
            return false;
        }
        let done = if self.left > 0 { self.step_within_carried() } else { self.carried.is_none() && self.track.step_inside() };
        if done {
            self.rest_ns = 0;
        }
        done
    }

    fn step_track(&mut self) -> Passage {
        if let Some(passage) = self.step_carried() {
            return passage;
        }
        let spare = (self.left == 0).then_some(&mut *self.offsets);
        let passage = self.track.step(Some(&mut Traveller { root: &self.root, spare }));
        self.rest_ns = 0;
        if self.left > 0 {
            self.step_transition();
        }
        passage
    }

    /// Goes to a frame of the clip, or to the last one if there are fewer, without events. The transition stays where it is.
    pub fn seek(&mut self, frame: u32) {
        self.leave_carried();
        self.track.seek(frame);
        self.compose();
        self.locate();
    }

    /// Whether the cubics are solved again with this number of frames left.
    #[inline(always)]
    pub(crate) fn solves_at(&self, left: u8) -> bool {
        left == self.left_then || (AGAIN.contains(&left) && (left < self.left_then || self.left_then == 0))
    }

    pub(crate) fn solve_again(&mut self) {
        if self.left > 0 && self.solves_at(self.left) {
            Cubic::new(self.left).solve_all(self.offsets);
        }
    }

    fn run_transition(&mut self, elapsed_ns: u64) {
        let frame_time = u64::from(self.track.clip().frame_time_ns());
        let mut rest = u64::from(self.rest_ns) + elapsed_ns;
        while rest >= frame_time && self.left > 0 {
            rest -= frame_time;
            self.step_transition();
        }
        self.rest_ns = if self.left > 0 { rest as u32 } else { 0 };
    }

    #[inline(never)]
    fn step_transition(&mut self) {
        self.left -= 1;
        for offset in self.offsets.iter_mut().filter(|offset| !offset.is_zero()) {
            offset.step();
        }
        self.solve_again();
    }

    /// Writes the pose of this instant, and takes the root's place out of it.
    pub(crate) fn compose(&mut self) {
        copy(self.pose, self.track.values());
        if self.left > 0 {
            let part = Weight::from_bits(if self.rest_ns == 0 { 0 } else { self.transition_part().to_bits() >> 1 });
            if let Some(carried) = self.carried {
                self.add_others(carried, part);
            } else {
                self.add_offsets(part);
            }
        }
        self.finish();
    }

    /// Adds the offsets to the pose, and a part of their velocities.
    fn add_offsets(&mut self, part: Weight) {
        for (out, offset) in self.pose.iter_mut().zip(self.offsets.iter()) {
            if offset.is_zero() {
                continue;
            }
            *out = out.wrapping_add(offset.d);
            if part != Weight::ZERO {
                *out = out.wrapping_add(part.of(offset.v));
            }
        }
    }

    fn finish(&mut self) {
        self.track.add_part(self.pose);
        for (place, channel) in self.place.iter_mut().zip(self.root.place) {
            let Some(value) = channel.and_then(|channel| self.pose.get_mut(usize::from(channel))) else { continue };
            *place = core::mem::take(value);
        }
    }

    /// Mixes another clip into the pose of this instant: all joints, but not the root's horizontal place. Its form has to be that of the clip that
    /// plays. It lasts until the next update.
    pub fn mix(&mut self, other: &Track<'_, '_>, weight: Weight) -> Result<(), WrongForm> {
        let form = self.form();
        let pose = other.pose();
        form.check(pose.form)?;
        let groups = self.groups.get(..self.used_groups).unwrap_or_default();
        mix_all(self.pose, groups.iter().map(Run::of_group), pose.values, weight);
        other.add_part_of(weight, self.pose);
        self.root.leave_place(self.pose);
        Ok(())
    }

    /// Puts a layer over the pose of this instant, where the mask says, but not over the root's horizontal place. Its form has to be that of the
    /// clip that plays. It lasts until the next update.
    pub fn layer(&mut self, values: &[i32], form: FormRef<'_>, mask: &Mask<'_>, weight: Weight) -> Result<(), WrongForm> {
        let own = self.form();
        let groups = self.groups.get(..self.used_groups).unwrap_or_default();
        blend(self.pose, groups, own, Pose { values, form }, mask, weight)?;
        self.root.leave_place(self.pose);
        Ok(())
    }
}
