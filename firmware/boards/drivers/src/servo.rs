//! Servos: the angle of a joint becomes the width of a pulse, within the servo's limits and no faster than the servo may turn.

use pantin::{Angle, Axis, Clip, EulerOrder, JointRef, Player};

/// What a servo can do, and how an angle moves it. Widths are in microseconds, of a pulse that is repeated every 20 ms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Law {
    /// The pulse width for the angle 0.
    pub centre: u16,
    /// The change of the width for a whole turn, negative for a servo that turns the other way. Usual servos turn by 90 degrees in 1000 µs.
    pub turn: i32,
    /// The least and the greatest width. Beyond them the puppet, or the servo's own stop, is in the way.
    pub limits: [u16; 2],
    /// The greatest change from one call of [`Servo::follow`] to the next; [`slew`] computes it.
    pub slew: u16,
}

/// Converts a speed in microseconds a second to the change from one call to the next, `nanoseconds` later: at least 1.
pub const fn slew(per_second: u32, nanoseconds: u32) -> u16 {
    // The product is less than 2^64.
    match per_second as u64 * nanoseconds as u64 / 1_000_000_000 {
        0 => 1,
        many if many > u16::MAX as u64 => u16::MAX,
        some => some as u16,
    }
}

/// A servo and its pulse width now.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    law: Law,
    pulse: u16,
}

impl Servo {
    /// Makes a servo at its centre. If the limits are in the wrong order, it stays at the first one.
    pub fn new(law: Law) -> Self {
        Servo { law, pulse: within(law.limits, i32::from(law.centre)) }
    }

    /// Returns the pulse width.
    pub fn pulse(&self) -> u16 {
        self.pulse
    }

    /// Turns towards an angle, as far as the law allows in one call, and returns the pulse width.
    pub fn follow(&mut self, angle: Angle) -> u16 {
        // A product of 32 and 32 bits fits in 64. Rounded to the nearest.
        let change = (i64::from(self.law.turn) * i64::from(angle.to_bits()) + (1 << 31)) >> 32;
        let wanted = within(self.law.limits, i32::from(self.law.centre).saturating_add(change as i32));
        let slew = self.law.slew;
        self.pulse = wanted.max(self.pulse.saturating_sub(slew)).min(self.pulse.saturating_add(slew));
        self.pulse
    }
}

fn within([least, most]: [u16; 2], width: i32) -> u16 {
    width.min(most.into()).max(least.into()) as u16
}

/// The start of several servos. Nobody knows where they stand at power-on, and each turns to its first pulse as fast as it can: they get it one
/// after the other, at the angle 0, so that only one draws its greatest current. Then they turn gradually to the first frame's angles.
#[derive(Clone, Copy, Debug)]
pub struct SoftStart {
    servos: u32,
    elapsed_us: u32,
}

impl SoftStart {
    /// The time between the first pulses of two servos.
    pub const STAGGER_US: u32 = 250_000;
    /// The time in which the servos turn from the angle 0 to the first frame's, after the last one's stagger.
    pub const EASE_US: u32 = 2_000_000;

    /// Begins the start of a number of servos, at most 1000.
    pub const fn new(servos: u32) -> Self {
        SoftStart { servos, elapsed_us: 0 }
    }

    /// Lets time pass. Returns whether the start is over.
    pub fn advance(&mut self, microseconds: u32) -> bool {
        let all = self.servos.saturating_mul(Self::STAGGER_US).saturating_add(Self::EASE_US);
        self.elapsed_us = self.elapsed_us.saturating_add(microseconds).min(all);
        self.elapsed_us == all
    }

    /// Returns whether the servo of a number, counted from 0, gets pulses.
    pub fn is_on(&self, servo: u32) -> bool {
        self.elapsed_us >= servo.saturating_mul(Self::STAGGER_US)
    }

    /// Returns the part of an angle that is due now: nothing, then gradually all of it.
    pub fn ease(&self, angle: Angle) -> Angle {
        let eased = self.elapsed_us.saturating_sub(self.servos.saturating_mul(Self::STAGGER_US)).min(Self::EASE_US);
        // A product of 32 and 21 bits fits in 64; the quotient is no greater than the angle.
        Angle::from_bits((i64::from(angle.to_bits()) * i64::from(eased) / i64::from(Self::EASE_US)) as i32)
    }
}

/// A joint's Euler angle about one axis, which moves a servo: `pantin convert --max-channel-error 1` keeps it within 1 degree of the source's.
#[derive(Clone, Copy, Debug)]
pub struct JointAngle<'a> {
    joint: JointRef<'a>,
    order: EulerOrder,
    /// The axis's index in the order.
    index: usize,
}

impl<'a> JointAngle<'a> {
    /// Finds a joint of a clip by its name. Returns `None` if the clip has no such joint.
    pub fn find(clip: &Clip<'a>, joint: &str, axis: Axis) -> Option<Self> {
        let joint = clip.find(joint)?;
        let order = joint.euler_order().unwrap_or(EulerOrder::XYZ);
        let index = order.axes().into_iter().position(|own| own == axis)?;
        Some(JointAngle { joint, order, index })
    }

    /// Returns the angle at the player's frame, in the joint's own order of axes, whether the clip codes the joint in Euler angles, as an
    /// exponential map or as a quaternion. A joint without rotation, or of another rig than the player's, has the angle 0.
    pub fn at(&self, player: &Player) -> Angle {
        let turn = player.turn(&self.joint).ok();
        turn.and_then(|turn| turn.euler(self.order).get(self.index).copied()).unwrap_or(Angle::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pantin::ChannelState;

    const LAW: Law = Law { centre: 1500, turn: 4000, limits: [1000, 1900], slew: 20 };
    const DEGREE: i32 = (1u32 << 31).div_ceil(180) as i32;

    fn follow(servo: &mut Servo, angle: i32) -> u16 {
        servo.follow(Angle::from_bits(angle))
    }

    /// The width at which the servo stops for an angle, and the number of calls until then.
    fn rests(servo: &mut Servo, angle: i32) -> (u16, usize) {
        for call in 0.. {
            let before = servo.pulse();
            if follow(servo, angle) == before {
                return (before, call);
            }
        }
        unreachable!()
    }

    #[test]
    fn an_angle_is_a_width_about_the_centre() {
        let mut servo = Servo::new(LAW);
        assert_eq!(servo.pulse(), 1500);
        assert_eq!(rests(&mut servo, 0), (1500, 0));
        // A quarter of the 90 degrees for which 1000 µs stand, in steps of 20; the last step is shorter.
        assert_eq!(rests(&mut servo, DEGREE * 45 / 2), (1750, 13));
        assert_eq!(rests(&mut servo, -DEGREE * 9), (1400, 18));
        let mut other = Servo::new(Law { turn: -4000, ..LAW });
        assert_eq!(rests(&mut other, -DEGREE * 9), (1600, 5));
    }

    #[test]
    fn limits_and_slew_hold_for_any_angles() {
        let mut random = 1u32;
        for law in
            [LAW, Law { turn: i32::MIN, slew: 7, ..LAW }, Law { limits: [0, u16::MAX], turn: i32::MAX, slew: u16::MAX, ..LAW }]
        {
            let mut servo = Servo::new(law);
            for _ in 0..10_000 {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let before = servo.pulse();
                let now = follow(&mut servo, random as i32);
                assert!(
                    (law.limits[0]..=law.limits[1]).contains(&now) && now.abs_diff(before) <= law.slew,
                    "{law:?}: {before} to {now}"
                );
            }
        }
    }

    #[test]
    fn past_a_limit_it_stops_there_and_comes_back_at_once() {
        let mut servo = Servo::new(LAW);
        assert_eq!(rests(&mut servo, DEGREE * 170), (1900, 20));
        assert_eq!(follow(&mut servo, 0), 1880);
        // Half a turn is minus half a turn: the servo turns the long way, at its own speed.
        assert_eq!(rests(&mut servo, i32::MIN), (1000, 44));
        let mut wrong = Servo::new(Law { limits: [1600, 1400], ..LAW });
        assert_eq!((wrong.pulse(), follow(&mut wrong, i32::MAX), follow(&mut wrong, i32::MIN)), (1600, 1600, 1600));
    }

    #[test]
    fn a_speed_is_the_same_at_any_rate() {
        assert_eq!([slew(2400, 8_333_333), slew(2400, 33_333_333), slew(2400, 1_000_000_000)], [19, 79, 2400]);
        assert_eq!([slew(0, 0), slew(u32::MAX, u32::MAX)], [1, u16::MAX]);
    }

    #[test]
    fn servos_start_one_after_the_other_and_then_turn_gradually() {
        let (mut start, angle) = (SoftStart::new(4), Angle::from_bits(-90 * DEGREE));
        let mut first = [None; 4];
        let (mut last, mut over) = (0, None);
        for ms in 0..4000 {
            for (servo, first) in (0..).zip(&mut first) {
                if start.is_on(servo) {
                    first.get_or_insert(ms);
                }
            }
            let eased = start.ease(angle).to_bits();
            assert!(ms > 1000 || eased == 0);
            assert!((0..=DEGREE / 20).contains(&(last - eased)), "at most 50 degrees a second");
            last = eased;
            if start.advance(1000) {
                over.get_or_insert(ms + 1);
            }
        }
        assert_eq!(first, [Some(0), Some(250), Some(500), Some(750)]);
        assert_eq!((over, last), (Some(3000), angle.to_bits()));
    }

    fn play(bytes: &[u8], mut each: impl FnMut(&Clip, &Player)) {
        let clip = Clip::new_checked(bytes).unwrap();
        let (mut states, mut pose) = (vec![ChannelState::NEW; clip.moving()], vec![0; clip.rig().channels()]);
        let mut player = Player::new(clip, &mut states, &mut pose).unwrap();
        for _ in 0..clip.frames() {
            each(&clip, &player);
            player.step();
        }
    }

    /// Euler angles about z, y and x of an exponential map, in radians and double precision.
    fn euler_zyx(map: [f64; 3]) -> [f64; 3] {
        let angle = map.iter().map(|part| part * part).sum::<f64>().sqrt().max(1e-12);
        let [x, y, z] = map.map(|part| part / angle);
        let (sin, cos) = angle.sin_cos();
        let rest = 1.0 - cos;
        let below_zx = x * z * rest - y * sin;
        let (zz_row1, zz_row0) = (x * y * rest + z * sin, cos + x * x * rest);
        let (xx_row2, xx_col2) = (y * z * rest + x * sin, cos + z * z * rest);
        [zz_row1.atan2(zz_row0), (-below_zx).asin(), xx_row2.atan2(xx_col2)]
    }

    #[test]
    fn a_joint_coded_as_an_exponential_map_moves_its_servo() {
        let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
        play(include_bytes!("../../../../motions/kneebend.ptn"), |clip, player| {
            let joint = clip.find("left-shin").unwrap();
            assert!(clip.is_exponential(joint.index()));
            let radians = std::array::from_fn(|axis| {
                let raw = player.pose().values[joint.first_channel() + axis];
                f64::from(raw) * std::f64::consts::TAU / 2f64.powi(32)
            });
            for (axis, expected) in [Axis::Z, Axis::Y, Axis::X].into_iter().zip(euler_zyx(radians)) {
                let angle = JointAngle::find(clip, "left-shin", axis).unwrap().at(player);
                let degrees = f64::from(angle.to_bits()) * 360.0 / 2f64.powi(32);
                assert!((degrees - expected.to_degrees()).abs() < 0.02, "{axis:?} at frame {}: {degrees}", player.frame());
                if axis == Axis::X {
                    seen = [seen[0].min(degrees), seen[1].max(degrees)];
                }
            }
        });
        assert!(seen[1] - seen[0] > 50.0, "the knee bends: {seen:?}");
    }

    #[test]
    fn a_joint_coded_in_euler_angles_has_those_of_the_pose() {
        let mut moves = false;
        play(include_bytes!("../../../../motions/walk.ptn"), |clip, player| {
            let channel = clip.find("neck").unwrap().first_channel();
            for (index, axis) in [Axis::Y, Axis::X].into_iter().enumerate() {
                let raw = player.pose().values[channel + index];
                assert_eq!(JointAngle::find(clip, "neck", axis).unwrap().at(player), Angle::from_bits(raw));
                moves |= raw != 0;
            }
        });
        assert!(moves);
    }

    #[test]
    fn a_joint_that_the_clip_lacks_is_not_found() {
        let clip = Clip::new_checked(include_bytes!("../../../../motions/walk.ptn")).unwrap();
        assert!(JointAngle::find(&clip, "tail", Axis::X).is_none());
    }
}
