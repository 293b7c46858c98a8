//! Layers: another pose over the animator's, where a mask says, with a weight that moves in time.

use crate::groups::{Group, Shape, nearest};
use crate::mask::{Mask, Run};
use pantin::{FormRef, Pose, WrongForm};

/// A weight of 0 to 1 in 2^-15.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Weight(u16);

impl Weight {
    /// Nothing of a layer.
    pub const ZERO: Weight = Weight(0);
    /// A layer alone.
    pub const ONE: Weight = Weight(1 << 15);

    /// A weight in 2^-15; what is above 2^15 is 1.
    pub const fn from_bits(bits: u16) -> Weight {
        Weight(if bits > 1 << 15 { 1 << 15 } else { bits })
    }

    /// The weight in 2^-15: 0 to 2^15.
    pub const fn to_bits(self) -> u16 {
        self.0
    }

    /// What is left beside it.
    pub(crate) const fn rest(self) -> Weight {
        Weight((1 << 15) - self.0)
    }

    /// A difference times the weight, rounded down; times 1 it is exact.
    #[inline(always)]
    pub(crate) fn of(self, difference: i32) -> i32 {
        // 17 bits times 2^15, and the share of the low bits, which is below 2^15.
        let (high, low) = (difference >> 15, (difference & 0x7fff) as u32);
        high.wrapping_mul(self.0.into()).wrapping_add(((low * u32::from(self.0)) >> 15) as i32)
    }
}

/// A weight on its way to another, which it reaches exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ramp {
    now: Weight,
    to: Weight,
    /// Time until it is there.
    left_us: u32,
}

impl Ramp {
    /// A weight that stays.
    pub const fn at(weight: Weight) -> Ramp {
        Ramp { now: weight, to: weight, left_us: 0 }
    }

    /// Goes to a weight in a time, at once if it is 0.
    pub fn go_to(&mut self, weight: Weight, time_us: u32) {
        (self.to, self.left_us) = (weight, time_us);
        if time_us == 0 {
            self.now = weight;
        }
    }

    /// Lets time pass.
    pub fn advance(&mut self, elapsed_us: u32) {
        if elapsed_us >= self.left_us {
            (self.now, self.left_us) = (self.to, 0);
            return;
        }
        let way = i64::from(self.to.0) - i64::from(self.now.0);
        let step = (way * i64::from(elapsed_us)).checked_div(self.left_us.into()).unwrap_or(0);
        self.now = Weight((i64::from(self.now.0) + step) as u16);
        self.left_us -= elapsed_us;
    }

    /// The weight now.
    pub fn weight(&self) -> Weight {
        self.now
    }
}

/// Puts a pose over another where the mask says: at weight 1 the layer's, at 0 none of it, between them the shortest way. Angles wrap; of
/// angles that are the same rotation the nearest are taken. The forms have to be equal.
#[inline(never)]
pub fn blend(
    pose: &mut [i32],
    groups: &[Group],
    form: FormRef<'_>,
    layer: Pose<'_>,
    mask: &Mask<'_>,
    weight: Weight,
) -> Result<(), WrongForm> {
    form.check(layer.form)?;
    if weight == Weight::ZERO {
        return Ok(());
    }
    if let Some(runs) = mask.runs(groups) {
        mix_all(pose, runs, layer.values, weight);
    } else {
        mix_all(pose, groups.iter().filter(mask.picks()).map(Run::of_group), layer.values, weight);
    }
    Ok(())
}

/// Mixes the channels of runs or groups.
#[inline(always)]
pub(crate) fn mix_all(pose: &mut [i32], runs: impl Iterator<Item = Run>, to: &[i32], weight: Weight) {
    // Of one length, which the compiler knows: one comparison for both.
    let len = pose.len().min(to.len());
    let (pose, to) = (pose.get_mut(..len).unwrap_or_default(), to.get(..len).unwrap_or_default());
    for run in runs {
        let (Some(own), Some(to)) = (pose.get_mut(run.range()), to.get(run.range())) else { continue };
        if weight == Weight::ONE {
            own.iter_mut().zip(to).for_each(|(own, to)| *own = *to);
        } else {
            match run.shape {
                Shape::Free => mix_each(own, to, weight),
                Shape::Quaternion => mix_far(run.shape, own, to, weight),
                Shape::Euler | Shape::Map => mix_near(run.shape, own, to, weight),
            }
        }
    }
}

/// A quarter turn.
const FAR: u32 = 1 << 30;

/// Whether a difference is more than a quarter turn either way.
#[inline(always)]
fn is_far(difference: i32) -> bool {
    difference.wrapping_add(FAR as i32) as u32 > 2 * FAR
}

/// Mixes groups of three angles, as most joints have, that are near to each other, as they are mostly.
#[inline(never)]
fn mix_near(shape: Shape, mut own: &mut [i32], mut to: &[i32], weight: Weight) {
    // Chunks of three would be counted by a division.
    while let (Some((group, own_rest)), Some((to_group, to_rest))) =
        (own.split_first_chunk_mut::<3>(), to.split_first_chunk::<3>())
    {
        let ([a, b, c], &[x, y, z]) = (&mut *group, to_group);
        let (d, e, f) = (x.wrapping_sub(*a), y.wrapping_sub(*b), z.wrapping_sub(*c));
        // Where the highest two bits of a difference are not equal, it is a quarter turn or more.
        if (d ^ d << 1) | (e ^ e << 1) | (f ^ f << 1) < 0 {
            mix_far(shape, group, to_group, weight);
        } else {
            *a = a.wrapping_add(weight.of(d));
            *b = b.wrapping_add(weight.of(e));
            *c = c.wrapping_add(weight.of(f));
        }
        (own, to) = (own_rest, to_rest);
    }
}

#[inline(always)]
fn mix_each(own: &mut [i32], to: &[i32], weight: Weight) {
    for (own, to) in own.iter_mut().zip(to) {
        *own = own.wrapping_add(weight.of(to.wrapping_sub(*own)));
    }
}

/// Mixes groups of rotations. Of the pose's own that are far from the layer's, what is the same rotation nearest to the layer's is taken.
#[inline(never)]
fn mix_far(shape: Shape, mut own: &mut [i32], mut to: &[i32], weight: Weight) {
    let width = if shape == Shape::Quaternion { 4 } else { 3 };
    while let (Some((group, own_rest)), Some((to_group, to_rest))) = (own.split_at_mut_checked(width), to.split_at_checked(width))
    {
        (own, to) = (own_rest, to_rest);
        let far = |(own, to): (&i32, &i32)| is_far(to.wrapping_sub(*own));
        if shape == Shape::Quaternion || group.iter().zip(to_group).any(far) {
            nearest(shape, group, to_group);
        }
        mix_each(group, to_group, weight);
    }
}

/// Adds the difference of a pose to a reference, times a weight, where the mask says. A pose that is the reference adds nothing. The
/// difference is a channel's: meant for small ones, such as a breath or a recoil. The forms have to be equal.
#[inline(never)]
pub fn add(
    pose: &mut [i32],
    groups: &[Group],
    form: FormRef<'_>,
    layer: Pose<'_>,
    reference: &[i32],
    mask: &Mask<'_>,
    weight: Weight,
) -> Result<(), WrongForm> {
    form.check(layer.form)?;
    for group in groups.iter().filter(|group| mask.contains(group.bit.into())) {
        let range = group.range();
        let (Some(own), Some(layer), Some(reference)) =
            (pose.get_mut(range.clone()), layer.values.get(range.clone()), reference.get(range))
        else {
            continue;
        };
        for ((own, layer), reference) in own.iter_mut().zip(layer).zip(reference) {
            *own = own.wrapping_add(weight.of(layer.wrapping_sub(*reference)));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weight_of_one_is_exact_and_none_is_nothing() {
        for difference in [0, 1, -1, 65_535, -65_536, i32::MAX, i32::MIN, 0x1234_5678] {
            assert_eq!(Weight::ONE.of(difference), difference);
            assert_eq!(Weight::ZERO.of(difference), 0);
            let half = i64::from(Weight::from_bits(1 << 14).of(difference));
            assert!((half - i64::from(difference) / 2).abs() <= 2, "{difference}: {half}");
        }
        assert_eq!(Weight::from_bits(40_000), Weight::ONE);
    }

    #[test]
    fn a_ramp_arrives() {
        let mut ramp = Ramp::at(Weight::ZERO);
        ramp.go_to(Weight::ONE, 1_000_000);
        let mut last = 0;
        for _ in 0..100 {
            ramp.advance(9_999);
            assert!(ramp.weight().to_bits() >= last);
            last = ramp.weight().to_bits();
        }
        assert!(last > 32_000 && last < 1 << 15);
        ramp.advance(1_000);
        assert_eq!(ramp.weight(), Weight::ONE);
        ramp.go_to(Weight::from_bits(5), 0);
        assert_eq!(ramp.weight().to_bits(), 5);
    }
}
