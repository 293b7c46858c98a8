//! Poses of two characters that meet: each knows where the other one is.

use super::steered::SteeredSource;
use super::{Source, Status};
use crate::board::Exit;
use core::cell::Cell;
use pantin::{Clip, Player, Pose};
use pantin_animator::{Character, Error, Limb, Limits, Look, Placement, Share};
use pantin_figure::Stand;

/// The time in which a gaze turns to its target and a hand goes to it.
const TURN_US: u32 = 400_000;
/// The whole of a way, in 2^-15.
const WHOLE: u32 = 1 << 15;
/// So far apart, in cm, the other one waves, and so far they look at each other.
const NEAR_CM: u32 = 160;
const SEEN_CM: u32 = 400;
/// How far ahead of the figure a gaze without a target goes, in cm.
const AHEAD_CM: u32 = 200;
/// How high above the shoulder's joint, and how far before it, the wrist of a hand is that lies on it, in cm.
const ABOVE_CM: u32 = 7;
const BEFORE_CM: u32 = 12;
/// How often a hand goes to its target in a picture, until it is within a centimetre.
const REACHES: u32 = 3;

/// A point of the world: the two horizontal axes of a placement, and the height.
type Point = [i64; 3];

/// What one character sees of another.
#[derive(Clone, Copy)]
pub(crate) struct Sight {
    head: Point,
    shoulder: Point,
    placement: Placement,
    bows: bool,
}

/// What each of two characters shows the other.
#[derive(Default)]
pub(crate) struct Meeting {
    seen: [Cell<Option<Sight>>; 2],
}

/// Which of the two a character is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// The one that is steered: it lays a hand on the other's shoulder.
    Steered,
    /// The one that stands there: it turns to the first, waves and bows back.
    Other,
}

/// A character that meets another one.
pub(crate) struct PairedSource<'s, 'k, 'c, 'm> {
    own: SteeredSource<'k, 'c, 'm>,
    role: Role,
    meeting: &'s Meeting,
    look: Look<'c>,
    hand: Limb<'c>,
    /// How far the gaze and the hand have come to their targets, in 2^-15.
    gaze: u32,
    touch: u32,
    /// Whether the other one was near, and bowed, at the last picture.
    near: bool,
    bowed: bool,
    axes: Axes,
}

/// Axes and lengths of the poses.
#[derive(Clone, Copy)]
struct Axes {
    up: usize,
    /// Whether up is against the axis.
    negative: bool,
    /// A centimetre in raw units, in 2^-8.
    cm: i64,
}

impl Axes {
    fn of(clip: &Clip) -> Axes {
        let shift = i32::from(clip.length_exponent());
        let unit = (1_000_000u64 << 24).checked_div(clip.rig().unit_micro_cm().into()).unwrap_or(0);
        let scaled = if shift >= 0 { unit >> shift.min(63) } else { unit.saturating_mul(1 << shift.unsigned_abs().min(40)) };
        // Below 2^39 raw units: more than a channel holds.
        let cm = scaled.min(1 << 47) as i64;
        Axes { up: clip.rig().up().axis() % 3, negative: clip.rig().up().is_negative(), cm: cm >> 16 }
    }

    /// A length in raw units.
    fn raw(self, cm: u32) -> i64 {
        (self.cm * i64::from(cm)) >> 8
    }

    /// The horizontal coordinates of a point of a pose, and its height.
    fn split(self, point: [i32; 3]) -> ([i32; 2], i32) {
        let at = |axis: usize| point.get(axis % 3).copied().unwrap_or(0);
        ([at(self.up + 1), at(self.up + 2)], at(self.up))
    }

    fn join(self, [a, b]: [i32; 2], height: i32) -> [i32; 3] {
        let mut point = [0; 3];
        for (axis, x) in [(self.up, height), (self.up + 1, a), (self.up + 2, b)] {
            if let Some(own) = point.get_mut(axis % 3) {
                *own = x;
            }
        }
        point
    }

    fn to_world(self, placement: Placement, point: [i32; 3]) -> Point {
        let (flat, height) = self.split(point);
        let [a, b] = placement.to_world(flat);
        [a, b, height.into()]
    }

    fn to_pose(self, placement: Placement, [a, b, height]: Point) -> [i32; 3] {
        let narrow = |x: i64| x.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32;
        self.join(placement.to_pose([a, b]), narrow(height))
    }
}

/// What is to happen between the two, as one of them sees it.
struct Seen {
    /// Where the other's head and shoulder are, in the axes of the pose.
    head: [i32; 3],
    shoulder: [i32; 3],
    /// How far along and aside it stands.
    along: i64,
    aside: i64,
    bows: bool,
}

impl Seen {
    fn is_within(&self, raw: i64) -> bool {
        squares([self.along, self.aside]) < squares([raw])
    }
}

impl<'s, 'k, 'c, 'm> PairedSource<'s, 'k, 'c, 'm> {
    /// Fails if the rig has no joints of a head, an arm and a shoulder by the names of `motions/character.toml`.
    pub fn new(mut own: SteeredSource<'k, 'c, 'm>, role: Role, meeting: &'s Meeting) -> Result<Self, Error> {
        let animator = own.character.animator();
        let (clip, groups) = (*animator.track().clip(), animator.groups());
        let share = |part: u16, degrees: i32| Share { part, most: pantin::Angle::from_bits(degrees * (i32::MAX / 180)) };
        let shares = [share(1 << 14, 60), share(1 << 15, 40)];
        let look = Look::of(&clip, groups, "head", &shares, [0, 0, 1])?;
        let hand = Limb::to(&clip, groups, "right-hand", Limits::default())?;
        let axes = Axes::of(&clip);
        Ok(PairedSource { own, role, meeting, look, hand, gaze: 0, touch: 0, near: false, bowed: false, axes })
    }

    /// Stands a character somewhere else than at the origin.
    pub fn put(character: &mut Character, along_cm: u32) {
        let clip = *character.animator().track().clip();
        let place = [Axes::of(&clip).raw(along_cm), 0];
        character.animator().set_placement(Placement { place, heading: pantin::Angle::from_bits(i32::MIN) });
    }

    fn seen(&self, other: &Sight, placement: Placement) -> Seen {
        let [along, aside] = placement.to_pose(other.placement.place).map(i64::from);
        let to_pose = |point: Point| self.axes.to_pose(placement, point);
        Seen { head: to_pose(other.head), shoulder: to_pose(other.shoulder), along, aside, bows: other.bows }
    }

    fn state_is(&self, name: &str) -> bool {
        self.own.character.table().state_name(self.own.character.state()) == name
    }

    fn fire(&mut self, name: &str) {
        let machine = self.own.character.machine();
        if let Some(input) = machine.table().input(name) {
            machine.fire(input);
        }
    }

    /// What the other one does by itself before an update.
    fn react(&mut self, seen: &Seen) {
        let (near, bows) = (seen.is_within(self.axes.raw(NEAR_CM)), seen.bows);
        if self.role == Role::Other && self.state_is("idle") {
            let turned = if seen.aside > 0 { "left" } else { "right" };
            if seen.aside.abs() > seen.along {
                self.fire(turned);
            } else if bows && !self.bowed {
                self.fire("bow");
            } else if near != self.near {
                self.fire("wave");
            }
        }
        (self.near, self.bowed) = (near, bows);
    }

    /// Turns the head, and lays the hand on the shoulder.
    fn correct(&mut self, seen: &Seen, elapsed_us: u32) {
        let (axes, calm) = (self.axes, self.state_is("idle") || self.state_is("walk") || self.state_is("wave"));
        let sees = seen.along > seen.aside.abs() / 2 && seen.is_within(axes.raw(SEEN_CM)) && calm;
        let [shoulder, hand] = [self.hand.start(self.own.pose().values), self.hand.end(self.own.pose().values)];
        let lift = if axes.negative { -axes.raw(ABOVE_CM) } else { axes.raw(ABOVE_CM) } as i32;
        let ([along, aside], height) = axes.split(seen.shoulder);
        let target = axes.join([along.wrapping_sub(axes.raw(BEFORE_CM) as i32), aside], height.wrapping_add(lift));
        let way = shoulder.iter().zip(target).map(|(from, to)| i64::from(to) - i64::from(*from));
        // Not quite stretched.
        let reaches = squares(way) < squares([i64::from(self.hand.length()) * 31 / 32]);
        let touches = self.role == Role::Steered && self.state_is("idle") && reaches;
        self.gaze = turned(self.gaze, sees, elapsed_us);
        self.touch = turned(self.touch, touches, elapsed_us);
        let eye = self.look.eye(self.own.pose().values);
        let (flat, height) = axes.split(eye);
        let [a, b] = flat;
        let ahead = axes.join([a.wrapping_add(axes.raw(AHEAD_CM) as i32), b], height);
        let pose = self.own.character.animator().pose_mut();
        if self.gaze > 0 {
            self.look.at(pose, between(ahead, seen.head, self.gaze));
        }
        if self.touch > 0 {
            let (target, near) = (between(hand, target, self.touch), axes.raw(1) as u32);
            // An elbow that is a hinge comes nearer each time.
            for _ in 0..REACHES {
                if self.hand.reach(pose, target, None).error < near {
                    break;
                }
            }
        }
    }

    /// Shows the other one where this one is.
    fn show(&self) {
        let (pose, placement) = self.own.character.pose();
        let point = |point: [i32; 3]| self.axes.to_world(placement, point);
        let [head, shoulder] = [self.look.eye(pose.values), self.hand.start(pose.values)].map(point);
        // The shoulder across from the hand that is laid on it.
        let shoulder = mirrored(placement, shoulder);
        let sight = Sight { head, shoulder, placement, bows: self.state_is("bow") };
        if let Some(own) = self.meeting.seen.get(self.role as usize) {
            own.set(Some(sight));
        }
    }
}

/// A point's mirror image at the plane in which a figure stands.
fn mirrored(placement: Placement, [a, b, height]: Point) -> Point {
    let [along, aside] = placement.to_pose([a, b]);
    let [a, b] = placement.to_world([along, aside.wrapping_neg()]);
    [a, b, height]
}

/// The sum of squares, cut off at the greatest number.
fn squares(lengths: impl IntoIterator<Item = i64>) -> u64 {
    let square = |x: i64| x.unsigned_abs().saturating_mul(x.unsigned_abs());
    lengths.into_iter().map(square).fold(0, u64::saturating_add)
}

/// A way on which something is, or is not, to be.
fn turned(way: u32, there: bool, elapsed_us: u32) -> u32 {
    let step = ((u64::from(elapsed_us) << 15) / u64::from(TURN_US)).min(WHOLE.into()) as u32;
    if there { (way + step).min(WHOLE) } else { way.saturating_sub(step) }
}

/// A point between two, with an eased beginning and end.
fn between(from: [i32; 3], to: [i32; 3], way: u32) -> [i32; 3] {
    let way = u64::from(way);
    // 3 w^2 - 2 w^3.
    let eased = ((((way * way) >> 15) * (3 * u64::from(WHOLE) - 2 * way)) >> 15) as i64;
    let mut between = from;
    for (own, to) in between.iter_mut().zip(to) {
        let far = i64::from(to) - i64::from(*own);
        *own = (i64::from(*own) + ((far * eased) >> 15)) as i32;
    }
    between
}

impl Source for PairedSource<'_, '_, '_, '_> {
    const LIVE: bool = false;
    const COMMANDS: bool = false;
    const ONE_WORLD: bool = true;

    fn hold(&mut self, buttons: u16) {
        if self.role == Role::Steered {
            self.own.hold(buttons);
        }
    }

    fn advance(&mut self, frames: i32) {
        let other = self.meeting.seen.get(1 - self.role as usize).and_then(Cell::get);
        if let Some(other) = other {
            let (_, placement) = self.own.character.pose();
            self.react(&self.seen(&other, placement));
        }
        let elapsed_us = self.own.go_on(frames);
        if let Some(other) = other {
            let (_, placement) = self.own.character.pose();
            self.correct(&self.seen(&other, placement), elapsed_us);
        }
        self.show();
    }

    fn ended(&self) -> Option<Exit> {
        self.own.ended()
    }

    fn pose(&self) -> Pose<'_> {
        self.own.pose()
    }

    fn stand(&self) -> Option<Stand> {
        self.own.stand()
    }

    fn frame(&self) -> u32 {
        self.own.frame()
    }

    fn frame_time_ns(&self) -> u32 {
        self.own.frame_time_ns()
    }

    fn status(&self) -> Status {
        self.own.status()
    }

    fn with_player(&mut self, _then: impl FnOnce(&mut Player)) {}

    #[cfg(feature = "events")]
    fn hear(&mut self, _since: crate::events::Since, _frames: i32, _heard: &mut dyn FnMut(crate::HeardEvent)) {}

    fn receive(&mut self, byte: u8) -> Option<u8> {
        self.own.receive(byte)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::CHARACTER_KEYS;
    use crate::options::Mode;
    use crate::steer::Body;

    const BANK: &[u8] = include_bytes!("../../../../motions/character.ptb");

    /// Where the wrist is, and where it is to be, when the hand lies on the shoulder.
    fn touch(source: &PairedSource, other: &PairedSource) -> [Point; 2] {
        let (pose, placement) = source.own.character.pose();
        let axes = source.axes;
        let wrist = axes.to_world(placement, source.hand.end(pose.values));
        let [a, b, height] = other.meeting.seen[1].get().unwrap().shoulder;
        [wrist, [a - axes.raw(BEFORE_CM), b, height + axes.raw(ABOVE_CM)]]
    }

    #[test]
    fn the_other_one_bows_and_waves_and_a_hand_comes_to_its_shoulder() {
        let mut bodies = [Body::<64>::new(), Body::new()];
        let [first, second] = &mut bodies;
        let (Ok(steered), Ok(mut other)) = (first.character(BANK, true), second.character(BANK, true)) else {
            panic!("the character")
        };
        PairedSource::put(&mut other, 245);
        let meeting = Meeting::default();
        let source =
            |character, keys, role| PairedSource::new(SteeredSource::new(character, keys, 0, Mode::Sync, 0), role, &meeting);
        let mut steered = source(steered, &CHARACTER_KEYS, Role::Steered).unwrap();
        let mut other = source(other, &[], Role::Other).unwrap();
        let (mut states, mut touched) = (vec![], 0);
        for picture in 0..270 {
            match picture {
                15 => drop(steered.receive(b'b')),
                105 | 138 => drop(steered.receive(b'w')),
                _ => {}
            }
            steered.advance(1);
            other.advance(1);
            let state = |source: &PairedSource| source.own.character.table().state_name(source.own.character.state()).to_string();
            if states.last() != Some(&state(&other)) {
                states.push(state(&other));
            }
            if steered.touch == WHOLE {
                let [wrist, wanted] = touch(&steered, &other);
                let far = wrist.iter().zip(wanted).map(|(a, b)| (a - b).abs()).max().unwrap();
                assert!(far < steered.axes.raw(2), "{picture}: {wrist:?}, expected {wanted:?}");
                touched += 1;
            }
        }
        assert_eq!(states, ["idle", "bow", "idle", "wave", "idle"]);
        assert!(touched > 50 && steered.gaze == WHOLE && other.gaze == WHOLE, "{touched}");
    }
}
