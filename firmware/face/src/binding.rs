//! Which of a clip's scalars drive which shapes: found by name once, then a multiplication and a shift each.

use crate::model::{Model, Name, Target};
use crate::morph::Weights;
use crate::{BINDINGS, FULL};
use heapless::Vec;
use pantin::{Rig, Scalars};

/// One scalar that drives one shape.
#[derive(Clone, Copy, Debug)]
struct Drive {
    /// As bytes: a list of these is long, and would have holes.
    channel: [u8; 2],
    /// The shape, and which of its weights, as the model's names have them.
    target: Target,
    mantissa: i8,
    shift: i8,
}

/// How a clip drives a face.
#[derive(Clone, Debug)]
pub struct Binding {
    drives: Vec<Drive, BINDINGS>,
    names: u16,
    scalars: u16,
}

/// A clip with so many known names is a face whatever else it holds.
const FEW: u16 = 3;

impl Binding {
    /// Nothing.
    pub const EMPTY: Binding = Binding { drives: Vec::new(), names: 0, scalars: 0 };

    /// Looks up the names of `rig`'s scalars among those that `model` knows. What finds no room is left out.
    #[inline(always)]
    pub fn of(rig: &Rig, model: &Model) -> Binding {
        let mut binding = Binding::EMPTY;
        binding.set_up(rig, model);
        binding
    }

    /// The same, where nothing was bound: as [`crate::Morph::set_up`].
    #[inline(never)]
    pub fn set_up(&mut self, rig: &Rig, model: &Model) {
        self.bind(rig.scalars(), rig.joint_channels(), model);
    }

    /// The same for scalars of which the first is channel `first`.
    #[inline(always)]
    pub fn bind(&mut self, scalars: Scalars, first: usize, model: &Model) {
        for (index, scalar) in scalars.enumerate() {
            let wanted = scalar.name_hash();
            let mut known = false;
            for name in model.names().filter(|name| name.hash == wanted) {
                known = true;
                let channel = ((first + index) as u16).to_le_bytes();
                let shift = scalar.exponent.saturating_add(name.exponent);
                let Name { target, mantissa, .. } = name;
                let _ = self.drives.push(Drive { channel, target, mantissa, shift });
            }
            self.names += u16::from(known);
            self.scalars += 1;
        }
    }

    /// Number of the clip's scalars that drive something.
    pub fn names(&self) -> usize {
        usize::from(self.names)
    }

    /// Whether the clip is a face: a few of its scalars drive one, or all of them. A lone name among others may mean anything.
    pub fn is_face(&self) -> bool {
        self.names >= FEW || (self.names > 0 && self.names == self.scalars)
    }

    /// The weights of a pose.
    pub fn weigh(&self, pose: &[i32], weights: &mut Weights) {
        weights.clear();
        for drive in &self.drives {
            let raw = pose.get(usize::from(u16::from_le_bytes(drive.channel))).map_or(0, |raw| raw >> 16);
            if raw == 0 {
                continue;
            }
            // 2^15 times 2^7. What is below nothing in the end is nothing: two opposites may share a channel.
            let value = shifted(raw * i32::from(drive.mantissa), drive.shift);
            weights.add(drive.target, value);
        }
    }
}

/// Within two whole weights.
#[inline(always)]
fn shifted(value: i32, shift: i8) -> i32 {
    let value = match shift {
        ..-30 => 0,
        -30..0 => value >> -i32::from(shift),
        0..8 => value << shift,
        _ => value.signum() * 2 * FULL,
    };
    value.clamp(-2 * FULL, 2 * FULL)
}
