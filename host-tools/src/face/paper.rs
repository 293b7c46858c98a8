//! The paper's action units, after its algorithms on the feature points (docs/METHOD.md 3.1).

use super::blueprint::{Shape, Turn};
use super::head::{Head, Vector, dot, minus, plus};
use pantin_face::shape::{Interpolation, ShapeKind};
use std::f64::consts::PI;

/// The increase of the distance between the cheeks by unit 5.
pub const PUFF: f64 = 0.2;
/// Radius in mm in which skin follows a corner of the lips or an end of a brow: the paper says that it follows, not how far.
const FOLLOWS: f64 = 24.0;
/// Distance in mm below the chin where the region that unit 1 rotates ends: the chin's underside rotates too, the throat does not.
const BELOW_CHIN: f64 = 2.0;

/// Returns units 1, 2, 3, 4a, 4b and 5.
pub fn units(head: &Head) -> Vec<Shape> {
    vec![open_mouth(head), smile(head), lower_corners(head), brow_inner_lower(head), brow_outer_raise(head), puff_cheeks(head)]
}

/// The cosine law: 1 at distance 0, 0 from `reach` on.
pub fn cosine_law(distance: f64, reach: f64) -> f64 {
    if distance >= reach { 0.0 } else { (1.0 + (PI * distance / reach).cos()) / 2.0 }
}

/// The angle of unit 1 in degrees: it rotates 2.3 onto the line from the midpoint of 2.13 and 2.14 to 2.1.
pub fn opening_angle(head: &Head) -> f64 {
    let axis = head.at("2.13");
    let below = |name: &str| (head.at(name)[1] - axis[1]).atan2(head.at(name)[2] - axis[2]);
    (below("2.3") - below("2.1")).to_degrees()
}

/// The points inside the curve 2.14-5.2-8.4-2.5-2.9-2.3-2.8-2.4-8.3-5.1-2.13, seen from the front, and the lower lip on the curve. The curve
/// is closed below the chin. Points behind the axis do not belong to the region.
pub fn jaw_region(head: &Head) -> Vec<usize> {
    let curve = ["2.14", "5.2", "8.4", "2.5", "2.9", "2.3", "2.8", "2.4", "8.3", "5.1", "2.13"];
    let floor = head.at("2.1")[1] - BELOW_CHIN;
    let axis = head.at("2.13");
    let mut polygon: Vec<[f64; 2]> = curve.iter().map(|name| [head.at(name)[0], head.at(name)[1]]).collect();
    polygon.extend([[axis[0], floor], [-axis[0], floor]]);
    let named = |names: &[&str]| names.iter().filter_map(|name| head.find(name).ok()).collect::<Vec<_>>();
    let (on_curve, lip) = (named(&curve), named(&["2.9", "2.3", "2.8"]));
    let inside = |&index: &usize| {
        let [x, y, z] = head.points[index];
        // Inside the mouth the tongue rotates with the jaw, the upper teeth do not.
        let hangs = head.is_skin(index) || head.label(index).contains("tongue");
        hangs && z > axis[2] && (lip.contains(&index) || (!on_curve.contains(&index) && encloses(&polygon, [x, y])))
    };
    (0..head.points.len()).filter(inside).collect()
}

fn encloses(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let edges = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0]);
    crossed.count() % 2 == 1
}

fn open_mouth(head: &Head) -> Shape {
    let left = |index: &usize| *index < head.middles + head.pairs;
    let members = jaw_region(head).into_iter().filter(left).map(|index| (index, 1.0)).collect();
    let turn = Turn { axis: 0, centre: head.at("2.13"), degrees: opening_angle(head), members };
    Shape { turns: vec![turn], ..shape("open_mouth", Interpolation::Spherical, false) }
}

/// Returns a shape without deltas and rotations.
pub fn shape(name: &str, interpolation: Interpolation, sided: bool) -> Shape {
    Shape { name: name.into(), interpolation, kind: ShapeKind::Unsigned, sided, deltas: Vec::new(), turns: Vec::new() }
}

fn smile(head: &Head) -> Shape {
    let outer = head.at("8.10")[1];
    let inner = head.at("8.5")[1];
    let mut ways = to_height(head, &["8.3", "8.5", "8.10"], outer);
    ways.extend(to_height(head, &["2.4", "2.8"], inner));
    // The upper inner contour moves with the lower one, so that it stays above it at every weight.
    ways.push(along(head, "2.6", "2.8", &ways));
    following("smile", head, ways, &["8.3"])
}

fn lower_corners(head: &Head) -> Shape {
    let outer = head.at("8.2")[1];
    let inner = head.at("2.8")[1];
    let mut ways = to_height(head, &["8.3", "8.7"], outer);
    ways.extend(to_height(head, &["2.4", "2.6"], inner));
    ways.push(along(head, "2.8", "2.6", &ways));
    following("lower_corners", head, ways, &["8.3"])
}

/// Displacements of points to a height.
fn to_height(head: &Head, names: &[&str], height: f64) -> Vec<(usize, Vector)> {
    let way = |name: &&str| (head.find(name).expect("a feature point"), [0.0, height - head.at(name)[1], 0.0]);
    names.iter().map(way).collect()
}

/// The displacement of a point that moves with another.
fn along(head: &Head, name: &str, other: &str, ways: &[(usize, Vector)]) -> (usize, Vector) {
    let find = |name| head.find(name).expect("a feature point");
    let way = ways.iter().find(|(index, _)| *index == find(other)).map_or([0.0; 3], |entry| entry.1);
    (find(name), way)
}

/// Returns a sided shape of the displacements `ways`; skin around the points `led` follows them by the cosine law.
fn following(name: &str, head: &Head, ways: Vec<(usize, Vector)>, led: &[&str]) -> Shape {
    let leaders: Vec<(usize, f64)> = led.iter().map(|name| (head.find(name).expect("a feature point"), FOLLOWS)).collect();
    let mut deltas = follow(head, ways, &leaders);
    // Points in the middle follow both sides, each by half.
    deltas.iter_mut().filter(|entry| entry.0 < head.middles).for_each(|entry| entry.1 = entry.1.map(|x| x / 2.0));
    Shape { deltas, ..shape(name, Interpolation::Cosine, true) }
}

/// Adds the skin within each leader's radius, except points that have a displacement already and the edges of lips and lids.
pub fn follow(head: &Head, ways: Vec<(usize, Vector)>, leaders: &[(usize, f64)]) -> Vec<(usize, Vector)> {
    let bound = |index: usize| {
        let edges = head
            .openings
            .iter()
            .any(|opening| [index, head.mirror(index)].iter().any(|i| opening.upper.contains(i) || opening.lower.contains(i)));
        let lips = head.curves.iter().filter(|curve| curve.name.starts_with("lip")).any(|curve| curve.points.contains(&index));
        edges || lips || !head.is_skin(index)
    };
    let mut all = ways.clone();
    for index in 0..head.points.len() {
        if bound(index) || ways.iter().any(|entry| entry.0 == index) {
            continue;
        }
        let pull = |&(leader, reach): &(usize, f64)| {
            let gap = minus(head.points[index], head.points[leader]);
            let way = ways.iter().find(|entry| entry.0 == leader).map_or([0.0; 3], |entry| entry.1);
            (cosine_law(dot(gap, gap).sqrt(), reach), way)
        };
        let strongest = leaders.iter().map(pull).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((part, way)) = strongest.filter(|entry| entry.0 > 0.02) {
            all.push((index, way.map(|x| x * part)));
        }
    }
    all
}

/// The distance by which 4b raises the outer end of a brow: to the height of its top.
fn raise(head: &Head) -> f64 {
    head.at("4.3")[1] - head.at("4.5")[1]
}

fn brow_inner_lower(head: &Head) -> Shape {
    let down = -raise(head);
    let part = |name: &str, part: f64| (head.find(name).expect("a point of the brow"), [0.0, down * part, 0.0]);
    let ways =
        vec![part("4.1", 1.0), part("brow-in-low", 1.0), part("brow-in-top", 0.6), part("brow-low", 0.55), part("brow-top", 0.1)];
    following("brow_inner_lower", head, ways, &["4.1"])
}

fn brow_outer_raise(head: &Head) -> Shape {
    let up = raise(head);
    // Between its top and its end a brow rises in proportion to the distance from the top.
    let (top, end) = (head.at("4.3")[0], head.at("4.5")[0]);
    let part = |name: &str| {
        let index = head.find(name).expect("a point of the brow");
        (index, [0.0, up * ((head.points[index][0] - top) / (end - top)).clamp(0.0, 1.0), 0.0])
    };
    following("brow_outer_raise", head, vec![part("4.5"), part("brow-top-out"), part("brow-low-out")], &["4.5"])
}

/// The radius around 5.1 of the cheek that unit 5 puffs: the distance of the curve 2.11-2.13 along the jaw.
pub fn puff_reach(head: &Head) -> f64 {
    let curve = ["2.11", "jaw", "2.13"].map(|name| head.at(name));
    curve.windows(2).map(|ends| distance(head.at("5.1"), ends[0], ends[1])).fold(f64::MAX, f64::min)
}

fn distance(point: Vector, from: Vector, to: Vector) -> f64 {
    let (way, gap) = (minus(to, from), minus(point, from));
    let nearest = plus(from, way, (dot(gap, way) / dot(way, way)).clamp(0.0, 1.0));
    let gap = minus(point, nearest);
    dot(gap, gap).sqrt()
}

fn puff_cheeks(head: &Head) -> Shape {
    let (cheek, reach) = (head.at("5.1"), puff_reach(head));
    let centre = plus(cheek, minus(head.at("5.2"), cheek), 0.5);
    let way = |index: usize| {
        let gap = minus(head.points[index], cheek);
        let part = cosine_law(dot(gap, gap).sqrt(), reach);
        (index, minus(head.points[index], centre).map(|x| x * PUFF * part))
    };
    let moved = (0..head.points.len()).filter(|&index| head.is_skin(index)).map(way).filter(|(_, way)| *way != [0.0; 3]);
    Shape { deltas: moved.collect(), ..shape("puff_cheeks", Interpolation::Cosine, true) }
}
