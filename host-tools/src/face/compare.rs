//! Compares interpolations as the paper does: each action at 20, 50 and 80 % (docs/METHOD.md 3.4).

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
/// Weights of the pictures.
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
/// Number of weights at which distances are measured.
const STEPS: usize = 100;

/// Returns the face with one interpolation for all units.
pub fn under(face: &Blueprint, interpolation: Interpolation) -> Blueprint {
    let mut face = face.clone();
    face.shapes.iter_mut().for_each(|shape| shape.interpolation = interpolation);
    face
}

/// Writes the picture as PNG: a row for each action, with the three weights under each interpolation.
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

/// The length of the jaw under an interpolation.
#[derive(Clone, Copy, Debug)]
pub struct Jaw {
    /// The shortest length while the mouth opens, relative to the neutral face.
    pub shortest: f64,
    /// The longest length, relative to the neutral face.
    pub longest: f64,
}

/// Measures the jaw's length, from the midpoint of 2.13 and 2.14 to 2.1, while the mouth opens.
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

/// Returns the largest distance in millimetres between the positions of a point under two interpolations, and its weight.
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
            // Rotating points are on their arc already; the others move about the centre of the head.
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
