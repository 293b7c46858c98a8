//! Servos: an angle of a pose becomes the width of a pulse, within the servo's limits and no faster than it may go.

use pantin::{Clip, Kind};

/// What a servo can do, and how a joint moves it. Widths are in microseconds, of a pulse that comes every 20 milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Law {
    /// The width that stands for an angle of 0.
    pub centre: u16,
    /// Change of the width for a whole turn; less than 0 for one that turns the other way. Usual servos go a quarter of a turn in 1000.
    pub turn: i32,
    /// Least and greatest width: past them the puppet, or the servo's own stop, is in the way.
    pub limits: [u16; 2],
    /// Greatest change from one call of [`Servo::follow`] to the next; see [`slew`].
    pub slew: u16,
}

/// A change of so many microseconds a second, for calls that are so many nanoseconds apart: at least 1.
pub const fn slew(per_second: u32, nanoseconds: u32) -> u16 {
    // Less than 2^64.
    match per_second as u64 * nanoseconds as u64 / 1_000_000_000 {
        0 => 1,
        many if many > u16::MAX as u64 => u16::MAX,
        some => some as u16,
    }
}

/// A servo and its pulse now.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    law: Law,
    pulse: u16,
}

impl Servo {
    /// One that stands at its centre. Where the limits are the wrong way round, it stays at the first.
    pub fn new(law: Law) -> Self {
        Servo { law, pulse: within(law.limits, i32::from(law.centre)) }
    }

    /// The width of its pulse.
    pub fn pulse(&self) -> u16 {
        self.pulse
    }

    /// Goes towards an angle, raw as in a pose (2^-32 turns, -1/2 to 1/2), as far as it may, and tells the width of its pulse.
    pub fn follow(&mut self, angle: i32) -> u16 {
        // Of 32 and 32 bits: fits in 64. Rounded to the nearest.
        let change = (i64::from(self.law.turn) * i64::from(angle) + (1 << 31)) >> 32;
        let wanted = within(self.law.limits, i32::from(self.law.centre).saturating_add(change as i32));
        let slew = self.law.slew;
        self.pulse = wanted.max(self.pulse.saturating_sub(slew)).min(self.pulse.saturating_add(slew));
        self.pulse
    }
}

fn within([least, most]: [u16; 2], width: i32) -> u16 {
    width.min(most.into()).max(least.into()) as u16
}

/// The place in a pose of a joint's channel; none where the clip has no such joint or channel, or has its rotation in another form.
pub fn channel(clip: &Clip, joint: &str, kind: Kind) -> Option<usize> {
    let rig = clip.rig();
    let (index, joint) = rig.joints().enumerate().find(|(_, own)| own.name() == joint)?;
    if clip.is_exponential(index) {
        return None;
    }
    let order = joint.kinds.into_iter().position(|own| own == kind)?;
    Some(usize::from(joint.first_channel) + order)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Law = Law { centre: 1500, turn: 4000, limits: [1000, 1900], slew: 20 };
    const DEGREE: i32 = (1u32 << 31).div_ceil(180) as i32;

    /// Where it comes to rest for an angle, and after how many calls.
    fn rests(servo: &mut Servo, angle: i32) -> (u16, usize) {
        for call in 0.. {
            let before = servo.pulse();
            if servo.follow(angle) == before {
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
        // A quarter of the 90 degrees that 1000 stand for, in steps of 20; the last is shorter.
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
                let now = servo.follow(random as i32);
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
        assert_eq!(servo.follow(0), 1880);
        // From just below half a turn to just above minus half a turn: the long way, at its own speed.
        assert_eq!(rests(&mut servo, i32::MIN), (1000, 44));
        let mut wrong = Servo::new(Law { limits: [1600, 1400], ..LAW });
        assert_eq!((wrong.pulse(), wrong.follow(i32::MAX), wrong.follow(i32::MIN)), (1600, 1600, 1600));
    }

    #[test]
    fn a_speed_is_the_same_at_any_rate() {
        assert_eq!([slew(2400, 8_333_333), slew(2400, 33_333_333), slew(2400, 1_000_000_000)], [19, 79, 2400]);
        assert_eq!([slew(0, 0), slew(u32::MAX, u32::MAX)], [1, u16::MAX]);
    }

    #[test]
    fn a_joints_channel_is_found_by_its_name() {
        let walk = include_bytes!("../../../../motions/walk.ptn");
        let clip = Clip::new_checked(walk).unwrap();
        let joint = clip.rig().joints().find(|joint| joint.name() == "neck").unwrap();
        assert_eq!(channel(&clip, "neck", Kind::Yrotation), Some(joint.first_channel.into()));
        assert_eq!(channel(&clip, "neck", Kind::Xrotation), Some(usize::from(joint.first_channel) + 1));
        assert_eq!(channel(&clip, "neck", Kind::Zrotation), None);
        assert_eq!(channel(&clip, "tail", Kind::Xrotation), None);
    }
}
