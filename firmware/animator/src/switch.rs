//! Going over to another clip: what is kept of the old motion, and the difference to the new one, which dies out.

use crate::Error;
use crate::animator::Animator;
use crate::groups::{self, Group, Shape, nearest};
use crate::layer::Weight;
use crate::math::{self, Unit};
use crate::root::{Heading, Placement, Root, Travel};
use crate::track::Track;
use crate::transition::{Cubic, Offset, Transition, swing};
use fixed::types::I16F16;
use pantin::{Angle, Clip, FormRef, Joint, WrongForm};

impl<'a> Animator<'a, '_> {
    /// Goes over to a clip of the same rig, from a frame (from the last one if there are fewer) and at a speed of -4 to 4 (others are cut off).
    /// It may come in the middle of another transition. The figure keeps its place and its heading. Events at the first frame fire.
    ///
    /// On an error the old clip plays on, and a transition that ran has ended.
    ///
    /// A clip of another form costs a conversion of the joints that it codes in another way, at this instant alone; its pose has its own form.
    pub fn switch(&mut self, clip: Clip<'a>, frame: u32, speed: I16F16, transition: Transition) -> Result<(), Error> {
        self.switch_mixed(None, clip, frame, speed, transition)
    }

    /// [`Animator::switch`] from a pose into which a weight of a second clip was mixed.
    #[inline(never)]
    pub(crate) fn switch_mixed(
        &mut self,
        mixed: Option<(&Track<'a, '_>, Weight)>,
        clip: Clip<'a>,
        frame: u32,
        speed: I16F16,
        transition: Transition,
    ) -> Result<(), Error> {
        let (old_form, new_form) = (self.form(), clip.form_ref());
        if old_form.rig_id() != new_form.rig_id() {
            return Err(WrongForm::Rig.into());
        }
        self.leave_carried();
        let mut placement = self.placement();
        let (converts, frames) = (old_form != new_form, transition.frames());
        let turned_before = self.root.turn_in(&self.pose());
        let yaw_before = self.root.yaw_of(turned_before);
        self.take_motion(&clip, mixed);
        if let Err(error) = self.track.start(clip, frame, speed) {
            self.left = 0;
            self.compose();
            return Err(error);
        }
        if converts {
            self.convert(old_form, new_form)?;
            let shift = i32::from(old_form.length_exponent()) - i32::from(new_form.length_exponent());
            let shifted =
                |x: i64| if shift >= 0 { x.wrapping_shl(shift.min(63) as u32) } else { x >> shift.unsigned_abs().min(63) };
            placement.place = placement.place.map(shifted);
            self.before.place = self.before.place.map(shifted);
        }
        // The new clip's heading stands where the old one's stood.
        let turned = yaw_before - self.root.yaw_of(self.root.turn_in(&self.track.pose()));
        if frames > 0 {
            let known = (!converts && self.root.is_whole()).then_some(turned_before);
            self.turn_motion(-turned, known);
            self.difference(transition);
        }
        self.start_transition(frames);
        self.events.at(self.track.clip(), self.track.frame());
        self.compose();
        let now = Placement { heading: placement.heading + turned, ..placement };
        self.travel = Travel::new(now, self.place.map(i64::from));
        self.locate();
        Ok(())
    }

    /// Where the figure will be, by its clip alone, when the transition that runs has ended and the clip still stood where it does now.
    pub(crate) fn end_of_glide(&self) -> Placement {
        let values = self.track.values();
        let place = self.root.place.map(|channel| channel.and_then(|at| values.get(usize::from(at)).copied()).unwrap_or(0));
        let at = self.travel.placement(place, self.track.seam());
        // The points of the clip's pose have its place in them.
        let [x, y] = at.place;
        let [a, b] = Heading::new(at.heading).rotate(place);
        Placement { place: [x.wrapping_sub(a), y.wrapping_sub(b)], ..at }
    }

    /// Lets the figure go a way of the world beside its clip's while the transition lasts. Nothing moves in this instant.
    pub(crate) fn glide(&mut self, way: [i64; 2]) {
        if way == [0; 2] || self.left == 0 {
            return;
        }
        self.leave_carried();
        let way = Heading::new(-self.travel.heading.angle).rotate(way.map(|x| x as i32));
        let cubic = Cubic::new(self.left);
        let channels = self.root.place.iter().zip(way).zip(self.place.iter_mut().zip(&mut self.travel.origin));
        for ((channel, way), (place, origin)) in channels {
            let Some(offset) = channel.and_then(|channel| self.offsets.get_mut(usize::from(channel))) else { continue };
            offset.d = offset.d.wrapping_sub(way as i32);
            *place = place.wrapping_sub(way as i32);
            *origin = origin.wrapping_sub(way);
            cubic.solve(offset);
        }
    }

    /// Keeps the pose of this instant and of a frame of the new clip later, in difference and velocity of each offset.
    fn take_motion(&mut self, clip: &Clip<'a>, mixed: Option<(&Track<'a, '_>, Weight)>) {
        let own = ratio(self.track.clip(), clip);
        self.track.leave_offsets();
        let running = self.left > 0;
        for (offset, value) in self.offsets.iter_mut().zip(self.pose.iter()) {
            let v = if running { scaled(offset.v, own) } else { 0 };
            (offset.d, offset.v) = (*value, value.wrapping_add(v));
        }
        let mut add = |track: &Track<'_, '_>, weight: Weight| {
            let speed = (i64::from(track.speed().to_bits()) * ratio(track.clip(), clip)) >> 16;
            for (slot, v) in track.velocities() {
                if let Some(offset) = self.offsets.get_mut(slot) {
                    offset.v = offset.v.wrapping_add(scaled(weight.of(v), speed));
                }
            }
        };
        add(&self.track, mixed.map_or(Weight::ONE, |(_, weight)| weight.rest()));
        if let Some((second, weight)) = mixed {
            add(second, weight);
        }
    }

    /// Turns the root in the kept poses, and its horizontal velocity. `known` is its rotation in the pose of this instant, if that is known.
    fn turn_motion(&mut self, by: Angle, known: Option<Unit>) {
        let first = usize::from(self.root.turns.first);
        let channels = first..first + usize::from(self.root.turns.len);
        let (root, yaw) = (&self.root, self.root.yaw_by(by));
        change(self.offsets.get_mut(channels).unwrap_or_default(), |here, next| {
            root.turn_by(&yaw, here, known);
            root.turn_by(&yaw, next, None);
        });
        let [Some(a), Some(b)] = self.root.place.map(|channel| channel.map(usize::from)) else { return };
        let of = |offsets: &[Offset], at: usize| offsets.get(at).map_or(0, |offset| offset.v.wrapping_sub(offset.d));
        let velocity = Heading::new(by).rotate([of(self.offsets, a), of(self.offsets, b)]);
        for (at, v) in [a, b].into_iter().zip(velocity) {
            if let Some(offset) = self.offsets.get_mut(at) {
                offset.v = offset.d.wrapping_add(v as i32);
            }
        }
    }

    /// Makes the kept pose and the pose a frame later the difference to the new clip's pose, and its velocity.
    fn difference(&mut self, transition: Transition) {
        let values = self.track.values();
        let groups = self.groups.get(..self.used_groups).unwrap_or_default();
        for group in groups.iter().filter(|group| group.shape != Shape::Free) {
            let (Some(own), Some(to)) = (self.offsets.get_mut(group.range()), values.get(group.range())) else { continue };
            if is_near(group.shape, own, to) {
                continue;
            }
            change(own, |here, next| {
                nearest(group.shape, here, to);
                nearest(group.shape, next, here);
            });
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

    /// Lets the differences die out in a number of frames of the new clip.
    fn start_transition(&mut self, frames: u8) {
        let swing = swing(frames, self.track.clip().frame_time_ns());
        (self.left, self.left_then, self.rest_ns) = (frames, swing.map_or(0, |few| frames - few), 0);
        let cubic = Cubic::new(frames);
        if let Some(few) = swing {
            let fast = Cubic::new(few);
            self.offsets.iter_mut().for_each(|offset| cubic.solve_apart(&fast, offset));
        } else {
            cubic.solve_all(self.offsets);
        }
        // The figure keeps its place: only the root's velocity dies out, and where it carries the root is added to the way.
        for channel in self.root.place.into_iter().flatten() {
            if let Some(offset) = self.offsets.get_mut(usize::from(channel)) {
                offset.coast(frames);
                cubic.solve(offset);
            }
        }
    }

    /// Brings the kept poses from one form to another.
    #[inline(never)]
    fn convert(&mut self, from: FormRef<'_>, to: FormRef<'_>) -> Result<(), Error> {
        let rig = self.track.clip().rig();
        let shift = i32::from(from.length_exponent()) - i32::from(to.length_exponent());
        self.used_groups = groups::set_up(&rig, to, self.groups)?;
        let groups = self.groups.get(..self.used_groups).unwrap_or_default();
        let from_form = from.to_form();
        for (joint, index) in rig.joints().zip(0u16..) {
            for (kind, channel) in joint.kinds.zip(usize::from(joint.first_channel)..) {
                if kind.is_position()
                    && let Some(offset) = self.offsets.get_mut(channel)
                {
                    (offset.d, offset.v) = (shifted(offset.d, shift), shifted(offset.v, shift));
                }
            }
            if { joint.kinds }.any(|kind| kind.is_rotation())
                && let Some(group) = groups.iter().find(|group| group.bit == index && is_three(group))
            {
                let was = if from_form.is_exponential(&rig, index.into()) { Shape::Map } else { Shape::Euler };
                convert_group(was, group, &joint, self.offsets);
            }
        }
        self.root = Root::of(&rig, groups, self.carrier).ok_or(Error::NoCarrier)?;
        Ok(())
    }
}

/// Whether a group is a rotation of three channels, which one clip codes as Euler angles and another as a map.
fn is_three(group: &Group) -> bool {
    matches!(group.shape, Shape::Euler | Shape::Map)
}

/// Brings the kept poses of a joint from the shape that it had to that of its group.
fn convert_group(was: Shape, group: &Group, joint: &Joint<'_>, offsets: &mut [Offset]) {
    if was == group.shape {
        return;
    }
    let convert = |values: &mut [i32]| {
        if let Some(turn) = math::turn_of(was, joint.kinds, values) {
            math::write(group.shape, joint.kinds, turn.quaternion(), values);
        }
    };
    change(offsets.get_mut(group.range()).unwrap_or_default(), |here, next| {
        convert(here);
        convert(next);
    });
}

/// Changes the kept pose of at most 4 channels, of this instant and of a frame later: they are in the offsets' `d` and `v`.
fn change(offsets: &mut [Offset], with: impl FnOnce(&mut [i32], &mut [i32])) {
    let (mut here, mut next) = ([0; 4], [0; 4]);
    for ((here, next), own) in here.iter_mut().zip(&mut next).zip(offsets.iter()) {
        (*here, *next) = (own.d, own.v);
    }
    let len = offsets.len().min(4);
    with(here.get_mut(..len).unwrap_or_default(), next.get_mut(..len).unwrap_or_default());
    for ((here, next), own) in here.iter().zip(&next).zip(offsets) {
        (own.d, own.v) = (*here, *next);
    }
}

/// Whether the kept poses of a group are as near to a clip's pose as [`nearest`] could bring them, as they are mostly.
#[inline(always)]
fn is_near(shape: Shape, own: &[Offset], to: &[i32]) -> bool {
    let (&[a, b, c], &[x, y, z]) = (own, to) else { return false };
    let near = |own: Offset, to: i32| groups::is_near(own.d, to) & groups::is_near(own.v, own.d);
    // Maps do not wrap.
    let wraps = |own: Offset, to: i32| own.d.checked_sub(to).is_none() | own.v.checked_sub(own.d).is_none();
    near(a, x) && near(b, y) && near(c, z) && !(shape == Shape::Map && (wraps(a, x) | wraps(b, y) | wraps(c, z)))
}

/// How much of a frame of one clip passes in one of another, in 2^-16.
fn ratio(of: &Clip<'_>, clip: &Clip<'_>) -> i64 {
    let (old, new) = (of.frame_time_ns(), clip.frame_time_ns());
    if new == old { 1 << 16 } else { (u64::from(new) << 16).checked_div(old.into()).unwrap_or(0).min(1 << 30) as i64 }
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
