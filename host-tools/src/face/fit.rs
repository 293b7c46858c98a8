//! Decomposes a pose into units: the weights whose sum is closest to a target, by bounded least squares (docs/METHOD.md 3.2).

use super::blueprint::Blueprint;
use super::exact;
use super::head::{Vector, minus};
use super::names::goes_aside;
use super::pose::Pairs;
use anyhow::{Result, ensure};
use pantin_face::shape::{Interpolation, ShapeKind};
use std::f64::consts::PI;

/// Number of linearizations; each system is solved by sweeps over the weights.
const ROUNDS: usize = 12;
const SWEEPS: usize = 200;
/// Step of the numeric derivatives.
const STEP: f64 = 1e-4;
/// Regularization in mm^2 per squared weight: it keeps units that are nearly equal from cancelling each other.
const RIDGE: f64 = 1e-3;

/// A fitted pose.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The weights.
    pub pairs: Pairs,
    /// Root mean square distance of a point from the target, in millimetres.
    pub residual: f64,
    /// Root mean square distance with all weights 0, in millimetres.
    pub before: f64,
    /// The largest distance in millimetres, and the index of its point.
    pub worst: (f64, usize),
}

/// One weight that is fitted.
struct Unknown {
    shape: usize,
    sides: [bool; 2],
    least: f64,
}

/// Fits the units of `face` to `target`. Fails if the target has another number of points.
pub fn fit(face: &Blueprint, target: &[Vector]) -> Result<Fit> {
    ensure!(target.len() == face.vertices(), "the target has {} points; Pantin's face has {}", target.len(), face.vertices());
    let unknowns = unknowns(face);
    let mut ways = vec![0.0; unknowns.len()];
    for _ in 0..ROUNDS {
        let at = exact::places(face, &pairs(face, &unknowns, &ways));
        let gap = differences(target, &at);
        let columns: Vec<Vec<f64>> = (0..unknowns.len())
            .map(|unknown| {
                let mut moved = ways.clone();
                moved[unknown] += STEP;
                let places = exact::places(face, &pairs(face, &unknowns, &moved));
                differences(&places, &at).iter().map(|x| x / STEP).collect()
            })
            .collect();
        descend(&columns, &gap, &unknowns, &mut ways);
    }
    let mut pairs = pairs(face, &unknowns, &ways);
    for (shape, pair) in face.shapes.iter().zip(&mut pairs).filter(|(shape, _)| !shape.sided && goes_aside(&shape.name)) {
        // Its two directions cancel each other.
        let both = if shape.kind == ShapeKind::Unsigned { pair[0].min(pair[1]) } else { 0.0 };
        *pair = pair.map(|weight| weight - both);
    }
    let distances = |places: &[Vector]| -> Vec<f64> {
        places.iter().zip(target).map(|(&a, &b)| minus(a, b).iter().map(|x| x * x).sum::<f64>()).collect()
    };
    let mean = |squares: &[f64]| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    let squares = distances(&exact::places(face, &pairs));
    let worst = squares.iter().enumerate().fold((0.0, 0), |worst, (index, &x)| if x > worst.0 { (x, index) } else { worst });
    let before = mean(&distances(&face.neutral()));
    Ok(Fit { pairs, residual: mean(&squares), before, worst: (worst.0.sqrt(), worst.1) })
}

fn differences(a: &[Vector], b: &[Vector]) -> Vec<f64> {
    a.iter().zip(b).flat_map(|(&a, &b)| minus(a, b)).collect()
}

/// Returns an unknown per unit, or per side of units with sides. The head's rotation is not fitted.
fn unknowns(face: &Blueprint) -> Vec<Unknown> {
    let of = |(index, shape): (usize, &super::blueprint::Shape)| {
        let least = if shape.kind == ShapeKind::Unsigned { 0.0 } else { -1.0 };
        let one = |sides| Unknown { shape: index, sides, least };
        let apart = shape.sided || goes_aside(&shape.name);
        match (shape.kind, apart) {
            (ShapeKind::Head, _) => vec![],
            (_, true) => vec![one([true, false]), one([false, true])],
            (_, false) => vec![one([true, true])],
        }
    };
    face.shapes.iter().enumerate().flat_map(of).collect()
}

/// Converts parts of displacements to weights: eased units are fitted by their displacement, in which the problem is linear.
fn pairs(face: &Blueprint, unknowns: &[Unknown], ways: &[f64]) -> Pairs {
    let mut pairs = vec![[0.0; 2]; face.shapes.len()];
    for (unknown, &way) in unknowns.iter().zip(ways) {
        let weight = match face.shapes[unknown.shape].interpolation {
            Interpolation::Eased => way.signum() * (1.0 - 2.0 * way.abs().min(1.0)).acos() / PI,
            Interpolation::ImprovedLinear => way.clamp(-1.0, 1.0).asin() * 2.0 / PI,
            _ => way,
        };
        for (slot, driven) in pairs[unknown.shape].iter_mut().zip(unknown.sides) {
            if driven {
                *slot = weight;
            }
        }
    }
    pairs
}

/// Minimizes |gap - columns * change|^2 within the bounds, one unknown after the other.
fn descend(columns: &[Vec<f64>], gap: &[f64], unknowns: &[Unknown], ways: &mut [f64]) {
    let mut gap = gap.to_vec();
    let squares: Vec<f64> = columns.iter().map(|column| column.iter().map(|x| x * x).sum()).collect();
    for _ in 0..SWEEPS {
        for ((column, &square), (unknown, way)) in columns.iter().zip(&squares).zip(unknowns.iter().zip(ways.iter_mut())) {
            let slope: f64 = column.iter().zip(&gap).map(|(a, b)| a * b).sum::<f64>() - RIDGE * *way;
            let next = (*way + slope / (square + RIDGE)).clamp(unknown.least, 1.0);
            let change = next - *way;
            *way = next;
            column.iter().zip(&mut gap).for_each(|(a, b)| *b -= a * change);
        }
    }
}
