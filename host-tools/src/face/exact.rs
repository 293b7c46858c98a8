//! Evaluates a blueprint in full precision: the reference for the device's arithmetic.

use super::blueprint::{Blueprint, Shape};
use super::head::{Vector, dot, minus, plus};
use pantin_face::shape::{Interpolation, ShapeKind};
use std::f64::consts::PI;

/// The centre of the head. In the comparison of interpolations, points without an axis of rotation move about it.
const CENTRE: Vector = [0.0, -14.0, 4.0];

/// The part of its displacement that a point has moved at a weight.
pub fn eased(interpolation: Interpolation, weight: f64) -> f64 {
    match interpolation {
        Interpolation::Cosine => weight.signum() * (1.0 - (PI * weight).cos()) / 2.0,
        _ => weight,
    }
}

/// Returns the positions of all points for a pair of weights per shape, -1 to 1. Openings do not clip their members, and the head does not
/// rotate.
pub fn places(face: &Blueprint, weights: &[[f64; 2]]) -> Vec<Vector> {
    let mut places = face.neutral();
    let moved = |shape: &Shape, pair: [f64; 2]| shape.kind != ShapeKind::Head && pair != [0.0; 2];
    let whole =
        |shape: &Shape, pair: [f64; 2]| if shape.kind == ShapeKind::Unsigned { pair.map(|weight| weight.max(0.0)) } else { pair };
    for (shape, &pair) in face.shapes.iter().zip(weights).filter(|(shape, pair)| moved(shape, **pair)) {
        let [stored, mirrored] = whole(shape, pair).map(|weight| eased(shape.interpolation, weight));
        for &(index, way) in &shape.deltas {
            places[index] = plus(places[index], way, stored);
            let image = face.mirror(index);
            places[image] = plus(places[image], [-way[0], way[1], way[2]], mirrored);
        }
    }
    for (shape, &pair) in face.shapes.iter().zip(weights).filter(|(shape, pair)| moved(shape, **pair)) {
        turn(face, shape, whole(shape, pair), &mut places);
    }
    places
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

/// Spherical interpolation of points about the centre of the head, each by the angle between its start and its end.
pub fn about_head(from: &[Vector], to: &[Vector], weight: f64) -> Vec<Vector> {
    let mix = |(&from, &to): (&Vector, &Vector)| {
        let (s, e) = (minus(from, CENTRE), minus(to, CENTRE));
        let angle = (dot(s, e) / (dot(s, s) * dot(e, e)).sqrt()).clamp(-1.0, 1.0).acos();
        if angle < 1e-6 {
            return plus(from, minus(to, from), weight);
        }
        let [a, b] = [((1.0 - weight) * angle).sin() / angle.sin(), (weight * angle).sin() / angle.sin()];
        plus(plus(CENTRE, s, a), e, b)
    };
    from.iter().zip(to).map(mix).collect()
}
