//! One foot: where it is held, and how it is let go.

use super::frame::Frame;
use crate::Error;
use crate::chain::{Bone, Joint, shifted, units};
use crate::ease::{Ease, part};
use crate::groups::Group;
use crate::machine::{FootRow, POINTS, TableError};
use crate::two_bone::{Limb, Limits};
use heapless::Vec;
use pantin::{Angle, Clip};
use pantin_math::rotation::Vector;

/// The time in which a foot that is let go comes back to its clip, at least: one that steps to its place in the clip that was entered takes as long as
/// the transition.
const RELEASE_US: u32 = 200_000;
/// The longest step.
const LONGEST_US: u32 = 4_000_000;

/// Where a foot is in its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The clip moves it.
    Free,
    /// A point of it stays where it is in the world.
    Locked(u8),
    /// It goes back to the clip's motion.
    Released,
}

/// A foot of the table.
#[derive(Clone, Debug)]
pub(super) struct Foot<'a> {
    pub(super) limb: Limb<'a>,
    /// Its points, each with the number of that on which it hangs: 0 is the ankle.
    points: Vec<(Bone<'a>, u8), POINTS>,
    state: State,
    /// The point that was on the ground at the last update, and where it was in the world.
    before: Option<u8>,
    at: [i64; 3],
    /// Where the locked point stays. The height stays while `level`.
    anchor: [i64; 3],
    level: bool,
    /// The least height over the ground at which the pose had the locked point.
    lowest: i64,
    /// Let go because the clip has it elsewhere: it is not held again before it has come there, in a time of its own.
    steps: bool,
    step_us: u32,
    flat: [Ease; 2],
    rise: Ease,
    /// Time since the foot was let go, and since its height was.
    since_us: [u32; 2],
    /// How high it is lifted on its way back.
    lift: i32,
    /// Whether the ground is above, in raw units.
    upside_down: bool,
}

/// The places of a limb, where its end is to be, and its [`Limb::free`] distance: in figure units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) places: [Joint; 4],
    pub(super) target: Vector,
    pub(super) free: i32,
}

impl<'a> Foot<'a> {
    pub(super) fn new(row: FootRow, clip: &Clip<'a>, groups: &[Group]) -> Result<Foot<'a>, Error> {
        let (rig, ankle) = (clip.rig(), usize::from(row.ankle));
        // A clip may stretch its legs wholly.
        let limits = Limits { least: Angle::from_bits(crate::procedural::degrees(1)), ..Limits::default() };
        let limb = Limb::to_joint(clip, groups, ankle, limits)?;
        let (down, _) = units(clip);
        let bad = Error::Machine(TableError::BadValue);
        let mut points = Vec::new();
        for (number, &index) in row.points().iter().enumerate() {
            let joint = rig.joint(index.into()).ok_or(bad)?;
            let before = row.points().get(..number).unwrap_or_default();
            let hangs = |other: u16| joint.parent == Some(other);
            let parent = if hangs(row.ankle) { Some(0) } else { before.iter().position(|other| hangs(*other)).map(|at| at + 1) };
            let bone = Bone::of(&joint, index.into(), groups, down);
            points.push((bone, parent.ok_or(bad)? as u8)).map_err(|_| bad)?;
        }
        Ok(Foot {
            limb,
            points,
            state: State::Free,
            before: None,
            at: [0; 3],
            anchor: [0; 3],
            level: false,
            lowest: i64::MAX,
            steps: false,
            step_us: RELEASE_US,
            flat: [Ease::default(); 2],
            rise: Ease::default(),
            since_us: [RELEASE_US; 2],
            lift: 0,
            upside_down: rig.up().is_negative(),
        })
    }

    /// Converts the foot to another form of clips. The unit of that form is 2^-`shift` old units.
    pub(super) fn in_form(&self, row: FootRow, clip: &Clip<'a>, groups: &[Group], shift: i32) -> Result<Foot<'a>, Error> {
        let Foot { mut limb, points, .. } = Foot::new(row, clip, groups)?;
        limb.bends_as(&self.limb);
        let wide = |x: i64| if shift >= 0 { x.wrapping_shl(shift.min(63) as u32) } else { x >> shift.unsigned_abs().min(63) };
        let ease = |own: Ease| own.in_unit(shift);
        let (flat, rise, lift) = (self.flat.map(ease), ease(self.rise), shifted(self.lift, -shift));
        Ok(Foot { limb, points, at: self.at.map(wide), anchor: self.anchor.map(wide), flat, rise, lift, ..self.clone() })
    }

    fn joint(&self, pose: &[i32], ankle: &Joint, point: u8) -> Joint {
        // Parents have smaller numbers.
        match usize::from(point).checked_sub(1).and_then(|at| self.points.get(at)) {
            Some((bone, parent)) if *parent < point => bone.after(&self.joint(pose, ankle, *parent), pose, self.limb.shift()),
            _ => *ankle,
        }
    }

    /// Where a point of the foot is in a pose, in its raw unit.
    pub(super) fn point(&self, pose: &[i32], [.., ankle]: &[Joint; 4], point: u8) -> [i32; 3] {
        self.joint(pose, ankle, point).place.map(|x| shifted(x, -self.limb.shift()))
    }

    /// The point at which it is held.
    pub(super) fn held(&self) -> Option<u8> {
        if let State::Locked(point) = self.state { Some(point) } else { None }
    }

    /// Where a point of the foot is now, in the world: the height of a held foot is not its anchor's.
    pub(super) fn place(&self, pose: &[i32], frame: &Frame, point: u8) -> [i64; 3] {
        let places = self.limb.places(pose);
        let own = |point: u8| frame.to_world(self.point(pose, &places, point));
        let at = own(point);
        match self.state {
            State::Locked(held) => {
                let ([a, b, _], [.., height]) = (sum(self.anchor, difference(at, own(held))), at);
                [a, b, height.wrapping_add(self.left_height().into())]
            }
            _ => sum(at, self.left().map(i64::from)),
        }
    }

    /// Goes on being held in another clip, at a point and a place, until the transition has ended at this height.
    pub(super) fn hold_on(&mut self, point: u8, anchor: [i64; 3]) {
        (self.state, self.anchor, self.level, self.before) = (State::Locked(point), anchor, true, Some(point));
        self.lowest = i64::MAX;
    }

    /// Enters a clip in which its place is `far` away along one axis, and steps there while a transition of `left_us` runs. If it is on the ground
    /// there, it is held when it has come to rest.
    pub(super) fn step(&mut self, contact: Option<u8>, far: i64, left_us: u32) {
        self.before = contact;
        if self.held().is_none() {
            // What is near goes with its clips.
            if far <= i64::from(self.limb.length() / 24) || left_us == 0 {
                return;
            }
            self.rest();
        }
        // A foot that was in the air has nothing to come back from.
        let least = if self.held().is_none() && self.flat == [Ease::default(); 2] { 1 } else { RELEASE_US };
        self.release(far);
        self.steps = true;
        self.step_us = left_us.clamp(least, LONGEST_US);
        self.flat = self.flat.map(|own| own.in_time(RELEASE_US, self.step_us));
    }

    /// What is left of its way has no velocity from now on; its lift is a part of the height that is left.
    fn rest(&mut self) {
        let [a, b, height] = self.left().map(Ease::at_rest);
        self.flat = [a, b];
        if self.lift != 0 {
            let [_, since] = &mut self.since_us;
            (self.rise, *since) = (height, 0);
        }
    }

    /// Lets go of a foot that is this far from where it goes, along one axis: it is lifted on its way by a quarter of this, and by an eighth of the leg at most.
    fn release(&mut self, far: i64) {
        let lift = (far.min(i64::from(self.limb.length() / 2)) / 4) as i32;
        self.lift = if self.upside_down { -lift } else { lift };
        (self.state, self.steps, self.step_us) = (State::Released, false, RELEASE_US);
        let [flat, height] = &mut self.since_us;
        *flat = 0;
        if self.level {
            (self.level, *height) = (false, 0);
        }
    }

    fn left_height(&self) -> i32 {
        let [flat, height] = self.since_us;
        let t = part(flat, self.step_us);
        // The square of 4 t (1 - t), in 2^-13 of a lift: from rest to rest.
        let up = if self.state == State::Released { (t * ((1 << 15) - t.min(1 << 15))) >> 15 } else { 0 };
        let up = (up * up) >> 13;
        self.rise.at(part(height, RELEASE_US)).wrapping_add(((i64::from(self.lift) * i64::from(up)) >> 13) as i32)
    }

    /// How far the foot is from where the clip has it, in the world.
    fn left(&self) -> [i32; 3] {
        let [since, _] = self.since_us;
        let [a, b] = self.flat.map(|own| own.at(part(since, self.step_us)));
        [a, b, self.left_height()]
    }

    /// Where the end of the limb is to be, after an update by `elapsed_us`; `None` if it stays where the clip has it. `contact` is the point
    /// that is on the ground in the clip, and `calm` says that no transition runs.
    pub(super) fn update(
        &mut self,
        pose: &[i32],
        frame: &Frame,
        contact: Option<u8>,
        calm: bool,
        elapsed_us: u32,
    ) -> Option<Wanted> {
        let whole = [self.step_us, RELEASE_US];
        for (since, whole) in self.since_us.iter_mut().zip(whole) {
            *since = since.saturating_add(elapsed_us).min(whole);
        }
        if contact.is_none() && self.state == State::Free {
            self.before = None;
            if calm && self.limb.never_bent() {
                self.limb.learn(&self.limb.places(pose));
            }
            return None;
        }
        let places = self.limb.places(pose);
        let world = |point: u8| frame.to_world(self.point(pose, &places, point));
        match (self.state, contact) {
            (State::Locked(own), Some(point)) if own != point => {
                self.anchor = sum(self.anchor, difference(world(point), world(own)));
                (self.state, self.lowest) = (State::Locked(point), i64::MAX);
            }
            (State::Locked(_), Some(_)) => {}
            (State::Locked(_), None) => self.release(self.flat.map(|own| i64::from(own.d).abs()).into_iter().fold(0, i64::max)),
            (_, Some(point)) => {
                let at = sum(world(point), self.left().map(i64::from));
                if self.lands(point, at, calm, elapsed_us) {
                    self.rest();
                    (self.state, self.anchor, self.level, self.lowest) = (State::Locked(point), at, false, i64::MAX);
                }
            }
            (_, None) => {}
        }
        if let State::Locked(point) = self.state {
            let at = frame.to_world(self.point(pose, &places, point));
            self.keep(difference(self.anchor, at), calm, elapsed_us);
            let [.., height] = at;
            let height = if self.upside_down { height.wrapping_neg() } else { height };
            self.lowest = self.lowest.min(height);
            // The other clip of a blend lifts it.
            if self.held().is_some() && height.wrapping_sub(self.lowest) > i64::from(self.limb.length() / 12) {
                self.release(0);
                self.steps = true;
            }
        } else if self.since_us == whole {
            (self.state, self.lift) = (State::Free, 0);
        }
        let left = self.left();
        self.before = contact;
        if let Some(point) = contact {
            self.at = sum(frame.to_world(self.point(pose, &places, point)), left.map(i64::from));
        }
        let shift = self.limb.shift();
        let way = frame.to_pose(left).map(|x| shifted(x, shift));
        let [.., ankle] = &places;
        let target = pantin_math::vector::add(ankle.place, way);
        if calm {
            self.limb.learn(&places);
        }
        if way != [0; 3] && self.held().is_some() && self.limb.overreaches(&places, target) {
            self.rest();
            self.let_go();
        }
        (way != [0; 3]).then(|| Wanted { places, target, free: self.limb.free(&places, target) })
    }

    /// Whether a foot that is not held is to be held from now on.
    fn lands(&self, point: u8, at: [i64; 3], calm: bool, elapsed_us: u32) -> bool {
        let [since, _] = self.since_us;
        // Half of the leg in a second.
        let slow = (i64::from(self.limb.length()) * i64::from(elapsed_us)) / 2_000_000;
        let rests = self.before == Some(point) && difference(at, self.at).iter().all(|way| way.abs() <= slow);
        match self.before {
            None => calm,
            Some(_) if self.steps => calm && since >= self.step_us && rests,
            Some(_) => calm || rests,
        }
    }

    /// Keeps a held foot at its anchor, which is this far from where the clip has it.
    fn keep(&mut self, [a, b, height]: [i64; 3], calm: bool, elapsed_us: u32) {
        let narrow = |x: i64| x.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32;
        let [flat_since, height_since] = &mut self.since_us;
        *flat_since = 0;
        for (own, d) in self.flat.iter_mut().zip([a, b]) {
            own.hold(narrow(d), elapsed_us, RELEASE_US);
        }
        if self.level {
            self.rise.hold(narrow(height), elapsed_us, RELEASE_US);
            *height_since = 0;
            self.level = !calm;
        }
        let most = i64::from(self.limb.length() / 4);
        if a.abs() > most || b.abs() > most {
            self.let_go();
        }
    }

    /// Lets go of a foot that cannot be where it was held any longer: it steps back to its clip.
    fn let_go(&mut self) {
        self.release(i64::from(self.limb.length() / 4));
        self.steps = true;
    }
}

pub(super) fn sum([a, b, c]: [i64; 3], [x, y, z]: [i64; 3]) -> [i64; 3] {
    [a.wrapping_add(x), b.wrapping_add(y), c.wrapping_add(z)]
}

pub(super) fn difference([a, b, c]: [i64; 3], [x, y, z]: [i64; 3]) -> [i64; 3] {
    [a.wrapping_sub(x), b.wrapping_sub(y), c.wrapping_sub(z)]
}
