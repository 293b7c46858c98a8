//! Parses poses written as sums, `joy=0.5,blink_left=1`.

use super::blueprint::{Blueprint, Drive};
use anyhow::{Context, Result, bail, ensure};
use pantin_face::{FULL_WEIGHT, Target, Weights};
use std::collections::HashSet;

/// A pair of weights for each shape.
pub type Pairs = Vec<[f64; 2]>;

/// Far more than any face shows.
const MOST_WEIGHT: f64 = 100.0;

/// Parses a sum of names, each with a value (default 1). Fails on unknown names, for a name that comes twice, and for values that are no number from -100 to 100.
pub fn parse(face: &Blueprint, sum: &str) -> Result<Pairs> {
    let mut pairs = vec![[0.0; 2]; face.shapes.len()];
    let mut names = HashSet::new();
    for term in sum.split([',', '+']).map(str::trim).filter(|term| !term.is_empty()) {
        let (name, value) = term.split_once('=').unwrap_or((term, "1"));
        ensure!(names.insert(name.trim()), "{term}: {} comes twice; give it one weight", name.trim());
        let value: f64 = value.trim().parse().with_context(|| format!("{term}: expected name=number"))?;
        ensure!(
            value.abs() <= MOST_WEIGHT,
            "{term}: expected a weight from -{MOST_WEIGHT} to {MOST_WEIGHT}; 1 is the whole unit"
        );
        add(face, name.trim(), value, &mut pairs)?;
    }
    Ok(pairs)
}

/// Adds the weights of a channel with this name at a value. Fails if the name is unknown.
pub fn add(face: &Blueprint, name: &str, value: f64, pairs: &mut Pairs) -> Result<()> {
    let driven: Vec<&Drive> = face.names.iter().filter(|drive| drive.name == name).collect();
    if driven.is_empty() {
        bail!("no unit of the face is called {name}; docs/FACE.md lists them");
    }
    for drive in driven {
        for (weight, driven) in pairs[drive.shape].iter_mut().zip(drive.sides) {
            *weight += if driven { drive.gain * value } else { 0.0 };
        }
    }
    Ok(())
}

/// Converts weights to those of the device.
pub fn weights(pairs: &Pairs) -> Weights {
    let mut weights = Weights::new();
    for (shape, pair) in pairs.iter().enumerate() {
        for (sides, weight) in [[true, false], [false, true]].into_iter().zip(pair) {
            weights.add_to(Target::new(shape as u8, sides), (weight * f64::from(FULL_WEIGHT)).round() as i32);
        }
    }
    weights
}
