//! Evaluates a blueprint in full precision: the reference for the device's arithmetic.

use super::blueprint::{Blueprint, Shape};
use super::head::{Vector, minus, plus};
use pantin_face::shape::{Interpolation, ShapeKind};
use std::f64::consts::PI;

/// The part of its displacement that a point has moved at a weight.
pub fn eased(interpolation: Interpolation, weight: f64) -> f64 {
    match interpolation {
        Interpolation::Eased => weight.signum() * (1.0 - (PI * weight).cos()) / 2.0,
        Interpolation::ImprovedLinear => (PI * weight / 2.0).sin(),
        Interpolation::Linear | Interpolation::Spherical => weight,
    }
}

/// Returns the positions of all points for a pair of weights per shape, -1 to 1. Openings do not clip their members, and the head does not
/// rotate.
pub fn places(face: &Blueprint, weights: &[[f64; 2]]) -> Vec<Vector> {
    let mut places = face.neutral();
    let neutral = places.clone();
    let moved = |shape: &Shape, pair: [f64; 2]| shape.kind != ShapeKind::Head && pair != [0.0; 2];
    let whole =
        |shape: &Shape, pair: [f64; 2]| if shape.kind == ShapeKind::Unsigned { pair.map(|weight| weight.max(0.0)) } else { pair };
    for (shape, &pair) in face.shapes.iter().zip(weights).filter(|(shape, pair)| moved(shape, **pair)) {
        let pair = whole(shape, pair);
        let [stored, mirrored] = pair.map(|weight| eased(shape.interpolation, weight));
        let arc = shape.arc.filter(|_| shape.interpolation == Interpolation::Spherical);
        let longest = |way: &Vector| way.iter().fold(0f64, |longest, x| longest.max(x.abs()));
        let most = shape.deltas.iter().map(|(_, way)| longest(way)).fold(1e-12, f64::max);
        for &(index, way) in &shape.deltas {
            let image = face.mirror(index);
            let reversed = [-way[0], way[1], way[2]];
            if let Some(arc) = arc {
                let bend = (longest(&way) / most).powi(2);
                let centre = arc.centre;
                let other = [-centre[0], centre[1], centre[2]];
                places[index] = plus(places[index], on_arc(minus(neutral[index], centre), way, bend, arc.degrees, pair[0]), 1.0);
                places[image] =
                    plus(places[image], on_arc(minus(neutral[image], other), reversed, bend, arc.degrees, pair[1]), 1.0);
            } else {
                places[index] = plus(places[index], way, stored);
                places[image] = plus(places[image], reversed, mirrored);
            }
        }
    }
    for (shape, &pair) in face.shapes.iter().zip(weights).filter(|(shape, pair)| moved(shape, **pair)) {
        turn(face, shape, whole(shape, pair), &mut places);
    }
    places
}

/// How far a point moves by the paper's spherical formula, from `start` to `start + way`, both seen from the centre. A point that moves less than others is
/// bent less: the push away from the centre, which grows with the square of the angle, is multiplied by `bend`.
fn on_arc(start: Vector, way: Vector, bend: f64, degrees: f64, weight: f64) -> Vector {
    let angle = degrees.to_radians();
    let [from, to] = [((1.0 - weight) * angle).sin() / angle.sin(), (weight * angle).sin() / angle.sin()];
    plus(start.map(|x| x * (from + to - 1.0) * bend), way, to)
}

fn turn(face: &Blueprint, shape: &Shape, [stored, mirrored]: [f64; 2], places: &mut [Vector]) {
    for turn in &shape.turns {
        for &(index, part) in &turn.members {
            let image = face.mirror(index);
            if image == index {
                let weight = (stored + mirrored) / 2.0;
                places[index] = turned(places[index], turn.centre, turn.axis, turn.degrees * part, shape.interpolation, weight);
                continue;
            }
            places[index] = turned(places[index], turn.centre, turn.axis, turn.degrees * part, shape.interpolation, stored);
            let centre = [-turn.centre[0], turn.centre[1], turn.centre[2]];
            let degrees = if turn.axis == 0 { turn.degrees } else { -turn.degrees };
            places[image] = turned(places[image], centre, turn.axis, degrees * part, shape.interpolation, mirrored);
        }
    }
}

/// Rotates a point by a part of an angle, with the paper's formulas.
pub fn turned(place: Vector, centre: Vector, axis: usize, degrees: f64, interpolation: Interpolation, weight: f64) -> Vector {
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    let angle = degrees.to_radians();
    let start = [place[b] - centre[b], place[c] - centre[c]];
    let end = [start[0] * angle.cos() - start[1] * angle.sin(), start[1] * angle.cos() + start[0] * angle.sin()];
    let [from, to] = match interpolation {
        Interpolation::Spherical if angle.sin().abs() > 1e-6 => {
            [((1.0 - weight) * angle).sin() / angle.sin(), (weight * angle).sin() / angle.sin()]
        }
        _ => [1.0 - eased(interpolation, weight).abs(), eased(interpolation, weight)],
    };
    // With a negative weight the end is the rotation by the opposite angle.
    let end = if weight < 0.0 && interpolation != Interpolation::Spherical {
        [start[0] * angle.cos() + start[1] * angle.sin(), start[1] * angle.cos() - start[0] * angle.sin()]
    } else {
        end
    };
    let to = if interpolation == Interpolation::Spherical { to } else { to.abs() };
    let mut out = place;
    out[b] = centre[b] + from * start[0] + to * end[0];
    out[c] = centre[c] + from * start[1] + to * end[1];
    out
}
