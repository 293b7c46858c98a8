//! The paper's units on any mesh with feature points, as a model (docs/METHOD.md 3.1).

mod orientation;
mod units;

pub use orientation::axes;

use super::blueprint::{Blueprint, Curve, Shape};
use super::exact::turned;
use super::head::{Vector, minus, plus};
use super::outside::{fraction_bits, normals};
use super::points::Points;
use super::subject::Subject;
use anyhow::{Result, ensure};
use orientation::oriented;
use pantin_convert::import::mesh::Mesh;
use pantin_face::shape::Interpolation;
use std::collections::BTreeMap;
use units::Units;

/// A model of units on a mesh, and which units could not be built.
pub struct Built {
    /// The face.
    pub blueprint: Blueprint,
    /// Feature points that the mesh lacks, and the units that need them.
    pub missing: Missing,
}

/// Feature points, and the units that need them.
type Missing = BTreeMap<String, Vec<&'static str>>;

/// Lines that are drawn through feature points, those that the mesh has.
const LINES: [&[&str]; 14] = [
    &["8.3", "8.5", "8.10", "8.1", "8.9", "8.6", "8.4"],
    &["8.3", "8.7", "8.2", "8.8", "8.4"],
    &["2.4", "2.6", "2.2", "2.7", "2.5"],
    &["2.4", "2.8", "2.3", "2.9", "2.5"],
    &["4.1", "4.3", "4.5"],
    &["4.2", "4.4", "4.6"],
    &["3.11", "3.1", "3.7"],
    &["3.11", "3.3", "3.7"],
    &["3.8", "3.2", "3.12"],
    &["3.8", "3.4", "3.12"],
    &["9.1", "9.15", "9.2"],
    &["2.13", "2.11", "2.1", "2.12", "2.14"],
    // The cheeks, which unit 5 puffs: seen from the front nothing else tells.
    &["5.3", "5.1", "2.13"],
    &["5.4", "5.2", "2.14"],
];

/// Builds units 1 to 5 on a mesh. A unit whose points are missing is left out. Fails if none can be built, or if the points contradict each other.
pub fn build(mesh: &Mesh, points: &Points) -> Result<Built> {
    let count = mesh.points.len();
    for (name, &vertex) in points {
        ensure!(vertex < count, "feature point {name}: the mesh has {count} vertices, and no vertex {vertex}");
    }
    let axes = axes(mesh, points)?;
    let in_axes = |place: &Vector| axes.map(|(axis, sign)| place[axis] * sign);
    let places: Vec<Vector> = mesh.points.iter().map(in_axes).collect();
    let subject = Subject::new(places.clone(), &mesh.triangles, points.clone());
    let (mut units, missing) = Units::of(&subject);
    ensure!(!units.shapes.is_empty(), "no unit can be built: the mesh lacks {}", list(&missing));
    units.add_targets(mesh, in_axes);
    let (shapes, names) = units.in_order();
    let triangles = oriented(&places, &mesh.triangles);
    let mut own = Mesh { points: places, triangles, ..mesh.clone() };
    own.points.push(room(&own, &shapes));
    let blueprint = Blueprint {
        middles: count + 1,
        pairs: 0,
        fraction_bits: bits(&own, &shapes),
        normals: normals(&own),
        outline: own.triangles.len(),
        triangles: own.triangles,
        points: own.points,
        curves: curves(&subject),
        shapes,
        names,
        ..Blueprint::default()
    };
    Ok(Built { blueprint, missing })
}

/// The missing points and the units that need them, as a sentence names them.
pub fn list(missing: &Missing) -> String {
    let one = |(point, units): (&String, &Vec<&str>)| format!("{point} ({})", units.join(", "));
    missing.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// A point of no triangle as low as any unit moves a point: the device's camera keeps room for it.
fn room(mesh: &Mesh, shapes: &[Shape]) -> Vector {
    let mut low = mesh.points.iter().fold([0.0, f64::MAX, 0.0], |low, &place| if place[1] < low[1] { place } else { low });
    for (turn, &(index, part)) in
        shapes.iter().flat_map(|shape| &shape.turns).flat_map(|turn| turn.members.iter().map(move |member| (turn, member)))
    {
        let place = turned(mesh.points[index], turn.centre, turn.axis, turn.degrees * part, Interpolation::Spherical, 1.0);
        low = if place[1] < low[1] { place } else { low };
    }
    [0.0, low[1], low[2]]
}

fn curves(subject: &Subject) -> Vec<Curve> {
    let lines = LINES.iter().map(|names| names.iter().filter_map(|name| subject.index(name)).collect::<Vec<_>>());
    let line = |points| Curve {
        detail: 0,
        shade: 230,
        paired: false,
        closed: false,
        straight: true,
        small: false,
        filled: false,
        points,
    };
    lines.filter(|points| points.len() >= 2).map(line).collect()
}

/// The finest step with which the sum of all units fits 16 bits.
fn bits(mesh: &Mesh, shapes: &[Shape]) -> i8 {
    let ways = |shape: &Shape| {
        let mut ways = vec![[0.0; 3]; mesh.points.len()];
        for &(index, way) in &shape.deltas {
            ways[index] = way;
        }
        // A rotation takes a point at most twice its distance from the axis away.
        for (turn, &(index, _)) in shape.turns.iter().flat_map(|turn| turn.members.iter().map(move |member| (turn, member))) {
            ways[index] = plus(ways[index], minus(mesh.points[index], turn.centre), 2.0);
        }
        ways
    };
    fraction_bits(&Mesh { targets: shapes.iter().map(ways).collect(), ..mesh.clone() })
}
