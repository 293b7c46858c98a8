//! A figure that plays one clip and goes over to others.

use crate::Error;
use crate::events::{EventQueue, EventsLost};
use crate::groups::{self, Group, Shape, nearest};
use crate::layer::{Weight, blend, mix_group};
use crate::mask::Mask;
use crate::math;
use crate::offset::{AGAIN, Cubic, Offset};
use crate::root::{self, Heading, Placement, Root, Travel};
use crate::track::Track;
use fixed::types::{I16F16, U0F16};
use pantin::{ChannelState, Clip, FormRef, Pose, WrongForm};

/// How one clip follows another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Transition {
    /// At once. The pose jumps; place and heading do not.
    Cut,
    /// The difference of the poses and of their velocities dies out as a cubic in this many frames of the new clip, after which the pose is
    /// exactly the clip's. 0 frames are a cut; 1 frame keeps the old pose for the first instant alone.
    Inertialized(u8),
    /// The difference of the poses alone dies out: the old motion stops at once. For comparison.
    Faded(u8),
}

impl Transition {
    fn frames(self) -> u8 {
        match self {
            Transition::Cut => 0,
            Transition::Inertialized(frames) | Transition::Faded(frames) => frames,
        }
    }
}

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

/// Memory for an [`Animator`]: 20 bytes for each moving channel, 24 for each channel (its value, its offset, the pose that comes out), and 6
/// for each group of channels.
#[derive(Debug)]
pub struct Memory<'m> {
    /// An element for each moving channel of the clip that has most.
    pub states: &'m mut [ChannelState],
    /// An element for each channel of the rig.
    pub values: &'m mut [i32],
    /// An element for each channel of the rig.
    pub offsets: &'m mut [Offset],
    /// An element for each channel of the rig.
    pub pose: &'m mut [i32],
    /// Elements as [`Group`] says.
    pub groups: &'m mut [Group],
}

/// [`Memory`] as one value that can be a `static`: for clips with up to `MOVING` moving channels, `CHANNELS` channels and as many groups.
#[derive(Clone, Debug)]
pub struct Workspace<const MOVING: usize, const CHANNELS: usize> {
    states: [ChannelState; MOVING],
    values: [i32; CHANNELS],
    offsets: [Offset; CHANNELS],
    pose: [i32; CHANNELS],
    groups: [Group; CHANNELS],
}

impl<const MOVING: usize, const CHANNELS: usize> Workspace<MOVING, CHANNELS> {
    /// Empty memory.
    pub const fn new() -> Self {
        Workspace {
            states: [ChannelState::NEW; MOVING],
            values: [0; CHANNELS],
            offsets: [Offset::ZERO; CHANNELS],
            pose: [0; CHANNELS],
            groups: [Group::NONE; CHANNELS],
        }
    }

    /// The memory, to be lent.
    pub fn lend(&mut self) -> Memory<'_> {
        let Workspace { states, values, offsets, pose, groups } = self;
        Memory { states, values, offsets, pose, groups }
    }
}

impl<const MOVING: usize, const CHANNELS: usize> Default for Workspace<MOVING, CHANNELS> {
    fn default() -> Self {
        Self::new()
    }
}

/// Plays one clip after another with transitions, root motion and events. See the crate's page for the order of work in a frame.
#[derive(Debug)]
pub struct Animator<'a, 'm> {
    track: Track<'a, 'm>,
    offsets: &'m mut [Offset],
    pose: &'m mut [i32],
    groups: &'m mut [Group],
    used_groups: usize,
    /// Frames of the transition that are left, and the time in the frame that runs, in ns.
    left: u8,
    rest_ns: u32,
    /// Index of the joint that carries the figure.
    carrier: usize,
    root: Root<'a>,
    travel: Travel,
    /// The root's horizontal place in the clip, with what the transition adds.
    place: [i32; 2],
    motion: RootMotion,
    events: EventQueue,
    /// Where the figure is now, and where it was before the last update.
    now: Placement,
    before: Placement,
}

impl<'a, 'm> Animator<'a, 'm> {
    /// Starts a clip at frame 0, at the world's origin. A rig that has scalars alone is [`Error::NoSuchJoint`]: a [`Track`] plays it.
    ///
    /// The figure is carried by the rig's first joint with positions: its horizontal place and its turn about the vertical axis are the figure's.
    /// [`Animator::carried_by`] takes another joint.
    pub fn new(clip: Clip<'a>, memory: Memory<'m>) -> Result<Self, Error> {
        let carrier = root::first_with_positions(&clip.rig());
        Self::carried_by(carrier, clip, memory)
    }

    /// [`Animator::new`] for a figure that is carried by the joint of an index, as where captures hang on a joint that stands still.
    pub fn carried_by(carrier: usize, clip: Clip<'a>, memory: Memory<'m>) -> Result<Self, Error> {
        let Memory { states, values, offsets, pose, groups } = memory;
        let needed = clip.rig().channels();
        let check = |what, given| if given < needed { Err(Error::TooSmall { what, needed, given }) } else { Ok(()) };
        check("offsets", offsets.len())?;
        check("values of the pose", pose.len())?;
        let (offsets, pose) = (offsets.get_mut(..needed).unwrap_or_default(), pose.get_mut(..needed).unwrap_or_default());
        let used_groups = groups::set_up(&clip.rig(), clip.form_ref(), groups)?;
        let root = Root::of(&clip.rig(), groups, carrier).ok_or(Error::NoSuchJoint)?;
        let track = Track::new(clip, states, values)?;
        let mut animator = Animator {
            track,
            offsets,
            pose,
            groups,
            used_groups,
            left: 0,
            rest_ns: 0,
            carrier,
            root,
            travel: Travel::NONE,
            place: [0; 2],
            motion: RootMotion::Travel,
            events: EventQueue::new(),
            now: Placement::default(),
            before: Placement::default(),
        };
        animator.events.at(animator.track.clip(), 0);
        animator.compose();
        animator.travel = Travel::new(Placement::default(), animator.place.map(i64::from));
        Ok(animator)
    }

    /// The clip that plays: its frame, its speed, whether it has ended.
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
        self.track.seek(frame);
        self.compose();
        self.settle(Placement::default());
    }

    /// Puts the figure to a place in the world.
    pub fn set_placement(&mut self, placement: Placement) {
        self.settle(placement);
    }

    /// Makes the root's present place stand at a placement.
    fn settle(&mut self, placement: Placement) {
        self.travel = Travel::new(placement, self.place.map(i64::from));
        self.locate();
        self.before = self.now;
    }

    /// Where the figure is, and how it is turned.
    pub fn placement(&self) -> Placement {
        self.now
    }

    /// Finds where the figure is, after everything that moves it.
    fn locate(&mut self) {
        self.now = match self.motion {
            RootMotion::Travel => self.travel.placement(self.place, self.track.seam()),
            RootMotion::InPlace => Placement { place: self.travel.anchor, heading: self.travel.heading.angle },
        };
    }

    /// What the last [`Animator::update`], [`Animator::seek`] or [`Animator::switch`] changed the placement by: the sum of all increments is
    /// the difference of the placements, exactly.
    pub fn increment(&self) -> Placement {
        let now = self.placement();
        let ([x, y], [before_x, before_y]) = (now.place, self.before.place);
        Placement { place: [x.wrapping_sub(before_x), y.wrapping_sub(before_y)], heading: now.heading - self.before.heading }
    }

    fn transition_part(&self) -> U0F16 {
        let frame_time = u64::from(self.track.clip().frame_time_ns());
        U0F16::from_bits((u64::from(self.rest_ns) << 16).checked_div(frame_time).unwrap_or(0) as u16)
    }

    /// Lets time pass, up to 71 minutes; more than 64 laps of a loop at once are cut off. The error says that events were lost; the rest is done.
    pub fn update(&mut self, elapsed_us: u32) -> Result<(), EventsLost> {
        self.before = self.placement();
        let passage = self.track.advance(elapsed_us, Some(&self.root));
        if passage.laps != 0
            && let Some(seam) = self.track.seam()
        {
            self.travel.pass(passage.laps, &seam);
        }
        let lost = self.events.lost();
        self.events.pass(self.track.clip(), &passage);
        if self.left > 0 {
            self.run_transition(elapsed_us);
        }
        self.compose();
        self.locate();
        self.events.check(lost)
    }

    /// Goes on by exactly one frame of the clip, forwards and whatever its speed: for a program that shows one picture for each frame. Where this
    /// serves it is cheaper than [`Animator::update`]. A transition goes on by a frame too.
    pub fn step(&mut self) -> Result<(), EventsLost> {
        self.before = self.placement();
        let passage = self.track.step(Some(&self.root));
        if passage.laps != 0
            && let Some(seam) = self.track.seam()
        {
            self.travel.pass(passage.laps, &seam);
        }
        let lost = self.events.lost();
        self.events.pass(self.track.clip(), &passage);
        self.rest_ns = 0;
        if self.left > 0 {
            self.left -= 1;
            self.compose_step();
            self.solve_again();
        } else {
            self.compose();
        }
        self.locate();
        self.events.check(lost)
    }

    /// Goes to a frame of the clip, or to the last one if there are fewer, without events. The transition stays where it is.
    pub fn seek(&mut self, frame: u32) {
        self.before = self.placement();
        self.track.seek(frame);
        self.compose();
        self.locate();
    }

    fn solve_again(&mut self) {
        if AGAIN.contains(&self.left) {
            let cubic = Cubic::new(self.left);
            // Those that are at zero too: what is left of their acceleration would lead away again.
            self.offsets.iter_mut().for_each(|offset| cubic.solve(offset));
        }
    }

    fn run_transition(&mut self, elapsed_us: u32) {
        let frame_time = u64::from(self.track.clip().frame_time_ns());
        let mut rest = u64::from(self.rest_ns) + u64::from(elapsed_us) * 1000;
        while rest >= frame_time && self.left > 0 {
            rest -= frame_time;
            self.left -= 1;
            for offset in self.offsets.iter_mut().filter(|offset| !offset.is_zero()) {
                offset.step();
            }
            self.solve_again();
        }
        self.rest_ns = if self.left > 0 { rest as u32 } else { 0 };
    }

    /// Writes the pose of this instant, and takes the root's place out of it.
    fn compose(&mut self) {
        let values = self.track.values();
        if let Some(values) = values.get(..self.pose.len()) {
            self.pose.copy_from_slice(values);
        }
        if self.left > 0 {
            let part = Weight::from_bits(if self.rest_ns == 0 { 0 } else { self.transition_part().to_bits() >> 1 });
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
        self.finish();
    }

    /// [`Animator::compose`] on a whole frame, with a step of the transition, in one pass.
    #[inline(never)]
    fn compose_step(&mut self) {
        for ((out, value), offset) in self.pose.iter_mut().zip(self.track.values()).zip(self.offsets.iter_mut()) {
            // Field by field: they stay in registers.
            let Offset { d, v, w, k } = *offset;
            let now = d.wrapping_add(v);
            (offset.d, offset.v, offset.w) = (now, v.wrapping_add(w), w.wrapping_add(k));
            *out = value.wrapping_add(now);
        }
        self.finish();
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
        for group in self.groups.get(..self.used_groups).unwrap_or_default() {
            let range = group.range();
            let (Some(own), Some(to)) = (self.pose.get_mut(range.clone()), pose.values.get(range)) else { continue };
            mix_group(group.shape, own, to, weight);
        }
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

    /// Goes over to a clip of the same rig, from a frame (from the last one if there are fewer) and at a speed of -4 to 4 (others are cut off).
    /// It may come in the middle of another transition. The figure keeps its place and its heading. Events at the first frame fire.
    ///
    /// On an error the old clip plays on, and a transition that ran has ended.
    ///
    /// A clip of another form costs a conversion of the joints that it codes in another way, at this instant alone; its pose has its own form.
    #[inline(never)]
    pub fn switch(&mut self, clip: Clip<'a>, frame: u32, speed: I16F16, transition: Transition) -> Result<(), Error> {
        let (old_form, new_form) = (self.form(), clip.form_ref());
        if old_form.rig_id() != new_form.rig_id() {
            return Err(WrongForm::Rig.into());
        }
        let placement = self.placement();
        let yaw_before = self.root.yaw_of(&self.pose());
        self.take_motion(&clip);
        if let Err(error) = self.track.start(clip, frame, speed) {
            self.left = 0;
            self.compose();
            return Err(error);
        }
        self.before = placement;
        let mut placement = placement;
        if old_form != new_form {
            self.convert(old_form, new_form)?;
            let shift = i32::from(old_form.length_exponent()) - i32::from(new_form.length_exponent());
            let shifted =
                |x: i64| if shift >= 0 { x.wrapping_shl(shift.min(63) as u32) } else { x >> shift.unsigned_abs().min(63) };
            placement.place = placement.place.map(shifted);
            self.before = placement;
        }
        // The new clip's heading stands where the old one's stood.
        let turned = yaw_before - self.root.yaw_of(&self.track.pose());
        let now = Placement { heading: placement.heading + turned, ..placement };
        let first = usize::from(self.root.turns.first);
        let (mut here, mut next) = ([0; 4], [0; 4]);
        let len = usize::from(self.root.turns.len).min(4);
        let (here, next) = (here.get_mut(..len).unwrap_or_default(), next.get_mut(..len).unwrap_or_default());
        let own = self.offsets.get_mut(first..).unwrap_or_default();
        for ((here, next), own) in here.iter_mut().zip(next.iter_mut()).zip(own.iter()) {
            (*here, *next) = (own.d, own.v);
        }
        self.root.turn_by(-turned, here);
        self.root.turn_by(-turned, next);
        for ((here, next), own) in here.iter().zip(next.iter()).zip(own) {
            (own.d, own.v) = (*here, *next);
        }
        let back = Heading::new(-turned);
        self.turn_velocity(&back);
        self.difference(transition);
        self.left = transition.frames();
        self.rest_ns = 0;
        let cubic = Cubic::new(self.left);
        // Where the root's own velocity would have carried it before it died out is added to the way.
        let carried = self.root.place;
        for channel in carried.iter().flatten() {
            if let Some(offset) = self.offsets.get_mut(usize::from(*channel)) {
                let way = i64::from(offset.v) * i64::from(self.left);
                offset.d = (-(way.checked_div(3).unwrap_or(0))) as i32;
            }
        }
        self.offsets.iter_mut().for_each(|offset| cubic.solve(offset));
        self.events.at(self.track.clip(), self.track.frame());
        self.compose();
        self.travel = Travel::new(now, self.place.map(i64::from));
        self.locate();
        Ok(())
    }

    /// Keeps the pose of this instant and of a frame of the new clip later, in difference and velocity of each offset.
    fn take_motion(&mut self, clip: &Clip<'a>) {
        // How much of a frame of the old clip passes in one of the new, in 2^-16.
        let (old, new) = (self.track.clip().frame_time_ns(), clip.frame_time_ns());
        let ratio = (u64::from(new) << 16).checked_div(old.into()).unwrap_or(0).min(1 << 30) as i64;
        let running = self.left > 0;
        for (offset, value) in self.offsets.iter_mut().zip(self.pose.iter()) {
            let own = if running { scaled(offset.v, ratio) } else { 0 };
            (offset.d, offset.v) = (*value, value.wrapping_add(own));
        }
        let speed = (i64::from(self.track.speed().to_bits()) * ratio) >> 16;
        for (slot, v) in self.track.velocities() {
            if let Some(offset) = self.offsets.get_mut(slot) {
                offset.v = offset.v.wrapping_add(scaled(v, speed));
            }
        }
    }

    /// Turns the horizontal velocity that the root's channels keep.
    fn turn_velocity(&mut self, by: &Heading) {
        let [Some(a), Some(b)] = self.root.place.map(|channel| channel.map(usize::from)) else { return };
        let of = |offsets: &[Offset], at: usize| offsets.get(at).map_or(0, |offset| offset.v.wrapping_sub(offset.d));
        let velocity = by.rotate([of(self.offsets, a), of(self.offsets, b)]);
        for (at, v) in [a, b].into_iter().zip(velocity) {
            if let Some(offset) = self.offsets.get_mut(at) {
                offset.v = offset.d.wrapping_add(v as i32);
            }
        }
    }

    /// Makes the kept pose and the pose a frame later the difference to the new clip's pose, and its velocity.
    fn difference(&mut self, transition: Transition) {
        let values = self.track.values();
        for group in self.groups.get(..self.used_groups).unwrap_or_default() {
            if group.shape != Shape::Free {
                let range = group.range();
                let (Some(own), Some(to)) = (self.offsets.get_mut(range.clone()), values.get(range)) else { continue };
                let (mut here, mut next) = ([0; 4], [0; 4]);
                for ((here, next), own) in here.iter_mut().zip(next.iter_mut()).zip(own.iter()) {
                    (*here, *next) = (own.d, own.v);
                }
                let (here, next) = (here.get_mut(..own.len()).unwrap_or_default(), next.get_mut(..own.len()).unwrap_or_default());
                nearest(group.shape, here, to);
                nearest(group.shape, next, here);
                for ((here, next), own) in here.iter().zip(next.iter()).zip(own) {
                    (own.d, own.v) = (*here, *next);
                }
            }
        }
        let still = matches!(transition, Transition::Faded(_));
        for (offset, value) in self.offsets.iter_mut().zip(values) {
            let velocity = if still { 0 } else { offset.v.wrapping_sub(offset.d) };
            (offset.d, offset.v) = (offset.d.wrapping_sub(*value), velocity);
        }
        if !still {
            let speed = i64::from(self.track.speed().to_bits());
            for (slot, v) in self.track.velocities() {
                if let Some(offset) = self.offsets.get_mut(slot) {
                    offset.v = offset.v.wrapping_sub(scaled(v, speed));
                }
            }
        }
    }

    /// Brings the kept poses from one form to another.
    #[inline(never)]
    fn convert(&mut self, from: FormRef<'_>, to: FormRef<'_>) -> Result<(), Error> {
        let rig = self.track.clip().rig();
        let shift = i32::from(from.length_exponent()) - i32::from(to.length_exponent());
        let used = groups::set_up(&rig, to, self.groups)?;
        self.used_groups = used;
        let from_form = from.to_form();
        for (joint, index) in rig.joints().zip(0u16..) {
            for (kind, channel) in joint.kinds.zip(usize::from(joint.first_channel)..) {
                if kind.is_position()
                    && let Some(offset) = self.offsets.get_mut(channel)
                {
                    (offset.d, offset.v) = (shifted(offset.d, shift), shifted(offset.v, shift));
                }
            }
            let groups = self.groups.get(..used).unwrap_or_default();
            let Some(group) = groups.iter().find(|group| group.bit == index && matches!(group.shape, Shape::Euler | Shape::Map))
            else {
                continue;
            };
            let was = match (from_form.is_exponential(&rig, index.into()), { joint.kinds }.any(|kind| kind.is_rotation())) {
                (true, true) => Shape::Map,
                (false, true) => Shape::Euler,
                _ => continue,
            };
            if was == group.shape {
                continue;
            }
            let Some(own) = self.offsets.get_mut(group.range()) else { continue };
            let read = |of: fn(&Offset) -> i32| {
                let mut values = [0; 3];
                for (value, own) in values.iter_mut().zip(own.iter()) {
                    *value = of(own);
                }
                values
            };
            let convert = |mut values: [i32; 3]| {
                if let Some(turn) = math::turn_of(was, joint.kinds, &values) {
                    math::write(group.shape, joint.kinds, turn.quaternion(), &mut values);
                }
                values
            };
            let (here, next) = (convert(read(|own| own.d)), convert(read(|own| own.v)));
            for ((own, here), next) in own.iter_mut().zip(here).zip(next) {
                (own.d, own.v) = (here, next);
            }
        }
        self.root = Root::of(&rig, self.groups.get(..used).unwrap_or_default(), self.carrier).ok_or(Error::NoSuchJoint)?;
        Ok(())
    }
}

/// A velocity times a factor in 2^-16.
fn scaled(v: i32, factor: i64) -> i32 {
    if factor == 1 << 16 { v } else { ((i64::from(v) * factor) >> 16) as i32 }
}

/// A length in another unit: times 2^`shift`, rounded down; cut off at the range of a channel.
fn shifted(x: i32, shift: i32) -> i32 {
    let wide = i64::from(x);
    let wide = if shift >= 0 { wide << shift.min(31) } else { wide >> shift.unsigned_abs().min(31) };
    wide.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32
}
