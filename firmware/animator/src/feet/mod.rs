//! Feet that stay where they are put: for each foot of a bank's table the point that is on the ground, in states and through transitions.
//!
//! At a transition the new clip is placed by a foot that is on the ground in both clips, and the figure glides there while the transition lasts. Inverse
//! kinematics and the height of the figure's carrier take the rest.

mod foot;
mod frame;

use crate::Error;
use crate::animator::{Animator, RootMotion};
use crate::chain::shifted;
use crate::machine::{FEET, FeetTable, TableError};
use foot::{Foot, Wanted, difference};
use frame::Frame;
use heapless::Vec;
use pantin::Bank;

/// A figure goes down and comes up by a fraction of its way in each update, nearly two thirds of it in this time: nearly straight legs bend by the root of the
/// way.
const DROP_US: i64 = 50_000;

/// The feet of a [`crate::Character`], to be lent to it: [`crate::Character::lend_feet`]. About 2 kB.
#[derive(Clone, Debug, Default)]
pub struct Feet<'a> {
    table: Option<FeetTable<'a>>,
    feet: Vec<Foot<'a>, FEET>,
    /// 2 cm in raw units, and the exponent of this unit.
    most_drop: i32,
    exponent: i8,
    /// How far the figure went down in the last update, in figure units.
    sunk: i32,
}

/// Where the clip that plays is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    /// The clip's index in the bank.
    pub(crate) clip: u8,
    pub(crate) frame: u32,
    /// Whether a part of another clip is in the pose.
    pub(crate) blended: bool,
    /// Whether a state was entered in this update.
    pub(crate) entered: bool,
    pub(crate) elapsed_us: u32,
}

/// What corrects a pose after an update: [`hold`].
pub(crate) type Hold<'a> = fn(&mut Feet<'a>, &mut Animator<'a, '_>, Instant) -> Result<(), Error>;

impl<'a> Feet<'a> {
    /// Feet of no character yet.
    pub const fn new() -> Feet<'a> {
        Feet { table: None, feet: Vec::new(), most_drop: 0, exponent: 0, sunk: 0 }
    }

    /// The joint at which a foot of the table is held, by its index in the rig; `None` while the clip moves the foot.
    pub fn held(&self, foot: usize) -> Option<u16> {
        let point = self.feet.get(foot)?.held()?;
        let row = self.table?.foot(foot)?;
        match usize::from(point).checked_sub(1) {
            None => Some(row.ankle),
            Some(at) => row.points().get(at).copied(),
        }
    }

    /// Sets up the feet of a bank's table. Feet that were lent before go on as they were.
    pub(crate) fn set_up(&mut self, bank: &Bank<'a>, animator: &Animator<'a, '_>) -> Result<FeetTable<'a>, Error> {
        if let Some(table) = self.table {
            return Ok(table);
        }
        let table = FeetTable::of(bank).map_err(Error::Machine)?.ok_or(Error::Machine(TableError::Missing))?;
        let (clip, groups) = (animator.track().clip(), animator.groups());
        self.feet.clear();
        for row in (0..table.feet()).filter_map(|index| table.foot(index)) {
            let _ = self.feet.push(Foot::new(row, clip, groups)?);
        }
        self.table = Some(table);
        self.measure(animator);
        Ok(table)
    }

    fn measure(&mut self, animator: &Animator<'a, '_>) {
        let clip = animator.track().clip();
        self.exponent = clip.length_exponent();
        // In 2^-8 of the source's unit.
        let units = (2_000_000u32 << 8).checked_div(clip.rig().unit_micro_cm()).unwrap_or(0);
        self.most_drop = shifted(units.min(1 << 30) as i32, i32::from(self.exponent) + 8);
    }

    /// Brings the feet to the form of the clip that plays now.
    fn follow_form(&mut self, animator: &Animator<'a, '_>) -> Result<(), Error> {
        let (Some(table), clip) = (self.table, animator.track().clip()) else { return Ok(()) };
        let shift = i32::from(self.exponent) - i32::from(clip.length_exponent());
        for (index, foot) in self.feet.iter_mut().enumerate() {
            if let Some(row) = table.foot(index) {
                *foot = foot.in_form(row, clip, animator.groups(), shift)?;
            }
        }
        self.measure(animator);
        Ok(())
    }

    /// Places the clip that was entered by the feet that are held and are on the ground in it, too. Others that are on the ground before or after step
    /// to their places.
    fn enter(&mut self, animator: &mut Animator<'a, '_>, frame: &Frame, contacts: [Option<u8>; FEET]) {
        // Its own pose is asked for below.
        animator.leave_carried();
        let mut ways = [None; FEET];
        for ((foot, contact), way) in self.feet.iter_mut().zip(contacts).zip(&mut ways) {
            let values = animator.track().values();
            let places = foot.limb.places(values);
            foot.limb.learn(&places);
            let Some(point) = contact.or(foot.held()) else { continue };
            let (at, place) = (foot.place(animator.pose, frame, point), foot.point(values, &places, point));
            let [a, b, _] = difference(at, Frame::new(animator.end_of_glide(), animator.root.up()).to_world(place));
            *way = Some(Entered { point, at, way: [a, b], stays: contact.is_some() && foot.held().is_some() });
        }
        let length = self.feet.first().map_or(0, |foot| i64::from(foot.limb.length()));
        let stays = ways.map(|own| own.filter(|own| own.stays).map(|own| own.way));
        let glide = if animator.transition_left() < 2 { [0; 2] } else { glide(stays, length) };
        animator.glide(glide);
        let left_us = u64::from(animator.transition_left()) * u64::from(animator.track().clip().frame_time_ns()) / 1000;
        let [glide_a, glide_b] = glide;
        for ((foot, contact), entered) in self.feet.iter_mut().zip(contacts).zip(ways) {
            let Some(Entered { point, at, way: [a, b], stays }) = entered else { continue };
            let far = a.wrapping_sub(glide_a).saturating_abs().max(b.wrapping_sub(glide_b).saturating_abs());
            if stays && far <= length / 12 {
                foot.hold_on(point, at);
            } else {
                foot.step(contact, far, left_us.min(u32::MAX.into()) as u32);
            }
        }
    }

    /// How far the figure's carrier goes down so that the legs reach, in figure units.
    fn drop(&self, wanted: &[Option<Wanted>; FEET], up: usize, negative: bool) -> i32 {
        let mut drop = 0;
        for wanted in wanted {
            let Some(Wanted { places: [_, hip, ..], target, free }) = wanted else { continue };
            let way = pantin_math::vector::sub(hip.place, *target);
            let height = way.get(up).map_or(0, |height| i64::from(if negative { -*height } else { *height }));
            let flat = way.iter().map(|x| i64::from(*x).pow(2)).sum::<i64>() - height * height;
            let reached = (i64::from(*free).pow(2) - flat).max(0).unsigned_abs().isqrt() as i64;
            drop = drop.max(height - reached);
        }
        let most = self.feet.first().map_or(0, |foot| shifted(self.most_drop, foot.limb.shift()));
        drop.min(most.into()) as i32
    }
}

/// A foot when a clip is entered: on the ground in it, or held before.
#[derive(Clone, Copy)]
struct Entered {
    /// The point of it that is or was on the ground, and where that is in the world.
    point: u8,
    at: [i64; 3],
    /// The way to there from its place in the clip.
    way: [i64; 2],
    /// Whether it is on the ground before and after.
    stays: bool,
}

/// The way that brings the feet to where they are held: of two the mean, or the shorter one if they are far apart.
fn glide(ways: [Option<[i64; 2]>; FEET], length: i64) -> [i64; 2] {
    let far = |[a, b]: [i64; 2]| a.abs().max(b.abs());
    let way = match ways {
        [Some(one), Some(other)] => {
            let ([a, b], [x, y]) = (one, other);
            if far([a - x, b - y]) <= length / 8 {
                [(a + x) / 2, (b + y) / 2]
            } else if far(one) <= far(other) {
                one
            } else {
                other
            }
        }
        [Some(way), None] | [None, Some(way)] => way,
        [None, None] => [0; 2],
    };
    if far(way) <= length / 2 { way } else { [0; 2] }
}

/// Corrects the pose of an update.
pub(crate) fn hold<'a>(feet: &mut Feet<'a>, animator: &mut Animator<'a, '_>, now: Instant) -> Result<(), Error> {
    let Some(table) = feet.table else { return Ok(()) };
    if animator.motion == RootMotion::InPlace {
        return Ok(());
    }
    if now.entered {
        feet.follow_form(animator)?;
    }
    let (up, negative) = (animator.root.up(), animator.track().clip().rig().up().is_negative());
    let frame = Frame::new(animator.placement(), up);
    let contacts = [0, 1].map(|foot| table.contact(now.clip, foot, now.frame));
    if now.entered {
        feet.enter(animator, &frame, contacts);
    }
    let calm = animator.transition_left() == 0 && !now.blended;
    let mut wanted = [None; FEET];
    for ((foot, contact), wanted) in feet.feet.iter_mut().zip(contacts).zip(&mut wanted) {
        *wanted = foot.update(animator.pose, &frame, contact, calm, now.elapsed_us);
    }
    let goal = feet.drop(&wanted, up, negative);
    let drop = goal + (i64::from(feet.sunk - goal) * DROP_US / (DROP_US + i64::from(now.elapsed_us))) as i32;
    feet.sunk = drop;
    let down = |place: [i32; 3], by: i32| {
        let mut place = place;
        if let Some(height) = place.get_mut(up) {
            *height = height.wrapping_sub(if negative { -by } else { by });
        }
        place
    };
    let shift = feet.feet.first().map_or(0, |foot| foot.limb.shift());
    let height = feet.feet.first().and_then(|foot| foot.limb.height(up)).filter(|_| drop > 0);
    let height = height.and_then(|channel| animator.pose.get_mut(usize::from(channel)));
    let drop = if height.is_some() { drop } else { 0 };
    if let Some(height) = height {
        let raw = shifted(drop, -shift);
        *height = height.wrapping_sub(if negative { -raw } else { raw });
    }
    for (foot, wanted) in feet.feet.iter_mut().zip(wanted) {
        // A foot that is free stays where it is while the figure goes down.
        let own = || {
            let places = foot.limb.places(animator.pose);
            let [.., ankle] = places;
            let places = places.map(|joint| crate::chain::Joint { place: down(joint.place, -drop), ..joint });
            let target = down(ankle.place, -drop);
            Wanted { places, target, free: foot.limb.free(&places, target) }
        };
        let Some(Wanted { mut places, target, free }) = wanted.or_else(|| (drop > 0).then(own)) else { continue };
        for joint in &mut places {
            joint.place = down(joint.place, drop);
        }
        let target = foot.limb.within(&places, free, target);
        foot.limb.solve_from(&places, animator.pose, target, None);
    }
    Ok(())
}
