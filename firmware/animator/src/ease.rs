//! A difference that dies out by time: what is left of a foot's lock.

/// The whole way, in 2^-15.
const ONE: u32 = 1 << 15;

/// How far something is from where the clip has it, along one axis, in raw units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Ease {
    /// The distance at which it was let go.
    pub(crate) d: i32,
    /// The distance that it would go in the whole time, at the velocity at which it was let go.
    v: i32,
}

impl Ease {
    /// A distance without velocity.
    pub(crate) fn at_rest(d: i32) -> Ease {
        Ease { d, v: 0 }
    }

    /// Converts the distance and its velocity to another unit: 2^-`shift` old units.
    pub(crate) fn in_unit(self, shift: i32) -> Ease {
        Ease { d: crate::chain::shifted(self.d, -shift), v: crate::chain::shifted(self.v, -shift) }
    }

    /// Converts the velocity to another time.
    pub(crate) fn in_time(self, from_us: u32, to_us: u32) -> Ease {
        let v = (i64::from(self.v) * i64::from(to_us)).checked_div(from_us.into()).unwrap_or(0);
        Ease { v: v.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32, ..self }
    }

    /// The distance at a part of the way, in 2^-15: the cubic that begins with this distance and velocity and ends at zero with neither.
    pub(crate) fn at(self, part: u32) -> i32 {
        let t = i64::from(part.min(ONE));
        let left = i64::from(ONE) - t;
        let squared = (left * left) >> 15;
        // Below 2^32 times 2^17.
        let own = (i64::from(self.d) * ((squared * (i64::from(ONE) + 2 * t)) >> 15)) >> 15;
        let moved = (i64::from(self.v) * ((squared * t) >> 15)) >> 15;
        (own + moved).clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32
    }

    /// Takes another distance, `elapsed_us` after the last one, and the velocity of this change.
    pub(crate) fn hold(&mut self, d: i32, elapsed_us: u32, whole_us: u32) {
        let moved = i64::from(d.wrapping_sub(self.d)) * i64::from(whole_us);
        let v = moved.checked_div(elapsed_us.into()).unwrap_or(0);
        *self = Ease { d, v: v.clamp(i64::from(-i32::MAX), i64::from(i32::MAX)) as i32 };
    }
}

/// The part of a way that takes `whole_us`, in 2^-15.
pub(crate) fn part(since_us: u32, whole_us: u32) -> u32 {
    (u64::from(since_us.min(whole_us)) << 15).checked_div(whole_us.into()).unwrap_or(u64::from(ONE)) as u32
}
