//! How one clip follows another, and the difference that this leaves behind, one channel: a segment of the decoder's own kind that ends at zero.

use core::time::Duration;

/// How one clip follows another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Transition {
    /// At once. The pose jumps; place and heading do not.
    Cut,
    /// The difference of the poses dies out as a cubic in this many frames of the new clip, after which the pose is exactly the clip's; that of their
    /// velocities in [`SWING`](Transition::SWING) at most, so that limbs do not swing past both motions, but that of the figure's way in all of them. 0 frames
    /// are a cut; 1 frame keeps the old pose for the first instant alone.
    Inertialized(u8),
    /// The difference of the poses alone dies out: the old motion stops at once. For comparison.
    Faded(u8),
}

impl Transition {
    /// The time in which a difference of velocities dies out in a transition, at most: a quarter of a second.
    pub const SWING: Duration = Duration::from_millis(250);

    pub(crate) fn frames(self) -> u8 {
        match self {
            Transition::Cut => 0,
            Transition::Inertialized(frames) | Transition::Faded(frames) => frames,
        }
    }
}

/// What one channel is away from its clip during a transition: 16 bytes. It moves by the decoder's three additions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Offset {
    /// Difference, in the channel's raw unit, and its velocity, acceleration and slope a frame.
    pub(crate) d: i32,
    pub(crate) v: i32,
    pub(crate) w: i32,
    pub(crate) k: i32,
}

impl Offset {
    /// No difference: what fills memory before an animator takes it.
    pub const ZERO: Offset = Offset { d: 0, v: 0, w: 0, k: 0 };

    /// Whether there is no difference and none comes: at the end, and in channels that never had one.
    #[inline(always)]
    pub(crate) fn is_zero(&self) -> bool {
        self.d | self.v == 0
    }

    /// Puts the difference where the velocity leads to zero in a number of frames without turning back: it dies out as v (1 - t / n)^2, which
    /// is the cubic with k = 2 v / n^2, and goes n v / 3.
    pub(crate) fn coast(&mut self, frames: u8) {
        self.d = -(i64::from(self.v) * i64::from(frames) / 3) as i32;
    }

    /// A number of frames on, bit for bit as many [`Offset::step`].
    #[inline(always)]
    pub(crate) fn after(&self, frames: u8) -> Offset {
        let Offset { d, v, w, k } = *self;
        let n = i32::from(frames);
        let pairs = n * (n - 1) / 2;
        // Below 2^23, and whole.
        let triples = pairs * (n - 2) / 3;
        let sum = |a: i32, n: i32, b: i32| a.wrapping_add(n.wrapping_mul(b));
        Offset { d: sum(sum(sum(d, n, v), pairs, w), triples, k), v: sum(sum(v, n, w), pairs, k), w: sum(w, n, k), k }
    }

    /// One frame on.
    #[inline(always)]
    pub(crate) fn step(&mut self) {
        self.d = self.d.wrapping_add(self.v);
        self.v = self.v.wrapping_add(self.w);
        self.w = self.w.wrapping_add(self.k);
    }
}

/// A positive fraction of 1 at most as a product and a shift.
#[derive(Clone, Copy, Debug)]
struct Ratio {
    /// 2^29 to 2^30, not included.
    factor: u32,
    shift: u32,
}

impl Ratio {
    const ONE: Ratio = Ratio { factor: 1 << 29, shift: 29 };

    /// `over` is at most 12, `under` below 2^25 and not below `over`.
    fn new(over: u32, under: u32) -> Ratio {
        let under = under.max(1);
        let (mut rest, mut shift) = (over, 29);
        while shift < 58 && rest < under {
            (rest, shift) = (rest << 1, shift + 1);
        }
        // What is divided is below twice the divisor: the first digit is 1, and 29 follow.
        let mut factor = 0;
        for _ in 0..30 {
            let digit = u32::from(rest >= under);
            factor = factor << 1 | digit;
            rest = rest.wrapping_sub(under * digit) << 1;
        }
        Ratio { factor, shift }
    }

    #[inline(always)]
    fn of(self, x: i32) -> i32 {
        // Below 2^61.
        let product = i64::from(x) * i64::from(self.factor);
        // A shift of 64 bits is a call where there are no instructions for it.
        match self.shift.checked_sub(32) {
            Some(shift) => ((product >> 32) as i32) >> shift.min(31),
            None => (product >> self.shift) as i32,
        }
    }
}

/// The cubic that takes difference and velocity to zero in a number of frames.
///
/// With d + n v + C(n,2) w + C(n,3) k = 0 and v + n w + C(n,2) k = 0 the slope is k = 12 d / (n (n^2 - 1)) + 6 v / (n (n - 1)) and the
/// acceleration w = -v / n - (n - 1) k / 2. Rounded, they leave up to C(n,3) / 2 raw units at the end. The cubic is therefore solved
/// again at [`AGAIN`], but not before velocities that die out in fewer frames have done so; with 2 frames left the solution is whole, so that the end is exactly zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cubic {
    frames: u8,
    of_d: Ratio,
    of_v: Ratio,
    inverse: Ratio,
}

/// The frames of this time each in which velocities die out during a transition that takes more of them.
pub(crate) fn swing(frames: u8, frame_time_ns: u32) -> Option<u8> {
    let few = Transition::SWING.subsec_nanos().div_ceil(frame_time_ns.max(1)).max(2);
    u8::try_from(few).ok().filter(|few| few.saturating_add(2) < frames)
}

/// The numbers of frames left at which the cubic is solved again.
pub(crate) const AGAIN: [u8; 3] = [2, 32, 128];

impl Cubic {
    pub(crate) fn new(frames: u8) -> Cubic {
        // Fewer frames need no ratios.
        if frames < 3 {
            return Cubic { frames, of_d: Ratio::ONE, of_v: Ratio::ONE, inverse: Ratio::ONE };
        }
        let n = u32::from(frames);
        Cubic { frames, of_d: Ratio::new(12, n * (n * n - 1)), of_v: Ratio::new(6, n * (n - 1)), inverse: Ratio::new(1, n) }
    }

    /// Sets acceleration and slope of all offsets by their differences and velocities: those of zero ones too, what is left of whose acceleration would
    /// lead away again.
    pub(crate) fn solve_all(&self, offsets: &mut [Offset]) {
        for offset in offsets.iter_mut().filter(|offset| **offset != Offset::ZERO) {
            self.solve(offset);
        }
    }

    /// Sets acceleration and slope so that the velocity dies out by another cubic, of fewer frames. Until then the sum of both is a cubic, too.
    pub(crate) fn solve_apart(&self, swing: &Cubic, offset: &mut Offset) {
        let Offset { d, v, .. } = *offset;
        let (mut slow, mut fast) = (Offset { d, ..Offset::ZERO }, Offset { v, ..Offset::ZERO });
        self.solve(&mut slow);
        swing.solve(&mut fast);
        (offset.w, offset.k) = (slow.w.wrapping_add(fast.w), slow.k.wrapping_add(fast.k));
    }

    /// Sets acceleration and slope by difference and velocity.
    #[inline(never)]
    pub(crate) fn solve(&self, offset: &mut Offset) {
        let Offset { d, v, .. } = *offset;
        if offset.is_zero() {
            // What the cubic gives, without its products.
            *offset = Offset::ZERO;
            return;
        }
        match self.frames {
            0 => *offset = Offset::ZERO,
            1 => (offset.v, offset.w, offset.k) = (d.wrapping_neg(), d, 0),
            2 => {
                offset.w = d.wrapping_neg().wrapping_sub(v.wrapping_mul(2));
                offset.k = d.wrapping_mul(2).wrapping_add(v.wrapping_mul(3));
            }
            n => {
                let k = self.of_d.of(d).wrapping_add(self.of_v.of(v));
                // (n - 1) k / 2, rounded down, in products of 32 bits.
                let (n, odd) = (i32::from(n) - 1, k & 1);
                let half = (k >> 1).wrapping_mul(n).wrapping_add((odd * n) >> 1);
                (offset.w, offset.k) = (self.inverse.of(v).wrapping_neg().wrapping_sub(half), k);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(d: i32, v: i32, frames: u8) -> Vec<i32> {
        let mut offset = Offset { d, v, ..Offset::ZERO };
        Cubic::new(frames).solve(&mut offset);
        let mut values = vec![offset.d];
        for left in (0..frames).rev() {
            offset.step();
            if AGAIN.contains(&left) {
                Cubic::new(left).solve(&mut offset);
            }
            values.push(offset.d);
        }
        assert_eq!((offset.d, offset.v), (0, 0), "{d} {v} {frames}");
        values
    }

    #[test]
    fn it_ends_exactly_at_zero_and_starts_with_its_velocity() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut next = || random.i32(..);
        for frames in 1..=255u8 {
            for shift in [2, 4, 12, 27] {
                let (d, v) = (next() >> shift, (next() >> (shift + 3)) / (i32::from(frames) / 8 + 1));
                let values = runs(d, v, frames);
                if frames > 2 {
                    assert_eq!(values[1] - values[0], v, "{frames}");
                }
                // Where it is solved again the path stays smooth: the second difference changes by a part of itself.
                let truth = |n: f64| {
                    let (t, big) = (n / f64::from(frames), f64::from(frames));
                    f64::from(d) * (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t) + f64::from(v) * big * t * (1.0 - t) * (1.0 - t)
                };
                for (n, &value) in values.iter().enumerate() {
                    let near = f64::from(v).abs() + f64::from(d).abs() * 1.7 / f64::from(frames) + 2e6;
                    assert!((f64::from(value) - truth(n as f64)).abs() <= near, "{frames} frames, {n}: {value}");
                }
            }
        }
    }

    #[test]
    fn a_velocity_dies_out_in_a_quarter_of_a_second() {
        // 60 frames of 1/60 s.
        let (few, d, v) = (swing(60, 16_666_667).unwrap(), 1 << 24, 1 << 22);
        assert_eq!((few, swing(17, 16_666_667), swing(16, 16_666_667)), (15, None, None));
        let mut offset = Offset { d, v, ..Offset::ZERO };
        Cubic::new(60).solve_apart(&Cubic::new(few), &mut offset);
        let (alone, mut most) = (runs(d, 0, 60), 0);
        for left in (0..60u8).rev() {
            offset.step();
            if left == 60 - few || (left < 60 - few && AGAIN.contains(&left)) {
                Cubic::new(left).solve(&mut offset);
            }
            let own = alone[usize::from(60 - left)];
            most = most.max(offset.d - own);
            // What rounding leaves of a cubic of 60 frames.
            assert!(left > 60 - few || (offset.d - own).abs() <= 17_110, "{left} left: {}", offset.d - own);
        }
        assert_eq!((offset.d, offset.v), (0, 0));
        // It goes as far as in a transition of a quarter of a second.
        let short = runs(0, v, few).into_iter().max().unwrap();
        assert!((most - short).abs() <= 17_110, "{most}, {short}");
    }

    #[test]
    fn frames_at_once_are_as_many_steps() {
        let start = Offset { d: -5_000_000, v: 700_001, w: i32::MAX - 3, k: i32::MIN + 7 };
        let mut offset = start;
        for frames in 0..=255 {
            assert_eq!(start.after(frames), offset, "{frames}");
            offset.step();
        }
    }

    #[test]
    fn no_frames_are_no_difference() {
        assert_eq!(runs(0, 0, 0), [0]);
        let mut offset = Offset { d: 5, v: 6, w: 7, k: 8 };
        Cubic::new(0).solve(&mut offset);
        assert_eq!(offset, Offset::ZERO);
    }
}
