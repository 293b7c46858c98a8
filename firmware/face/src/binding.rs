//! Which of a clip's scalars drive which shapes: found by name once, then a multiplication and a shift each.

use crate::morph::Weights;
use crate::model::{Model, Name, hash};
use crate::{BINDINGS, FULL};
use heapless::Vec;
use pantin::Rig;

/// One scalar that drives one shape.
#[derive(Clone, Copy, Debug)]
struct Drive {
    channel: u16,
    shape: u8,
    sides: [bool; 2],
    one_way: bool,
    mantissa: i8,
    shift: i8,
}

/// How a clip drives a face.
#[derive(Clone, Debug, Default)]
pub struct Binding {
    drives: Vec<Drive, BINDINGS>,
    names: u16,
}

impl Binding {
    /// Looks up the names of `rig`'s scalars among those that `model` knows. What finds no room is left out.
    pub fn of(rig: &Rig, model: &Model) -> Binding {
        let mut binding = Binding::default();
        for (index, scalar) in rig.scalars().enumerate() {
            let wanted = hash(scalar.name().as_bytes());
            let mut known = false;
            for name in model.names().filter(|name| name.hash == wanted) {
                known = true;
                let channel = (rig.joint_channels() + index) as u16;
                let one_way = model.shapes().nth(usize::from(name.shape)).is_some_and(|shape| shape.kind == crate::shape::Kind::Whole);
                let _ = binding.drives.push(Drive::new(channel, name, one_way, scalar.exponent));
            }
            binding.names += u16::from(known);
        }
        binding
    }

    /// Number of the clip's scalars that drive something: a clip without is no face.
    pub fn names(&self) -> usize {
        usize::from(self.names)
    }

    /// The weights of a pose.
    pub fn weigh(&self, pose: &[i32], weights: &mut Weights) {
        weights.clear();
        for drive in &self.drives {
            let raw = pose.get(usize::from(drive.channel)).map_or(0, |raw| raw >> 16);
            // 2^15 times 2^7.
            let value = shifted(raw * i32::from(drive.mantissa), drive.shift);
            // What pushes a unit below nothing belongs to its opposite, which has a name of its own.
            let value = if drive.one_way { value.max(0) } else { value };
            weights.add(usize::from(drive.shape), drive.sides, value);
        }
    }
}

impl Drive {
    fn new(channel: u16, name: Name, one_way: bool, exponent: i8) -> Drive {
        let shift = exponent.saturating_add(name.exponent);
        Drive { channel, shape: name.shape, sides: name.sides, one_way, mantissa: name.mantissa, shift }
    }
}

/// Within two whole weights.
fn shifted(value: i32, shift: i8) -> i32 {
    let value = match shift {
        ..-30 => 0,
        -30..0 => value >> -i32::from(shift),
        0..8 => value << shift,
        _ => value.signum() * 2 * FULL,
    };
    value.clamp(-2 * FULL, 2 * FULL)
}
