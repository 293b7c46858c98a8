//! The paper's comparison: each action at 20, 50 and 80 % under the three interpolations (docs/METHOD.md 3.4).

use super::blueprint::Blueprint;
use super::draw::picture;
use super::exact::{self, about_head};
use super::head::{Vector, dot, minus, plus};
use super::sheet::{self, Cell};
use super::{Face, compact, pose};
use anyhow::Result;
use pantin_face::shape::Interpolation;
use pantin_face::{FaceView, Model};
use std::io::Write;

/// The interpolations, in the paper's order.
pub const METHODS: [(Interpolation, &str); 3] =
    [(Interpolation::Linear, "linear"), (Interpolation::Cosine, "cosine"), (Interpolation::Spherical, "spherical")];
/// The weights that the pictures show.
const WEIGHTS: [f64; 3] = [0.2, 0.5, 0.8];
/// The paper's actions, and its emotions.
pub const ACTIONS: [(&str, &str); 9] = [
    ("1", "open_mouth"),
    ("2", "smile"),
    ("3", "lower_corners"),
    ("4a", "brow_inner_lower"),
    ("4b", "brow_outer_raise"),
    ("5", "puff_cheeks"),
    ("joy", "joy"),
    ("sadness", "sadness"),
    ("surprise", "surprise"),
];
const SIZE: [usize; 2] = [144, 144];
/// Weights at which the numbers are taken.
const STEPS: usize = 100;

/// A face all of whose units go one way.
pub fn under(face: &Blueprint, interpolation: Interpolation) -> Blueprint {
    let mut face = face.clone();
    face.shapes.iter_mut().for_each(|shape| shape.interpolation = interpolation);
    face
}

/// Writes the picture: a row an action, the three weights under each interpolation.
pub fn write(out: impl Write, face: &Face) -> Result<()> {
    let models =
        METHODS.iter().map(|&(method, _)| compact::encode(&under(&face.blueprint, method))).collect::<Result<Vec<_>>>()?;
    let canvas = pantin_figure::Canvas { width: SIZE[0] as u16, height: SIZE[1] as u16 };
    let mut cells = Vec::new();
    for (label, action) in ACTIONS {
        for ((_, method), bytes) in METHODS.iter().zip(&models) {
            let model = Model::new_checked(bytes)?;
            for weight in WEIGHTS {
                let weights = pose::weights(&pose::parse(&face.blueprint, &format!("{action}={weight}"))?);
                let label = format!("{label} {method} {:.0} %", weight * 100.0);
                cells.push(Cell { label, pixels: picture(&model, &weights, canvas, FaceView::default()) });
            }
        }
    }
    sheet::write(out, &cells, METHODS.len() * WEIGHTS.len(), SIZE)
}

/// What an interpolation does to the jaw.
#[derive(Clone, Copy, Debug)]
pub struct Jaw {
    /// Its shortest length while the mouth opens, as a part of its length at rest.
    pub shortest: f64,
    /// Its longest.
    pub longest: f64,
}

/// The jaw's length, from the middle of 2.13 and 2.14 to 2.1, while the mouth opens.
pub fn jaw(face: &Face, interpolation: Interpolation) -> Result<Jaw> {
    let under = under(&face.blueprint, interpolation);
    let (left, right, chin) = (face.head.find("2.13")?, face.head.find("2.14")?, face.head.find("2.1")?);
    let length = |places: &[Vector]| {
        let joint = plus(places[left], minus(places[right], places[left]), 0.5);
        dot(minus(places[chin], joint), minus(places[chin], joint)).sqrt()
    };
    let rest = length(&under.neutral());
    let mut jaw = Jaw { shortest: 1.0, longest: 1.0 };
    for step in 0..=STEPS {
        let pairs = pose::parse(&under, &format!("open_mouth={}", step as f64 / STEPS as f64))?;
        let part = length(&exact::places(&under, &pairs)) / rest;
        jaw = Jaw { shortest: jaw.shortest.min(part), longest: jaw.longest.max(part) };
    }
    Ok(jaw)
}

/// The greatest distance, in millimetres, of a point between two interpolations at one weight, over the action, and that weight.
pub fn deviation(face: &Face, action: &str, methods: [Interpolation; 2]) -> Result<(f64, f64)> {
    let faces = methods.map(|method| under(&face.blueprint, method));
    let mut worst = (0.0, 0.0);
    for step in 0..=STEPS {
        let weight = step as f64 / STEPS as f64;
        let places = |of: &Blueprint, method| -> Result<Vec<Vector>> {
            let places = exact::places(of, &pose::parse(of, &format!("{action}={weight}"))?);
            if method != Interpolation::Spherical {
                return Ok(places);
            }
            // What turns is on its arc already; the rest goes about the head's middle.
            let end = exact::places(of, &pose::parse(of, action)?);
            let arcs = about_head(&of.neutral(), &end, weight);
            let turns = of.shapes.iter().flat_map(|shape| &shape.turns).flat_map(|turn| &turn.members);
            let turning: Vec<usize> = turns.flat_map(|&(index, _)| [index, of.mirror(index)]).collect();
            Ok((0..places.len()).map(|index| if turning.contains(&index) { places[index] } else { arcs[index] }).collect())
        };
        let [a, b] = [places(&faces[0], methods[0])?, places(&faces[1], methods[1])?];
        let farthest = a.iter().zip(&b).map(|(&a, &b)| dot(minus(a, b), minus(a, b)).sqrt()).fold(0.0, f64::max);
        if farthest > worst.0 {
            worst = (farthest, weight);
        }
    }
    Ok(worst)
}
