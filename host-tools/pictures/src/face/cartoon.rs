//! Faces of filled shapes from a small text: parts of Pantin's head, enlarged and moved, with the same units, and props such as glasses, which have units of
//! their own.

use super::blueprint::{Blueprint, Curve, Drive, Opening, Shape};
use super::head::{Head, Vector, minus, plus};
use super::paper::shape;
use super::small;
use super::subject::distance;
use anyhow::{Context, Result, bail, ensure};
use pantin_face::shape::Interpolation;

/// Pantin's own cartoon face.
pub const TABLE: &str = include_str!("cartoon.txt");

/// A part of the face, enlarged about its middle, which moves.
struct Zoom {
    part: Part,
    factor: f64,
    to: [f64; 2],
}

/// A filled shape on both sides whose corners all lie in one place, so that it is nothing until a unit opens it.
struct Hidden {
    shade: u8,
    place: [f64; 2],
    corners: usize,
}

/// A unit that moves the corners of a hidden shape to places on the left. Several may open one shape.
struct Prop {
    name: String,
    hidden: usize,
    places: Vec<[f64; 2]>,
}

/// The model keeps 127ths of it: half a millimetre, so that places in whole ones are exact.
const REACH: f64 = 63.5;
/// How far before the head the points are that belong to no part of it.
const FRONT: f64 = 70.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Eye,
    Brow,
    Mouth,
}

/// The middle of each part of the head, on the left: of the eyeball, of the brow, of the lips.
const MIDDLES: [(Part, Vector); 3] =
    [(Part::Eye, [32.0, 0.0, 62.0]), (Part::Brow, [34.0, 25.0, 82.0]), (Part::Mouth, [0.0, -67.0, 88.0])];

fn part(label: &str) -> Option<Part> {
    let label = label.trim_start_matches('-');
    let begins = |starts: &[&str]| starts.iter().any(|start| label.starts_with(start));
    if begins(&["eye-", "lid-", "iris", "pupil", "crease"]) {
        Some(Part::Eye)
    } else if begins(&["brow"]) {
        Some(Part::Brow)
    } else if begins(&["lip-", "inner-", "teeth", "tongue"]) {
        Some(Part::Mouth)
    } else {
        None
    }
}

/// Builds a face from a table, given the head and its face. Fails with the line that cannot be read.
pub fn build(head: &Head, face: &Blueprint, table: &str) -> Result<Blueprint> {
    Ok(small::reduced(&whole(head, face, table)?))
}

/// Builds a face with all that is in the eyes and the mouth, whether it is drawn or not. Otherwise like [`build`].
pub fn whole(head: &Head, face: &Blueprint, table: &str) -> Result<Blueprint> {
    let (mut view, mut zooms, mut curves, mut jaw) = (None, Vec::new(), Vec::new(), 1.0);
    let mut has_jaw = false;
    let (mut hidden, mut props): (Vec<Hidden>, Vec<Prop>) = (Vec::new(), Vec::new());
    for (number, line) in table.lines().enumerate() {
        let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
        let place = || format!("line {}", number + 1);
        match words[..] {
            [] => {}
            ["view", width, top, bottom] => {
                ensure!(view.is_none(), "{}: a second view", place());
                view = Some(numbers([width, top, bottom]).with_context(place)?);
            }
            ["jaw", part] => {
                ensure!(!has_jaw, "{}: a second jaw", place());
                has_jaw = true;
                [jaw] = numbers([part]).with_context(place)?;
                ensure!((0.0..=1.0).contains(&jaw), "{}: expected a part from 0 to 1", place());
            }
            ["zoom", name, factor, aside, up] => {
                let part = match name {
                    "eye" => Part::Eye,
                    "brow" => Part::Brow,
                    "mouth" => Part::Mouth,
                    _ => bail!("{}: expected eye, brow or mouth, not {name}", place()),
                };
                ensure!(zooms.iter().all(|zoom: &Zoom| zoom.part != part), "{}: a second zoom {name}", place());
                let [factor, aside, up] = numbers([factor, aside, up]).with_context(place)?;
                ensure!((0.1..=10.0).contains(&factor), "{}: expected a factor from 0.1 to 10", place());
                zooms.push(Zoom { part, factor, to: [aside, up] });
            }
            ["hidden", shade, place_of, corners] => {
                let (shade, corners) = (shade.parse().with_context(place)?, corners.parse().with_context(place)?);
                ensure!((3..=32).contains(&corners), "{}: expected 3 to 32 corners", place());
                hidden.push(Hidden { shade, place: pair(place_of).with_context(place)?, corners });
            }
            ["prop", name, number, ref places @ ..] => {
                let number: usize = number.parse().with_context(place)?;
                let shape = number.checked_sub(1).and_then(|index| hidden.get(index));
                let shape = shape.with_context(|| format!("{}: no hidden shape {number} before it", place()))?;
                ensure!(
                    places.len() == shape.corners,
                    "{}: hidden shape {number} has {} corners, not {}",
                    place(),
                    shape.corners,
                    places.len()
                );
                ensure!(face.names.iter().all(|drive| drive.name != name), "{}: the face has a unit {name} already", place());
                let places = places.iter().map(|word| pair(word)).collect::<Result<_>>().with_context(place)?;
                props.push(Prop { name: name.into(), hidden: number - 1, places });
            }
            [kind @ ("fill" | "line"), shade, options, ref points @ ..] => {
                ensure!(["-", "paired"].contains(&options), "{}: expected paired or -, found {options}", place());
                let points = points.iter().map(|name| head.find(name)).collect::<Result<Vec<_>>>().with_context(place)?;
                ensure!(points.len() >= if kind == "fill" { 3 } else { 2 }, "{}: too few points", place());
                let filled = kind == "fill";
                let shade = shade.parse().with_context(place)?;
                let paired = options == "paired";
                curves.push(Curve { detail: 0, shade, paired, closed: filled, straight: false, small: false, filled, points });
            }
            _ => bail!("{}: expected view, jaw, zoom, fill, line, hidden or prop", place()),
        }
    }
    let [width, top, bottom] = view.context("no line `view`")?;
    ensure!(width > 0.0 && top > bottom, "view: expected a width above 0, and a top above the bottom");
    ensure!(!curves.is_empty(), "nothing is drawn");
    let unopened = (0..hidden.len()).find(|index| props.iter().all(|prop| prop.hidden != *index));
    ensure!(unopened.is_none(), "no prop opens hidden shape {}", unopened.unwrap_or_default() + 1);
    let zoomed = |index: usize| -> (f64, Vector) {
        let zoom = part(head.label(index)).and_then(|part| zooms.iter().find(|zoom| zoom.part == part));
        let Some(zoom) = zoom else { return (1.0, [0.0; 3]) };
        let middle = MIDDLES.iter().find(|entry| entry.0 == zoom.part).map_or([0.0; 3], |entry| entry.1);
        // place * factor + move
        let to = [zoom.to[0], zoom.to[1], middle[2]];
        (zoom.factor, minus(to, middle.map(|x| x * zoom.factor)))
    };
    let used = |index: usize| {
        let drawn = curves.iter().any(|curve| curve.points.iter().any(|&point| head.stored(point) == index));
        let behind = face.openings.iter().any(|entry| {
            let opening = &entry.opening;
            [&opening.upper, &opening.lower, &opening.members]
                .iter()
                .any(|part| part.iter().any(|&point| head.stored(point) == index))
        });
        drawn || behind
    };
    let stored = head.middles + head.pairs;
    let kept: Vec<usize> = (0..stored).filter(|&index| used(index)).collect();
    let middles = kept.iter().filter(|&&index| index < head.middles).count() + 2;
    let corners: usize = hidden.iter().map(|shape| shape.corners).sum();
    let pairs = kept.len() + 2 - middles + 1 + corners;
    // Two points in the middle and one on the left set what the camera shows.
    let to_new = |index: usize| -> usize {
        let own = kept.iter().position(|&kept| kept == head.stored(index)).unwrap_or(0);
        let own = if head.stored(index) < head.middles { own } else { own + 2 };
        if index >= stored { own + pairs } else { own }
    };
    let place = |index: usize| {
        let (factor, moved) = zoomed(index);
        let place = head.points[index].map(|x| x * factor);
        plus(place, moved, 1.0)
    };
    let mut points: Vec<Vector> = kept.iter().filter(|&&index| index < head.middles).map(|&index| place(index)).collect();
    points.extend([[0.0, top, FRONT], [0.0, bottom, FRONT]]);
    points.extend(kept.iter().filter(|&&index| index >= head.middles).map(|&index| place(index)));
    points.push([width, 0.0, FRONT]);
    // The corners of each hidden shape follow.
    let firsts: Vec<usize> = hidden
        .iter()
        .map(|shape| {
            let first = points.len();
            points.extend(std::iter::repeat_n([shape.place[0], shape.place[1], FRONT], shape.corners));
            first
        })
        .collect();
    let shapes = face.shapes.iter().map(|shape| {
        let keep = |index: usize| kept.contains(&head.stored(index));
        let deltas = shape
            .deltas
            .iter()
            .filter(|entry| keep(entry.0))
            .map(|&(index, way)| (to_new(index), way.map(|x| x * zoomed(index).0)));
        let turns = shape.turns.iter().map(|turn| {
            let mut turn = turn.clone();
            // A rotation about the middle of an enlarged part stays one.
            let (factor, moved) = turn.members.first().map_or((1.0, [0.0; 3]), |member| zoomed(member.0));
            let eyeball = distance(turn.centre, MIDDLES[0].1) < 1e-6;
            if eyeball {
                turn.centre = plus(turn.centre.map(|x| x * factor), moved, 1.0);
            } else if !turn.members.is_empty() {
                // The jaw keeps its axis as seen from the mouth.
                turn.centre = plus(turn.centre.map(|x| x * factor), zoomed_mouth(&zooms), 1.0);
                turn.degrees *= jaw;
            }
            turn.members =
                turn.members.iter().filter(|member| keep(member.0)).map(|&(index, part)| (to_new(index), part)).collect();
            turn
        });
        let turns = turns.filter(|turn| !turn.members.is_empty() || shape.kind == pantin_face::shape::ShapeKind::Head).collect();
        Shape { deltas: deltas.collect(), turns, ..shape.clone() }
    });
    let opening = |entry: &Opening| {
        let new = |points: &Vec<usize>| points.iter().map(|&index| to_new(index)).collect();
        let own = &entry.opening;
        let opening =
            super::head::Opening { upper: new(&own.upper), lower: new(&own.lower), members: new(&own.members), ..own.clone() };
        Opening { opening, release: entry.release }
    };
    let curves =
        curves.iter().map(|curve| Curve { points: curve.points.iter().map(|&index| to_new(index)).collect(), ..curve.clone() });
    let opened = hidden.iter().zip(&firsts).map(|(shape, &first)| Curve {
        detail: 0,
        shade: shape.shade,
        paired: true,
        closed: true,
        straight: true,
        small: false,
        filled: true,
        points: (first..first + shape.corners).collect(),
    });
    let curves = curves.chain(opened).collect();
    let (mut shapes, mut names): (Vec<Shape>, Vec<Drive>) = (shapes.collect(), face.names.clone());
    for Prop { name, hidden: number, places } in &props {
        let (from, first) = (hidden[*number].place, firsts[*number]);
        let own = shapes.iter().position(|shape| shape.name == *name).unwrap_or_else(|| {
            names.push(Drive { name: name.clone(), shape: shapes.len(), sides: [true; 2], gain: 1.0 });
            shapes.push(Shape { reach: REACH, ..shape(name, Interpolation::Linear, false) });
            shapes.len() - 1
        });
        let deltas = places.iter().enumerate().map(|(corner, to)| (first + corner, [to[0] - from[0], to[1] - from[1], 0.0]));
        shapes[own].deltas.extend(deltas);
    }
    Ok(Blueprint {
        middles,
        pairs,
        fraction_bits: face.fraction_bits,
        normals: vec![[0.0, 0.0, 1.0]; middles + pairs],
        points,
        curves,
        openings: face.openings.iter().map(opening).collect(),
        shapes,
        names,
        ..Blueprint::default()
    })
}

/// The move of the mouth.
fn zoomed_mouth(zooms: &[Zoom]) -> Vector {
    let middle = MIDDLES[2].1;
    zooms
        .iter()
        .find(|zoom| zoom.part == Part::Mouth)
        .map_or([0.0; 3], |zoom| minus([zoom.to[0], zoom.to[1], middle[2]], middle.map(|x| x * zoom.factor)))
}

/// A place in the picture: `aside,up`.
fn pair(word: &str) -> Result<[f64; 2]> {
    let (aside, up) = word.split_once(',').with_context(|| format!("{word}: expected aside,up"))?;
    numbers([aside, up])
}

fn numbers<const N: usize>(words: [&str; N]) -> Result<[f64; N]> {
    let mut out = [0.0; N];
    for (slot, word) in out.iter_mut().zip(words) {
        let number: f64 = word.parse().with_context(|| format!("{word} is no number"))?;
        ensure!(number.is_finite() && number.abs() < 200.0, "{word} is beyond 200 mm");
        *slot = number;
    }
    Ok(out)
}
