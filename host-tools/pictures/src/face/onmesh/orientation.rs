//! Which way a mesh looks, and which way its triangles do.

use crate::face::head::{Vector, cross, dot, minus, plus};
use crate::face::points::Points;
use anyhow::{Context, Result, ensure};
use pantin_convert::import::mesh::Mesh;
use std::collections::HashMap;

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

/// The triangles with one sense of rotation in each connected part, anticlockwise seen from outside: files of others have both.
pub(super) fn oriented(points: &[Vector], triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
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
