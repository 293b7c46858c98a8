//! The paper's units on any mesh with feature points, as a model (docs/METHOD.md 3.1).

use super::blueprint::{Blueprint, Curve, Drive, Shape};
use super::exact::turned;
use super::head::{Vector, cross, dot, minus, plus};
use super::names;
use super::outside::{fraction_bits, normals};
use super::paper::{Effect, RULES, arc, effect, missing, shape};
use super::points::Points;
use super::subject::Subject;
use anyhow::{Context, Result, ensure};
use pantin_convert::import::mesh::Mesh;
use pantin_face::shape::Interpolation;
use std::collections::{BTreeMap, HashMap};

/// A model of units on a mesh, and which units could not be built.
pub struct Built {
    /// The face.
    pub blueprint: Blueprint,
    /// Feature points that the mesh lacks, and the units that need them.
    pub missing: BTreeMap<String, Vec<&'static str>>,
}

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
    let mut lacking: BTreeMap<String, Vec<&'static str>> = BTreeMap::new();
    let (mut shapes, mut names) = (Vec::new(), Vec::new());
    for rule in &RULES {
        let lacks = missing(&subject, rule);
        for point in &lacks {
            lacking.entry(point.to_string()).or_default().push(rule.name);
        }
        if !lacks.is_empty() {
            continue;
        }
        let mut add = |entry: Shape, driven: &[String], sides| {
            names.extend(driven.iter().map(|name| Drive { name: name.clone(), shape: shapes.len(), sides, gain: 1.0 }));
            shapes.push(entry);
        };
        match effect(&subject, rule) {
            Effect::Rotated { centre, degrees, members } => {
                let turn = super::blueprint::Turn { axis: 0, centre, degrees, members };
                let shape = Shape { turns: vec![turn], ..shape(rule.name, Interpolation::Spherical, false) };
                add(shape, &[rule.name.into()], [true, true]);
            }
            Effect::Moved(ways) => {
                let middle = subject.at("8.3")[0].midpoint(subject.at("8.4")[0]);
                let near = 1e-3 * subject.mouth_width();
                for (side, suffix) in [(1.0, "left"), (-1.0, "right")] {
                    // Points in the middle follow both sides, each by half.
                    let part = |index: usize| match (subject.points[index][0] - middle) * side {
                        x if x > near => 1.0,
                        x if x < -near => 0.0,
                        _ => 0.5,
                    };
                    let deltas = ways.iter().map(|&(index, way)| (index, way.map(|x| x * part(index))));
                    let deltas = deltas.filter(|(_, way)| *way != [0.0; 3]).collect();
                    let name = format!("{}_{suffix}", rule.name);
                    let arc = Some(arc(&subject, rule));
                    let shape = Shape { deltas, arc, ..shape(&name, Interpolation::ImprovedLinear, false) };
                    add(shape, &[rule.name.into(), name], [true, false]);
                }
            }
        }
    }
    ensure!(!shapes.is_empty(), "no unit can be built: the mesh lacks {}", list(&lacking));
    shapes.extend(
        mesh.targets.iter().zip(&mesh.names).filter(|(_, name)| !names.iter().any(|drive: &Drive| drive.name == **name)).map(
            |(ways, name)| {
                let ways: Vec<Vector> = ways.iter().map(in_axes).collect();
                super::outside::of_target(&ways, name)
            },
        ),
    );
    for (index, shape) in shapes.iter().enumerate() {
        if !names.iter().any(|drive| drive.shape == index) {
            names.push(Drive { name: shape.name.clone(), shape: index, sides: [true, false], gain: 1.0 });
        }
    }
    // Rotations apply after all deltas.
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    order.sort_by_key(|&index| !shapes[index].turns.is_empty());
    names.iter_mut().for_each(|drive| drive.shape = order.iter().position(|&index| index == drive.shape).unwrap_or(0));
    let shapes: Vec<Shape> = order.iter().map(|&index| shapes[index].clone()).collect();
    names.extend(names::sums(&names));
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
    Ok(Built { blueprint, missing: lacking })
}

/// The missing points and the units that need them, as a sentence names them.
pub fn list(missing: &BTreeMap<String, Vec<&'static str>>) -> String {
    let one = |(point, units): (&String, &Vec<&str>)| format!("{point} ({})", units.join(", "));
    missing.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// For each axis of the rules the axis of the mesh that is nearest, and its sign: left by pairs of points, up from the chin or the lower lip.
pub fn axes(mesh: &Mesh, points: &Points) -> Result<[(usize, f64); 3]> {
    let at = |name: &str| points.get(name).map(|&vertex| mesh.points[vertex]);
    let way = |pairs: &[[&str; 2]], what: &str| {
        let found = pairs.iter().find_map(|[from, to]| Some(minus(at(to)?, at(from)?)));
        let way: Vector = found.with_context(|| format!("no feature points show which way is {what}"))?;
        let axis = (0..3).max_by(|&a, &b| way[a].abs().total_cmp(&way[b].abs())).unwrap_or(0);
        anyhow::Ok((axis, way[axis].signum()))
    };
    let left = way(&[["8.4", "8.3"], ["2.5", "2.4"], ["5.2", "5.1"], ["4.4", "4.3"]], "left")?;
    let up = way(&[["2.1", "4.3"], ["2.1", "8.1"], ["8.2", "4.3"], ["8.2", "8.1"]], "up")?;
    ensure!(left.0 != up.0, "the feature points of the left and the right side lie above each other");
    let ahead = 3 - left.0 - up.0;
    // Left, up and ahead are a right-handed system.
    let even = (left.0 + 1) % 3 == up.0;
    let sign = left.1 * up.1 * if even { 1.0 } else { -1.0 };
    if let (Some(lip), Some(jaw)) = (at("8.1").or(at("2.2")), at("2.13")) {
        ensure!(
            (lip[ahead] - jaw[ahead]) * sign > 0.0,
            "the feature points of the left and the right side are swapped: the lips lie behind the jaw's corners"
        );
    }
    Ok([left, up, (ahead, sign)])
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

/// The triangles with one sense of rotation in each connected part, anticlockwise seen from outside: files of others have both.
fn oriented(points: &[Vector], triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let mut out = triangles.to_vec();
    let mut edges: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
    let sides = |[a, b, c]: [usize; 3]| [[a, b], [b, c], [c, a]];
    for (index, &triangle) in triangles.iter().enumerate() {
        for [a, b] in sides(triangle) {
            edges.entry([a.min(b), a.max(b)]).or_default().push(index);
        }
    }
    let middle = points.iter().fold([0.0; 3], |sum, &place| plus(sum, place, 1.0 / points.len() as f64));
    let mut seen = vec![false; triangles.len()];
    for first in 0..triangles.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut part = vec![first];
        let mut next = 0;
        while let Some(&index) = part.get(next) {
            next += 1;
            for [a, b] in sides(out[index]) {
                for &other in &edges[&[a.min(b), a.max(b)]] {
                    if !std::mem::replace(&mut seen[other], true) {
                        // Neighbours run through their common edge in opposite directions.
                        if sides(out[other]).contains(&[a, b]) {
                            out[other].swap(1, 2);
                        }
                        part.push(other);
                    }
                }
            }
        }
        let outwards = |&index: &usize| {
            let [a, b, c] = out[index].map(|corner| points[corner]);
            dot(cross(minus(b, a), minus(c, a)), minus(a, middle))
        };
        if part.iter().map(outwards).sum::<f64>() < 0.0 {
            part.iter().for_each(|&index| out[index].swap(1, 2));
        }
    }
    out
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
