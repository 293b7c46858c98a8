//! Root motion: where the figure is in the world and which way it faces, in exact integers.
//!
//! A place is a function of the clip's frame, of the number of laps and of where the clip was started, so that an increment is the
//! difference of two places: sums over loops, reverse and seeks are exact by construction.

use crate::Error;
use crate::groups::{Group, Shape};
use crate::machine::ClipWalk;
use crate::math::{self, NO_ROTATION, Unit};
use fixed::types::I48F16;
use pantin::{
    Angle, Bank, ChannelState, Clip, Component, DetachedPlayer, EulerOrder, JointRef, Kind, Matrix, Player, Pose, Rig, Turn,
};

/// Where a figure is in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Placement {
    /// The horizontal axes that follow the vertical one in the cycle x, y, z (for y up: z, x), in 2^[`pantin::Form::length_exponent`] units of
    /// the source.
    pub place: [i64; 2],
    /// How far the figure is turned about the vertical axis (about the axis itself, also where up is against it), beyond what its pose says.
    pub heading: Angle,
}

/// Where a figure is on the ground, seen from above: [`Placement::on_ground`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GroundPose {
    /// The place in centimetres, on axes of which the second lies a quarter turn counterclockwise of the first.
    pub place_cm: [I48F16; 2],
    /// How far the figure is turned, counterclockwise.
    pub heading: Angle,
}

impl Placement {
    /// The place in centimetres, in steps of 2^-16 cm and rounded down, exact up to 1,000 km; the axes are those of [`Placement::place`]. `clip` is one whose placements these
    /// are, such as that of [`crate::Animator::track`].
    pub fn place_cm(&self, clip: &Clip<'_>) -> [I48F16; 2] {
        let (unit_micro_cm, shift) = (i64::from(clip.rig().unit_micro_cm()), i32::from(clip.length_exponent()) + 16);
        self.place.map(|raw| {
            let fine = if shift > 0 { raw.wrapping_shl(shift as u32) } else { raw };
            let (whole, part) = (fine.div_euclid(1_000_000), fine.rem_euclid(1_000_000));
            let fine = whole.wrapping_mul(unit_micro_cm).wrapping_add((part * unit_micro_cm).div_euclid(1_000_000));
            I48F16::from_bits(if shift < 0 { fine >> shift.unsigned_abs().min(63) } else { fine })
        })
    }

    /// The figure on the ground, in centimetres and seen from above: for a map, or a robot's odometry.
    pub fn on_ground(&self, clip: &Clip<'_>) -> GroundPose {
        let [a, b] = self.place_cm(clip);
        if clip.rig().up().is_negative() {
            // The axes are seen from below.
            return GroundPose { place_cm: [a, -b], heading: -self.heading };
        }
        GroundPose { place_cm: [a, b], heading: self.heading }
    }

    /// A point of the pose, as a horizontal vector in the order of [`Placement::place`], in the world.
    pub fn to_world(&self, point: [i32; 2]) -> [i64; 2] {
        let [a, b] = Heading::new(self.heading).rotate(point);
        let [x, y] = self.place;
        [x.wrapping_add(a), y.wrapping_add(b)]
    }

    /// The difference to another placement.
    pub(crate) fn since(&self, before: &Placement) -> Placement {
        let ([x, y], [before_x, before_y]) = (self.place, before.place);
        Placement { place: [x.wrapping_sub(before_x), y.wrapping_sub(before_y)], heading: self.heading - before.heading }
    }

    /// The reverse of [`Placement::to_world`], within a raw unit; cut off at the range of a channel.
    pub fn to_pose(&self, point: [i64; 2]) -> [i32; 2] {
        let ([x, y], [own_x, own_y]) = (point, self.place);
        let narrow = |x: i64| x.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32;
        Heading::new(-self.heading).rotate([narrow(x.wrapping_sub(own_x)), narrow(y.wrapping_sub(own_y))]).map(narrow)
    }
}

/// An angle with its sine and cosine, which are worked out when it changes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heading {
    pub(crate) angle: Angle,
    sin: i32,
    cos: i32,
}

impl Heading {
    pub(crate) const ZERO: Heading = Heading { angle: Angle::ZERO, sin: 0, cos: 1 << 30 };

    pub(crate) fn new(angle: Angle) -> Heading {
        if angle == Angle::ZERO {
            return Heading::ZERO;
        }
        let (sin, cos) = angle.sin_cos();
        Heading { angle, sin: sin.to_bits(), cos: cos.to_bits() }
    }

    #[inline(never)]
    pub(crate) fn rotate(&self, [a, b]: [i32; 2]) -> [i64; 2] {
        if self.angle == Angle::ZERO {
            return [a.into(), b.into()];
        }
        self.products([a, b]).map(|q30| (q30 + (1 << 29)) >> 30)
    }

    /// The rotated vector in Q30.
    #[inline(always)]
    fn products(&self, [a, b]: [i32; 2]) -> [i64; 2] {
        let times = |x: i32, y: i32| i64::from(x) * i64::from(y);
        [times(a, self.cos) - times(b, self.sin), times(a, self.sin) + times(b, self.cos)]
    }

    /// The angle the other way.
    pub(crate) fn reverse(self) -> Heading {
        Heading { angle: -self.angle, sin: -self.sin, cos: self.cos }
    }

    /// The same of a way below 2^61, beyond the range of a channel: in parts of 2^30, whose products are whole.
    fn rotate_wide(&self, [a, b]: [i64; 2]) -> [i64; 2] {
        if self.angle == Angle::ZERO {
            return [a, b];
        }
        // As far as most go, one part is all.
        if let (Ok(a), Ok(b)) = (i32::try_from(a), i32::try_from(b)) {
            return self.rotate([a, b]);
        }
        let low = |x: i64| (x & ((1 << 30) - 1)) as i32;
        let high = |x: i64| (x >> 30) as i32;
        let ([low_x, low_y], [x, y]) = (self.rotate([low(a), low(b)]), self.products([high(a), high(b)]));
        [low_x.wrapping_add(x), low_y.wrapping_add(y)]
    }
}

/// The channels that place a figure: those of its carrier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Root<'a> {
    joint: JointRef<'a>,
    /// Channels of the two horizontal axes.
    pub(crate) place: [Option<u16>; 2],
    /// The order whose first axis is the vertical one.
    order: EulerOrder,
    /// The vertical axis.
    axis: pantin::Axis,
    /// How the joint is turned, and by which channels.
    pub(crate) turns: Group,
}

/// The carrier of a figure by its rig alone: the first joint that has positions.
pub(crate) fn first_with_positions(rig: &Rig<'_>) -> usize {
    rig.joints().position(|joint| has_positions(joint.kinds)).unwrap_or(0)
}

fn has_positions(mut kinds: pantin::Kinds<'_>) -> bool {
    kinds.any(|kind| kind.is_position())
}

/// The carrier of a figure that plays several clips: the first joint with positions that moves in one of them. Captures often hang on a joint that
/// stands still at the origin; where one above the carrier is turned, it stays the carrier. `states` and `values` are memory for each of the clips,
/// which are those of these indices; the index and the player of the one that is in it then are returned too.
pub(crate) fn carrier<'a>(
    bank: &Bank<'a>,
    clips: impl Iterator<Item = u8>,
    states: &mut [ChannelState],
    values: &mut [i32],
) -> Result<(usize, Option<(u8, DetachedPlayer<'a>)>), Error> {
    let (mut first, mut carrier, mut upright) = (0, usize::MAX, usize::MAX);
    let (mut found, mut last) = (false, None);
    let mut walk = ClipWalk::new(bank);
    for at in clips {
        let clip = walk.open(at)?;
        let rig = clip.rig();
        // Then a player would neither change the carrier nor lack memory, but for a key clip, which may be refused where it is entered.
        if found && rig.channels() <= states.len().min(values.len()) {
            continue;
        }
        first = first_with_positions(&rig);
        let player = Player::new(clip, states, values)?;
        let moves = |from: usize, to: usize| player.states().iter().any(|state| (from..to).contains(&state.slot()));
        for (index, joint) in rig.joints().enumerate().take(carrier) {
            let from = usize::from(joint.first_channel);
            let to = from + { joint.kinds }.count();
            let channels = joint.kinds.zip(player.pose().values.get(from..to).unwrap_or_default());
            let turned = channels.filter(|(kind, _)| !kind.is_position()).any(|(kind, value)| !kind.is_rotation() || *value != 0);
            if has_positions(joint.kinds) && moves(from, to) {
                carrier = index;
                // No joint before it has channels.
                found = from == 0;
                break;
            }
            if turned {
                upright = upright.min(index);
            }
        }
        last = Some((at, player.detach()));
    }
    Ok((if carrier == usize::MAX || upright < carrier { first } else { carrier }, last))
}

/// The root at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RootSample {
    pub(crate) place: [i32; 2],
    pub(crate) yaw: Angle,
}

impl<'a> Root<'a> {
    /// The root of a rig, whose carrier is the joint of an index; `None` if there is no such joint.
    pub(crate) fn of(rig: &Rig<'a>, groups: &[Group], index: usize) -> Option<Root<'a>> {
        let joint = rig.joint_ref(index)?;
        let channel = |axis: usize| {
            let wanted = |(kind, _): &(Kind, usize)| kind.is_position() && kind.axis() == Some(axis % 3);
            joint.kinds().zip(joint.first_channel()..).find(wanted).map(|(_, channel)| channel as u16)
        };
        let up = rig.up().axis();
        let (order, axis) = match up {
            0 => (EulerOrder::XYZ, pantin::Axis::X),
            1 => (EulerOrder::YXZ, pantin::Axis::Y),
            _ => (EulerOrder::ZXY, pantin::Axis::Z),
        };
        let mut kinds = joint.kinds().zip(joint.first_channel()..).filter(|(kind, _)| !kind.is_position());
        let first = kinds.next().map(|(_, channel)| channel);
        let own = groups.iter().find(|group| usize::from(group.bit) == index && Some(usize::from(group.first)) == first);
        let turns = own.copied().unwrap_or(Group::NONE);
        Some(Root { joint, place: [channel(up + 1), channel(up + 2)], order, axis, turns })
    }

    /// The vertical axis: 0 to 2.
    pub(crate) fn up(&self) -> usize {
        self.axis as usize
    }

    /// Takes the horizontal place out of a pose.
    pub(crate) fn leave_place(&self, values: &mut [i32]) {
        for channel in self.place.iter().flatten() {
            if let Some(value) = values.get_mut(usize::from(*channel)) {
                *value = 0;
            }
        }
    }

    /// Whether its group of channels is all that turns it.
    pub(crate) fn is_whole(&self) -> bool {
        self.turns.shape != Shape::Free
            && self.joint.kinds().filter(|kind| !kind.is_position()).count() == usize::from(self.turns.len)
    }

    /// How a pose turns it.
    pub(crate) fn turn_in(&self, pose: &Pose<'_>) -> Unit {
        pose.turn(&self.joint).map_or(NO_ROTATION, Turn::quaternion)
    }

    /// The yaw of a rotation.
    #[inline(never)]
    pub(crate) fn yaw_of(&self, turned: Unit) -> Angle {
        Matrix::of_quaternion(turned).first_angle(self.order)
    }

    /// The yaw of values of the channels that turn it; `None` if they are fewer than a whole rotation.
    pub(crate) fn yaw_of_turns(&self, own: &[i32]) -> Option<Angle> {
        Some(self.yaw_of(math::turn_of(self.turns.shape, self.joint.kinds(), own)?.quaternion()))
    }

    /// What turns the root about the vertical axis.
    pub(crate) fn yaw_by(&self, angle: Angle) -> Yaw {
        // An arithmetic shift halves the angle of -1/2 to 1/2 turn.
        Yaw { angle, half: Heading::new(Angle::from_bits(angle.to_bits() >> 1)) }
    }

    /// Turns the root about the vertical axis, in its channels `own`; one that has up to two angles keeps them, but for one that turns about
    /// the vertical axis first. `turned` is the rotation that the channels are, if it is known.
    #[inline(never)]
    pub(crate) fn turn_by(&self, yaw: &Yaw, own: &mut [i32], turned: Option<Unit>) {
        if yaw.angle == Angle::ZERO {
            return;
        }
        let turned = turned.or_else(|| math::turn_of(self.turns.shape, self.joint.kinds(), own).map(Turn::quaternion));
        let Some(turned) = turned else {
            let first = self.joint.kinds().find(|kind| !kind.is_position());
            if first.is_some_and(|kind| kind.is_rotation() && kind.axis() == Some(self.axis as usize))
                && let Some(value) = own.first_mut()
            {
                *value = value.wrapping_add(yaw.angle.to_bits());
            }
            return;
        };
        math::write(self.turns.shape, self.joint.kinds(), yaw.turn(turned, self.up()), own);
    }
}

/// A turn about the vertical axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Yaw {
    angle: Angle,
    half: Heading,
}

impl Yaw {
    /// The turn after a rotation. One of the two quaternions has two components alone, so that their product is that of two plane vectors.
    fn turn(&self, [w, x, y, z]: Unit, up: usize) -> Unit {
        let (own, a, b) = match up {
            0 => (x, y, z),
            1 => (y, z, x),
            _ => (z, x, y),
        };
        let rotate =
            |pair: [Component; 2]| self.half.rotate(pair.map(Component::to_bits)).map(|x| Component::from_bits(x as i32));
        let ([w, own], [a, b]) = (rotate([w, own]), rotate([a, b]));
        match up {
            0 => [w, own, a, b],
            1 => [w, b, own, a],
            _ => [w, a, b, own],
        }
    }
}

/// Between the last frame of a loop and its first: where a lap takes the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Seam {
    pub(crate) place: [i64; 2],
    pub(crate) yaw: Angle,
    /// Where the loop begins.
    pub(crate) first: [i32; 2],
}

/// A loop whose root comes back to within this of its start stays in its place.
const RETURNS_CM: i64 = 5;
/// A loop whose root comes back to within this of its first heading keeps it: 5 degrees, in 2^-32 turns.
const RETURNS_TURN: u32 = 59_652_323;

impl Seam {
    pub(crate) fn between(root: &Root<'_>, first: &RootSample, next: &RootSample, clip: &Clip<'_>) -> Seam {
        let ([a, b], [first_a, first_b]) = (next.place.map(i64::from), first.place.map(i64::from));
        let (a, b) = (a - first_a, b - first_b);
        let micro_cm = i64::from(clip.rig().unit_micro_cm());
        // In 2^exponent units: 5 cm.
        let shift = i32::from(clip.length_exponent());
        let units = RETURNS_CM * 1_000_000;
        let bound = if shift >= 0 { units >> shift } else { units.checked_shl(shift.unsigned_abs().min(40)).unwrap_or(units) };
        let bound = bound.checked_div(micro_cm).unwrap_or(0).max(0).unsigned_abs();
        let near = a.unsigned_abs() <= bound && b.unsigned_abs() <= bound;
        let yaw = next.yaw - first.yaw;
        let turns = yaw.to_bits().unsigned_abs() > RETURNS_TURN && root.place.iter().all(Option::is_some);
        Seam {
            place: if near && !turns { [0; 2] } else { [a, b] },
            yaw: if turns { yaw } else { Angle::ZERO },
            first: first.place,
        }
    }
}

/// The way of a root since its clip was started.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Travel {
    /// Where the figure was when the clip was started, and what its heading is beside the pose's.
    pub(crate) anchor: [i64; 2],
    pub(crate) heading: Heading,
    /// The root's place in the clip that stands at the anchor, less where the laps since then lead, in the clip's axes.
    pub(crate) origin: [i64; 2],
    /// These laps, and what they turn by.
    laps: i32,
    lap_heading: Heading,
}

impl Travel {
    pub(crate) const NONE: Travel =
        Travel { anchor: [0; 2], heading: Heading::ZERO, origin: [0; 2], laps: 0, lap_heading: Heading::ZERO };

    /// Starts at a placement with a clip whose root is at `origin`.
    pub(crate) fn new(from: Placement, origin: [i64; 2]) -> Travel {
        Travel { anchor: from.place, heading: Heading::new(from.heading), origin, ..Travel::NONE }
    }

    /// Passes the seam of a loop a number of times. A lap's way is turned by the laps before it, so that the same laps backwards take back
    /// the same numbers.
    pub(crate) fn pass(&mut self, laps: i32, seam: &Seam) {
        for _ in 0..laps.unsigned_abs() {
            if laps < 0 {
                self.laps = self.laps.wrapping_sub(1);
            }
            if seam.yaw != Angle::ZERO {
                self.lap_heading = Heading::new(Angle::from_bits(seam.yaw.to_bits().wrapping_mul(self.laps)));
            }
            let way = self.lap_heading.rotate_wide(seam.place);
            for (origin, way) in self.origin.iter_mut().zip(way) {
                *origin = origin.wrapping_sub(if laps < 0 { -way } else { way });
            }
            if laps > 0 {
                self.laps = self.laps.wrapping_add(1);
                if seam.yaw != Angle::ZERO {
                    self.lap_heading = Heading::new(Angle::from_bits(seam.yaw.to_bits().wrapping_mul(self.laps)));
                }
            }
        }
    }

    /// Lets the figure go a way of the clip's axes beside the clip.
    pub(crate) fn lead(&mut self, way: [i32; 2]) {
        for (origin, way) in self.origin.iter_mut().zip(self.lap_heading.rotate(way)) {
            *origin = origin.wrapping_sub(way);
        }
    }

    /// The placement of a root that is at a place of its clip.
    pub(crate) fn placement(&self, place: [i32; 2], seam: Option<&Seam>) -> Placement {
        let [x, y] = place;
        let mut turned = [i64::from(x), i64::from(y)];
        if let (Some(seam), true) = (seam, self.lap_heading.angle != Angle::ZERO) {
            // About the place where the loop begins, which is where a lap's turn happens.
            let ([x, y], [first_x, first_y]) = (turned, seam.first.map(i64::from));
            let [x, y] = self.lap_heading.rotate_wide([x - first_x, y - first_y]);
            turned = [x.wrapping_add(first_x), y.wrapping_add(first_y)];
        }
        let ([x, y], [origin_x, origin_y]) = (turned, self.origin);
        let [x, y] = self.heading.rotate_wide([x.wrapping_sub(origin_x), y.wrapping_sub(origin_y)]);
        let [anchor_x, anchor_y] = self.anchor;
        Placement {
            place: [anchor_x.wrapping_add(x), anchor_y.wrapping_add(y)],
            heading: self.heading.angle + self.lap_heading.angle,
        }
    }
}
