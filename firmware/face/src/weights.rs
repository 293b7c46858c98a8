//! Weights of a model's shapes, and what names set.

use crate::error::UnknownName;
use crate::format::SHAPES;
use crate::model::{Model, NameEntry};
use crate::target::Target;

/// A weight as a fixed-point number: 1 is the full effect of a unit, 0 none. [`Weights`] keep -2 to 2. Constants are `Weight::lit("0.5")`; a
/// `pantin::Fraction` is converted by `Weight::from_num`.
pub type Weight = fixed::types::I16F16;

/// A full weight in Q15.
pub const FULL_WEIGHT: i32 = 1 << 15;

/// The weights of a model's shapes, two per shape: one moves the shape as stored (its left side, if it has sides), the other its mirror image
/// (its right side).
///
/// Sums are kept from -2 to 2 in steps of 2^-14, and used from -1 to 1, or from 0 to 1 where the shape takes no negative weights.
#[derive(Clone, Debug)]
pub struct Weights([[i16; 2]; SHAPES]);

impl Default for Weights {
    fn default() -> Self {
        Weights([[0; 2]; SHAPES])
    }
}

impl Weights {
    /// Weights of the neutral face: all 0.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets all weights to 0.
    pub fn clear(&mut self) {
        self.0 = [[0; 2]; SHAPES];
    }

    /// Sets all shapes that `name` drives, and leaves the others as they are. `weight` is the value of a channel with that name: from 0 to 1,
    /// or from -1 to 1 for shapes with negative weights (gaze, lids, the head); the `Head…` angles of Live Link Face are in radians.
    ///
    /// A name that the model does not have is looked up once more with a capital first letter, because ARKit's `jawOpen` is `JawOpen` in the
    /// files of Live Link Face. Returns [`UnknownName`] if there is none; [`NAMES`](crate::NAMES) lists the names of Pantin's own face.
    ///
    /// Names may share shapes: of `set("joy", ..)` and `set("smile_left", ..)` the later call decides. Use [`Weights::add`] for sums.
    pub fn set(&mut self, model: &Model, name: &str, weight: Weight) -> Result<(), UnknownName> {
        each_driven(model, name, |entry| {
            let kept = stored(entry.weight(weight));
            let Some(pair) = self.0.get_mut(entry.target.shape()) else { return };
            for (slot, driven) in pair.iter_mut().zip(entry.target.sides()) {
                if driven {
                    *slot = kept;
                }
            }
        })
    }

    /// Adds to all shapes that `name` drives; otherwise like [`Weights::set`].
    pub fn add(&mut self, model: &Model, name: &str, weight: Weight) -> Result<(), UnknownName> {
        each_driven(model, name, |entry| self.add_to(entry.target, entry.weight(weight)))
    }

    /// Takes the part `part`, 0 to [`FULL_WEIGHT`], of what each shape has that one of `names` drives: once, however many of them drive it. Names that the
    /// model does not have are passed over.
    pub fn fade(&mut self, model: &Model, names: &[&str], part: u16) {
        if part == 0 {
            return;
        }
        let part = i32::from(part).min(FULL_WEIGHT);
        let mut driven = [[false; 2]; SHAPES];
        for name in names {
            let _ = each_driven(model, name, |entry| {
                let Some(pair) = driven.get_mut(entry.target.shape()) else { return };
                pair.iter_mut().zip(entry.target.sides()).for_each(|(seen, side)| *seen |= side);
            });
        }
        let slots = self.0.iter_mut().flatten().zip(driven.iter().flatten());
        for (slot, _) in slots.filter(|slot| *slot.1) {
            *slot = faded(*slot, part);
        }
    }

    /// Adds a weight in Q15 to the sides of one shape; the sum saturates at -2 and 2.
    #[inline(always)]
    pub fn add_to(&mut self, target: Target, weight: i32) {
        let Some(pair) = self.0.get_mut(target.shape()) else { return };
        let sides = target.sides();
        if sides[0] {
            pair[0] = pair[0].saturating_add(stored(weight));
        }
        if sides[1] {
            pair[1] = pair[1].saturating_add(stored(weight));
        }
    }

    /// Walks the two weights of each shape: Q15, -1 to 1.
    #[inline(always)]
    pub fn pairs(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        self.0.iter().map(|&pair| match pair {
            [0, 0] => [0; 2],
            pair => pair.map(clamped),
        })
    }

    /// The two weights of the shape with index `shape`: Q15, -1 to 1; 0 for a shape that does not exist.
    pub fn get(&self, shape: usize) -> [i32; 2] {
        self.0.get(shape).map_or([0; 2], |pair| pair.map(clamped))
    }
}

/// Q15 to Q14.
#[inline(always)]
fn stored(weight: i32) -> i16 {
    (weight >> 1).clamp(i16::MIN.into(), i16::MAX.into()) as i16
}

/// What is left of a weight, of which at most a full one is used.
fn faded(weight: i16, part: i32) -> i16 {
    let weight = clamped(weight) >> 1;
    (weight - ((weight * part) >> 15)) as i16
}

/// Q14 to Q15, at most a full weight.
#[inline(always)]
fn clamped(weight: i16) -> i32 {
    (i32::from(weight) << 1).clamp(-FULL_WEIGHT, FULL_WEIGHT)
}

/// `value * 2^shift`, -2 to 2 in Q15.
#[inline(always)]
pub(crate) fn shifted(value: i32, shift: i8) -> i32 {
    let value = match shift {
        ..-30 => 0,
        -30..0 => value >> -i32::from(shift),
        0..8 => value << shift,
        _ => value.signum() * 2 * FULL_WEIGHT,
    };
    value.clamp(-2 * FULL_WEIGHT, 2 * FULL_WEIGHT)
}

impl NameEntry {
    /// The weight in Q15 for a value of the channel.
    fn weight(&self, value: Weight) -> i32 {
        let value = (value.to_bits() >> 1).clamp(-2 * FULL_WEIGHT, 2 * FULL_WEIGHT);
        shifted(value * i32::from(self.mantissa), self.exponent)
    }
}

/// Visits the entries of a name.
fn each_driven(model: &Model, name: &str, visit: impl FnMut(NameEntry)) -> Result<(), UnknownName> {
    let hash = model.find(name).ok_or(UnknownName)?;
    model.name_entries().filter(|entry| entry.hash == hash).for_each(visit);
    Ok(())
}
