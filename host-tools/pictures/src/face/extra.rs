//! The units that the paper does not have: those of `units.txt`, and lids, gaze, jaw and head.

use super::action_units::{follow, jaw_region, shape};
use super::blueprint::{Shape, Turn};
use super::head::{Head, Vector};
use super::subject::Subject;
use anyhow::{Context, Result, bail};
use pantin_face::shape::{Interpolation, ShapeKind};

/// The table of units that consist of deltas.
pub const TABLE: &str = include_str!("units.txt");

/// The centre of the left eyeball, and the point about which the head rotates: the joint of skull and neck.
const EYEBALL: Vector = [32.0, 0.0, 62.0];
const NECK: Vector = [0.0, -42.0, -12.0];
/// Degrees at full weight of the gaze to the side and up.
pub const GAZE: [f64; 2] = [32.0, 26.0];
/// Degrees at full weight of the head's rotation about x, y, z.
pub const HEAD: [f64; 3] = [30.0, 45.0, 30.0];
/// Displacement of the jaw in mm at full weight, to the side and forwards.
const JAW: [f64; 2] = [8.0, 7.0];
/// The angle of the lid's crease as a part of the lid's angle.
const CREASE: f64 = 0.12;

/// Points of the lips between two others, with which they move where a unit does not name them.
const BETWEEN: [(&str, [&str; 2]); 4] = [
    ("lip-upper-out", ["lip-corner", "lip-upper"]),
    ("lip-lower-out", ["lip-corner", "lip-lower"]),
    ("inner-upper-in", ["inner-upper", "inner-top"]),
    ("inner-lower-in", ["inner-lower", "inner-bottom"]),
];

/// Points whose surrounding skin follows, and the radius in mm.
type Leaders = Vec<(usize, f64)>;

/// Returns all of them.
pub fn units(head: &Head) -> Vec<Shape> {
    let mut units = vec![lid(head)];
    units.extend(gaze(head));
    units.extend(head_turns());
    units.extend(jaw(head));
    // The table is part of the program, and tested.
    units.extend(table(head, TABLE).expect("units.txt"));
    units
}

/// Parses a table of units.
pub fn table(head: &Head, table: &str) -> Result<Vec<Shape>> {
    let mut units: Vec<(Shape, bool, Leaders)> = Vec::new();
    for (number, line) in table.lines().enumerate() {
        let words: Vec<&str> = line.split('#').next().unwrap_or("").split_whitespace().collect();
        match words[..] {
            [] => {}
            [name, sides] => {
                let sided = sides == "sided";
                units.push((shape(name, Interpolation::Eased, sided), sides == "whole", Vec::new()));
            }
            [point, x, y, z, ref reach @ ..] => {
                let (shape, _, leaders) = units.last_mut().context("a row before the first unit")?;
                let index = head.find(point).with_context(|| format!("line {}", number + 1))?;
                shape.deltas.push((index, [x.parse()?, y.parse()?, z.parse()?]));
                if let [reach] = reach {
                    leaders.push((index, reach.parse()?));
                }
            }
            _ => bail!("line {}: expected a unit's name and sides, or a point and its way", number + 1),
        }
    }
    Ok(units.into_iter().map(|(shape, whole, leaders)| finish(head, shape, whole, &leaders)).collect())
}

/// Adds the skin that follows, and gives each side its part of the points in the middle.
fn finish(head: &Head, mut shape: Shape, whole: bool, leaders: &[(usize, f64)]) -> Shape {
    let way = |deltas: &[(usize, Vector)], index| deltas.iter().find(|entry| entry.0 == index).map_or([0.0; 3], |entry| entry.1);
    for (between, ends) in BETWEEN {
        let find = |name: &str| head.find(name).expect("a point of the lips");
        let [a, b] = ends.map(|name| way(&shape.deltas, find(name)));
        let mean = [0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2.0);
        if mean != [0.0; 3] && !shape.deltas.iter().any(|entry| entry.0 == find(between)) {
            shape.deltas.push((find(between), mean));
        }
    }
    shape.deltas = follow(head, shape.deltas, leaders);
    if whole {
        // The table gives the left half; the right half moves in the same direction.
        shape.deltas.retain(|entry| entry.0 < head.middles + head.pairs);
        let right: Vec<_> =
            shape.deltas.iter().filter(|entry| entry.0 >= head.middles).map(|&(index, way)| (head.mirror(index), way)).collect();
        shape.deltas.extend(right);
    } else {
        shape.deltas.retain(|entry| entry.0 < head.middles + head.pairs);
        shape.deltas.iter_mut().filter(|entry| entry.0 < head.middles).for_each(|entry| entry.1 = entry.1.map(|x| x / 2.0));
    }
    shape
}

/// The upper lid rotates over the eyeball down to the lower lid. Negative weights open the eye further.
fn lid(head: &Head) -> Shape {
    let lids = [("lid-upper-in", "lid-lower-in"), ("3.1", "3.3"), ("lid-upper-out", "lid-lower-out")];
    let elevation = |place: Vector| (place[1] - EYEBALL[1]).atan2(place[2] - EYEBALL[2]);
    let way = |(upper, lower): (&str, &str)| {
        let (from, to) = (head.at(upper), head.at(lower));
        let radius = (from[1] - EYEBALL[1]).hypot(from[2] - EYEBALL[2]);
        let end = ((to[1] - EYEBALL[1]) / radius).asin();
        (head.find(upper).expect("a point of the lid"), (elevation(from) - end).to_degrees())
    };
    let ways = lids.map(way);
    let degrees = ways.iter().fold(0f64, |most, way| most.max(way.1));
    let mut members: Vec<(usize, f64)> = ways.iter().map(|&(index, angle)| (index, angle / degrees)).collect();
    members.extend(["crease-in", "crease", "crease-out"].iter().filter_map(|name| Some((head.find(name).ok()?, CREASE))));
    let turn = Turn { axis: 0, centre: EYEBALL, degrees, members };
    Shape { kind: ShapeKind::Signed, turns: vec![turn], ..shape("lid", Interpolation::Spherical, true) }
}

/// The gaze outwards and up; negative weights are inwards and down.
fn gaze(head: &Head) -> [Shape; 2] {
    let left = head.middles..head.middles + head.pairs;
    let members: Vec<(usize, f64)> = left
        .filter(|&index| head.label(index).starts_with("iris") || head.label(index).starts_with("pupil"))
        .map(|index| (index, 1.0))
        .collect();
    let turned = |name: &str, axis, degrees| {
        let turn = Turn { axis, centre: EYEBALL, degrees, members: members.clone() };
        Shape { kind: ShapeKind::Signed, turns: vec![turn], ..shape(name, Interpolation::Spherical, true) }
    };
    [turned("eye_out", 1, GAZE[0]), turned("eye_up", 0, -GAZE[1])]
}

/// Rotations of the head: up, to the left, and tilted to the left.
fn head_turns() -> [Shape; 3] {
    [("head_up", 0, -HEAD[0]), ("head_left", 1, HEAD[1]), ("head_tilt_left", 2, -HEAD[2])].map(|(name, axis, degrees)| {
        let turn = Turn { axis, centre: NECK, degrees, members: Vec::new() };
        Shape { kind: ShapeKind::Head, turns: vec![turn], ..shape(name, Interpolation::Spherical, false) }
    })
}

/// The region that unit 1 rotates, moved to the side and forwards: FACS 30 and 29, ARKit jawLeft and jawForward.
fn jaw(head: &Head) -> [Shape; 2] {
    let region = jaw_region(&Subject::of_head(head));
    // In proportion to a point's distance below the axis, because the joints do not move.
    let (axis, chin) = (head.at("2.13")[1], head.at("2.1")[1]);
    let depth = |index: usize| ((axis - head.points[index][1]) / (axis - chin) * 1.5).clamp(0.0, 1.0);
    let moved = |way: Vector| region.iter().map(|&index| (index, way.map(|x| x * depth(index)))).collect();
    let aside = Shape { deltas: moved([JAW[0], 0.0, 0.0]), ..shape("jaw_side", Interpolation::Eased, false) };
    let ahead = Shape { deltas: moved([0.0, 0.0, JAW[1]]), ..shape("jaw_forward", Interpolation::Eased, false) };
    [finish(head, aside, true, &[]), finish(head, ahead, false, &[])]
}
