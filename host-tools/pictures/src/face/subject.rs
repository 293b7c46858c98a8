//! A mesh with feature points: what the paper's rules are applied to, Pantin's own head or any other (docs/METHOD.md 3.1).

use super::head::{Head, Vector, dot, minus, plus};
use std::collections::HashMap;
use std::f64::consts::PI;

/// A mesh in the axes of the rules: x points to the face's own left, y up, z ahead of it.
pub struct Subject {
    /// Positions of all points, in any unit of length.
    pub points: Vec<Vector>,
    /// Whether a point is skin or lips: it follows what moves near it. Eyes, lids, nose, teeth and ears do not.
    pub soft: Vec<bool>,
    /// Whether a point rotates with the jaw if it lies inside the curve of unit 1. The upper teeth do not.
    pub hangs: Vec<bool>,
    /// Whether a point is part of the lower lip: where the lips touch, the rules cannot tell it from the upper one by its position.
    pub lower: Vec<bool>,
    features: HashMap<String, usize>,
}

/// The outer and the inner contour of the lips by feature points, from the left corner to the middle.
pub const LIPS: [&[&str]; 4] =
    [&["8.3", "8.5", "8.10", "8.1"], &["8.3", "8.7", "8.2"], &["2.4", "2.6", "2.2"], &["2.4", "2.8", "2.3"]];
/// Points with names of these do not follow skin, if they are feature points: lids and eyes, the nose, teeth and tongue, ears.
const STIFF: [&str; 4] = ["3.", "9.", "6.", "10."];
/// A curve of the lips is this thick, as a part of the mouth's width: points nearer to it are part of a lip.
const LIP: f64 = 0.06;

impl Subject {
    /// A mesh with feature points by MPEG-4 number.
    pub fn new(points: Vec<Vector>, triangles: &[[usize; 3]], features: HashMap<String, usize>) -> Subject {
        let lower = below_neighbours(&points, triangles);
        let mut soft = vec![true; points.len()];
        for (name, &index) in &features {
            soft[index] = !STIFF.iter().any(|group| name.starts_with(group));
        }
        let mut hangs = vec![true; points.len()];
        features.get("9.10").into_iter().for_each(|&upper_teeth| hangs[upper_teeth] = false);
        let mut subject = Subject { points, soft, hangs, lower, features };
        subject.stiffen_eyes_and_nose();
        subject
    }

    /// Pantin's own head.
    pub fn of_head(head: &Head) -> Subject {
        let all = 0..head.points.len();
        let lids = |index: usize| {
            let edges = |index: usize| head.openings.iter().any(|eye| eye.paired && eye.edges(index));
            edges(index) || edges(head.mirror(index))
        };
        let nose = |index: usize| {
            let label = head.label(index).trim_start_matches('-');
            label.starts_with("wing") || label.starts_with("no") || label.starts_with("tip") || label == "subnasale"
        };
        let hangs = |index: usize| head.label(index).contains("tongue") || head.label(index).contains("teeth-lower");
        let lower = |index: usize| {
            ["inner-lower", "inner-bottom", "teeth-lower", "tongue"].iter().any(|part| head.label(index).contains(part))
        };
        Subject {
            points: head.points.clone(),
            soft: all.clone().map(|index| head.is_skin(index) && !lids(index) && !nose(index)).collect(),
            hangs: all.clone().map(|index| head.is_skin(index) || hangs(index)).collect(),
            lower: all.map(lower).collect(),
            features: head.features().map(|(name, index)| (name.to_string(), index)).collect(),
        }
    }

    /// Points inside the eyes' corners and on the nose are not skin that follows.
    fn stiffen_eyes_and_nose(&mut self) {
        let boxes = [["3.11", "3.7", "3.13", "3.3"], ["3.8", "3.12", "3.14", "3.4"], ["9.1", "9.2", "9.12", "9.15"]];
        for corners in boxes {
            let Some(corners) = corners.iter().map(|name| self.feature(name)).collect::<Option<Vec<_>>>() else { continue };
            let range = |axis: usize| {
                let along = corners.iter().map(|place| place[axis]);
                (along.clone().fold(f64::MAX, f64::min), along.fold(f64::MIN, f64::max))
            };
            let (across, up) = (range(0), range(1));
            let inside = |place: &Vector| (across.0..=across.1).contains(&place[0]) && (up.0..=up.1).contains(&place[1]);
            for (soft, place) in self.soft.iter_mut().zip(&self.points) {
                *soft &= !inside(place);
            }
        }
    }

    /// The index of a feature point.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.features.get(name).copied()
    }

    /// The position of a feature point, if the mesh has it.
    pub fn feature(&self, name: &str) -> Option<Vector> {
        self.index(name).map(|index| self.points[index])
    }

    /// The position of a feature point. Panics if it is missing: [`missing`](super::action_units::missing) finds out first.
    pub fn at(&self, name: &str) -> Vector {
        self.feature(name).unwrap_or_else(|| panic!("the mesh has no feature point {name}"))
    }

    /// The width of the mouth, from which the rules derive how far skin follows.
    pub fn mouth_width(&self) -> f64 {
        distance(self.at("8.3"), self.at("8.4"))
    }

    /// Whether a point lies on the edge of the opening between the lips.
    pub fn on_mouth_line(&self, index: usize) -> bool {
        let near = LIP * self.mouth_width();
        let [x, y, _] = self.points[index];
        [&["2.4", "2.8", "2.3"], &["2.5", "2.9", "2.3"]].iter().any(|names| {
            let line = names.map(|name| self.at(name));
            let within = |ends: &[Vector]| {
                let (from, to) = ([ends[0][0], ends[0][1], 0.0], [ends[1][0], ends[1][1], 0.0]);
                distance([x, y, 0.0], nearest([x, y, 0.0], from, to).0) < near / 2.0
            };
            line.windows(2).any(within)
        })
    }

    /// Whether a point is part of the lips: near one of their contours, or between the outer ones.
    pub fn is_lip(&self, index: usize) -> bool {
        let near = LIP * self.mouth_width();
        let point = self.points[index];
        LIPS.iter().any(|names| {
            let line: Option<Vec<Vector>> = names.iter().map(|name| self.feature(name)).collect();
            line.is_some_and(|line| {
                let image = [point[0].abs(), point[1], point[2]];
                line.windows(2).any(|ends| distance(image, nearest(image, ends[0], ends[1]).0) < near)
            })
        })
    }
}

/// Whether the points that share triangles with a point lie below it on average: true for the upper edge of a lower lip.
fn below_neighbours(points: &[Vector], triangles: &[[usize; 3]]) -> Vec<bool> {
    let mut sums = vec![(0.0, 0usize); points.len()];
    for triangle in triangles {
        for &corner in triangle {
            let others = triangle.iter().filter(|&&other| other != corner);
            for &other in others {
                sums[corner].0 += points[other][1] - points[corner][1];
                sums[corner].1 += 1;
            }
        }
    }
    sums.into_iter().map(|(sum, _)| sum < 0.0).collect()
}

/// A line through points that move: position and displacement of each.
pub type Lead = Vec<(Vector, Vector)>;

/// The displacement of a point near lines that move: that of their nearest points, weighted by their distances, times the cosine law of the
/// least distance. 0 from `reach` on.
pub fn led(point: Vector, leads: &[Lead], reach: f64) -> Vector {
    let (mut sum, mut weights, mut least) = ([0.0; 3], 0.0, f64::MAX);
    for lead in leads {
        let of_segment = |ends: &[(Vector, Vector)]| {
            let (place, part) = nearest(point, ends[0].0, ends[1].0);
            (distance(point, place), plus(ends[0].1, minus(ends[1].1, ends[0].1), part))
        };
        let Some((gap, way)) = lead.windows(2).map(of_segment).min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let weight = 1.0 / (gap * gap + 1e-9 * reach * reach);
        sum = plus(sum, way, weight);
        weights += weight;
        least = least.min(gap);
    }
    if weights == 0.0 { sum } else { sum.map(|x| x / weights * cosine_law(least, reach)) }
}

/// The cosine law: 1 at distance 0, 0 from `reach` on.
pub fn cosine_law(distance: f64, reach: f64) -> f64 {
    if distance >= reach { 0.0 } else { (1.0 + (PI * distance / reach).cos()) / 2.0 }
}

/// The distance of two points.
pub fn distance(a: Vector, b: Vector) -> f64 {
    dot(minus(a, b), minus(a, b)).sqrt()
}

/// The point of a segment that is nearest to a point, and its part of the way.
pub fn nearest(point: Vector, from: Vector, to: Vector) -> (Vector, f64) {
    let (way, gap) = (minus(to, from), minus(point, from));
    let part = (dot(gap, way) / dot(way, way).max(1e-12)).clamp(0.0, 1.0);
    (plus(from, way, part), part)
}
