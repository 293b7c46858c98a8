//! Measures the distance between the device's vertices and those in full precision.

use super::blueprint::Blueprint;
use super::draw::ROOM;
use super::exact;
use super::head::{dot, minus};
use super::pose;
use anyhow::Result;
use pantin_face::shape::ShapeKind;
use pantin_face::{Model, Morph};

/// Number of mixtures that are measured, besides each unit alone.
const MIXTURES: usize = 200;
/// Number of units in a mixture.
const AT_ONCE: usize = 8;

/// The largest error.
#[derive(Clone, Copy, Debug, Default)]
pub struct Greatest {
    /// In the model's units of length.
    pub most: f64,
    /// As a fraction of the model's largest extent.
    pub part: f64,
}

/// Compares the morph of `bytes` with `face`, for each unit at full weight and for mixtures.
pub fn greatest(face: &Blueprint, bytes: &[u8]) -> Result<Greatest> {
    let model = Model::new_checked(bytes)?;
    let mut morph = Box::new(Morph::<ROOM>::new(&model)?);
    let step = f64::from(model.step_exponent()).exp2();
    let mut most = 0f64;
    let mut compare = |pairs: &pose::Pairs| {
        morph.apply_unclipped(&model, &pose::weights(pairs));
        for (place, exact) in morph.vertices().iter().zip(exact::places(face, pairs)) {
            let gap = minus(place.map(|x| f64::from(x) * step), exact);
            most = most.max(dot(gap, gap).sqrt());
        }
    };
    let mut random = numbers();
    for shape in 0..face.shapes.len() {
        let mut pairs = vec![[0.0; 2]; face.shapes.len()];
        pairs[shape] = [1.0, random()];
        compare(&pairs);
    }
    for _ in 0..MIXTURES {
        let mut pairs = vec![[0.0; 2]; face.shapes.len()];
        for _ in 0..AT_ONCE {
            let shape = (random() * face.shapes.len() as f64) as usize;
            let least = if face.shapes[shape].kind == ShapeKind::Unsigned { 0.0 } else { -1.0 };
            pairs[shape] = [(); 2].map(|()| least + random() * (1.0 - least));
        }
        compare(&pairs);
    }
    let extent = (0..3).map(|axis| {
        let along = face.points.iter().map(|point| point[axis]);
        along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
    });
    Ok(Greatest { most, part: most / extent.fold(1e-9, f64::max) })
}

/// Returns a generator of numbers from 0 to 1, the same in every run.
fn numbers() -> impl FnMut() -> f64 {
    let mut state = 1u64;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 31) as f64
    }
}
