//! Compares interpolations as the paper's tables 3 and 4 do: each action at 20, 50 and 80 % under three of them (docs/METHOD.md 3.4).

use super::blueprint::Blueprint;
use super::draw::{Drawn, draw};
use super::exact;
use super::head::{Vector, dot, minus, plus};
use super::sheet::{self, Cell};
use super::{Face, compact, pose};
use anyhow::Result;
use pantin_face::shape::Interpolation;
use pantin_face::{FaceView, Model, Vertex};
use std::io::Write;

/// The interpolations, in the paper's order.
pub const METHODS: [(Interpolation, &str); 3] = [
    (Interpolation::Linear, "linear"),
    (Interpolation::ImprovedLinear, "improved linear"),
    (Interpolation::Spherical, "spherical"),
];
/// Weights of the pictures.
pub const WEIGHTS: [f64; 3] = [0.2, 0.5, 0.8];
/// Number of weights at which the jaw is measured.
const STEPS: usize = 100;
/// Sixteenths of a pixel.
const PIXEL: f64 = 16.0;

/// A row of a table.
#[derive(Clone, Copy, Debug)]
pub struct Action {
    /// What the row is called.
    pub label: &'static str,
    /// The name of the unit or the emotion.
    pub name: &'static str,
    /// Degrees of the view's orbit.
    pub orbit: i16,
    /// The part of the picture that is shown: left, top; a square of [`PART`] pixels.
    pub part: [u16; 2],
}

/// Side of the part of a picture that is shown.
pub const PART: u16 = 180;

/// A table of the paper.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// Its name.
    pub title: &'static str,
    /// Its rows.
    pub actions: &'static [Action],
}

/// Width and height of the picture that is drawn.
const CANVAS: u16 = 240;

const fn action(label: &'static str, name: &'static str) -> Action {
    Action { label, name, orbit: 0, part: [30, 58] }
}

/// Tables 3 (all actions) and 4 (the mouth).
pub const TABLES: [Table; 2] = [
    Table {
        title: "table 3",
        actions: &[
            action("2 smile = joy", "joy"),
            action("2 wider smile", "wide_smile"),
            action("3 lower corners", "lower_corners"),
            action("4a inner brows", "brow_inner_lower"),
            action("4b outer brows", "brow_outer_raise"),
            action("5 puff cheeks", "puff_cheeks"),
            action("sadness = 3+4a", "sadness"),
            action("surprise = 4b+1", "surprise"),
        ],
    },
    Table {
        title: "table 4",
        actions: &[
            Action { part: [30, 60], ..action("1 open mouth", "open_mouth") },
            Action { orbit: -75, part: [54, 60], ..action("1 from aside", "open_mouth") },
        ],
    },
];

/// Returns the face with one interpolation for all units.
pub fn under(face: &Blueprint, interpolation: Interpolation) -> Blueprint {
    let mut face = face.clone();
    // Spherical units move on their arcs; the face's own units, which have none, keep theirs.
    for shape in &mut face.shapes {
        if interpolation != Interpolation::Spherical || shape.arc.is_some() || shape.deltas.is_empty() {
            shape.interpolation = interpolation;
        }
    }
    face
}

/// How far a picture is from the one under linear interpolation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// The largest distance of a vertex in millimetres.
    pub mm: f64,
    /// The largest distance of a vertex on the display in pixels.
    pub pixels: f64,
}

/// One weight of an action under one interpolation.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The weight.
    pub weight: f64,
    /// Index in [`METHODS`].
    pub method: usize,
    /// Its distance from linear interpolation.
    pub deviation: Deviation,
    /// Rows of grey values of the part that the table shows.
    pub pixels: Vec<u8>,
}

/// A row's pictures: at the start, at the weights under the three interpolations, and at the end.
pub struct Pictures {
    /// At weight 0 and 1.
    pub ends: [Vec<u8>; 2],
    /// For each weight the three interpolations.
    pub cells: Vec<Compared>,
}

/// Draws a row. All numbers are those of the vertices that the device's code draws here.
pub fn pictures(face: &Face, action: &Action) -> Result<Pictures> {
    let models =
        METHODS.iter().map(|&(method, _)| compact::encode(&under(&face.blueprint, method))).collect::<Result<Vec<_>>>()?;
    let canvas = pantin_figure::Canvas { width: CANVAS, height: CANVAS };
    let view = FaceView { orbit: action.orbit, tilt: 0 };
    let drawn = |method: usize, weight: f64| -> Result<Drawn> {
        let weights = pose::weights(&pose::parse(&face.blueprint, &format!("{}={weight}", action.name))?);
        Ok(draw(&Model::new_checked(&models[method])?, &weights, canvas, view))
    };
    let shown = |drawn: &Drawn| -> Vec<u8> {
        let [left, top, side] = [action.part[0], action.part[1], PART].map(usize::from);
        let row = |y: usize| y * usize::from(CANVAS) + left;
        (top..top + side).flat_map(|y| drawn.pixels[row(y)..row(y) + side].to_vec()).collect()
    };
    let step = f64::from(Model::new_checked(&models[0])?.step_exponent()).exp2();
    let mut cells = Vec::new();
    for weight in WEIGHTS {
        let linear = drawn(0, weight)?;
        for method in 0..METHODS.len() {
            let own = drawn(method, weight)?;
            cells.push(Compared { weight, method, deviation: deviation(&linear, &own, step), pixels: shown(&own) });
        }
    }
    Ok(Pictures { ends: [shown(&drawn(0, 0.0)?), shown(&drawn(0, 1.0)?)], cells })
}

/// The largest distances between vertices that are drawn: those that no line needs keep equal places on the display.
fn deviation(linear: &Drawn, own: &Drawn, step: f64) -> Deviation {
    let mut most = Deviation::default();
    for ((a, b), (from, to)) in linear.points.iter().zip(&own.points).zip(linear.vertices.iter().zip(&own.vertices)) {
        let pixels = f64::from(a[0] - b[0]).hypot(f64::from(a[1] - b[1])) / PIXEL;
        if pixels > 0.0 {
            let place = |vertex: &Vertex| vertex.map(|x| f64::from(x) * step);
            let gap = minus(place(from), place(to));
            most = Deviation { mm: most.mm.max(dot(gap, gap).sqrt()), pixels: most.pixels.max(pixels) };
        }
    }
    most
}

/// Writes both tables as a PNG. A row is an action at one weight: the start, linear, improved linear and its deviation, spherical and its deviation, the end.
/// Deviations show the linear picture in grey under the other.
pub fn write(out: impl Write, face: &Face) -> Result<()> {
    let mut cells = Vec::new();
    for table in &TABLES {
        for action in table.actions {
            let pictures = pictures(face, action)?;
            for three in pictures.cells.chunks(METHODS.len()) {
                let percent = format!("{:.0} %", three[0].weight * 100.0);
                let cell = |label: String, pixels: Vec<u8>| Cell { label, pixels };
                cells.push(cell(format!("{}: {}", table.title, action.label), pictures.ends[0].clone()));
                cells.push(cell(format!("linear {percent}"), three[0].pixels.clone()));
                for own in &three[1..] {
                    let overlaid = own.pixels.iter().zip(&three[0].pixels).map(|(&own, &linear)| own.max(linear / 2)).collect();
                    cells.push(cell(format!("{} {percent}", METHODS[own.method].1), own.pixels.clone()));
                    cells.push(cell(format!("{:.2} mm, {:.1} pixels", own.deviation.mm, own.deviation.pixels), overlaid));
                }
                cells.push(cell(format!("{} 100 %", action.label), pictures.ends[1].clone()));
            }
        }
    }
    let side = usize::from(PART);
    sheet::write(out, &cells, COLUMNS, [side, side])
}

/// Start, three interpolations of which two with their deviations, end.
const COLUMNS: usize = 7;

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
