//! What small displays need of a face: its pictures below 96 pixels, with fewer vertices.

use super::blueprint::{Blueprint, Curve, Opening, Shape, Turn};
use pantin_face::shape::ShapeKind;
use std::collections::BTreeSet;

/// Leaves out what a face of fewer than 96 pixels does not show: curves of larger displays, the mesh, and points that no line, edge of an opening or
/// triangle of the outline uses. The pictures of such a display stay the same, pixel by pixel.
pub fn small(face: &Blueprint) -> Blueprint {
    let curves = face.curves.iter().filter(|curve| curve.detail == 0).cloned().collect();
    reduced(&Blueprint { curves, triangles: face.triangles[..face.outline].to_vec(), ..face.clone() })
}

/// Leaves out points that nothing uses. Pictures of all sizes stay the same.
pub fn reduced(face: &Blueprint) -> Blueprint {
    let stored = face.middles + face.pairs;
    let stored_of = |index: usize| if index < stored { index } else { index - face.pairs };
    let drawn: BTreeSet<usize> = face.curves.iter().flat_map(|curve| &curve.points).map(|&index| stored_of(index)).collect();
    let mut used = drawn.clone();
    used.extend(face.triangles.iter().flatten());
    let openings =
        face.openings.iter().filter(|entry| entry.opening.members.iter().any(|&index| drawn.contains(&stored_of(index))));
    let mut openings: Vec<Opening> = openings.cloned().collect();
    for Opening { opening, .. } in &mut openings {
        opening.members.retain(|&index| drawn.contains(&stored_of(index)));
        used.extend(opening.upper.iter().chain(&opening.lower).map(|&index| stored_of(index)));
    }
    used.extend(extremes(face));
    let kept: Vec<usize> = used.into_iter().collect();
    let middles = kept.partition_point(|&index| index < face.middles);
    let pairs = kept.len() - middles;
    let is_kept = |index: usize| kept.binary_search(&stored_of(index)).is_ok();
    let moved = |index: usize| {
        let own = kept.binary_search(&stored_of(index)).unwrap_or(0);
        if index < stored { own } else { own + pairs }
    };
    let all_moved = |points: &[usize]| points.iter().map(|&index| moved(index)).collect::<Vec<_>>();
    for Opening { opening, .. } in &mut openings {
        opening.upper = all_moved(&opening.upper);
        opening.lower = all_moved(&opening.lower);
        opening.members = all_moved(&opening.members);
    }
    let shape = |shape: &Shape| {
        let turn = |turn: &Turn| Turn {
            members: turn.members.iter().filter(|member| is_kept(member.0)).map(|&(index, part)| (moved(index), part)).collect(),
            ..turn.clone()
        };
        let turns = shape.turns.iter().map(turn).filter(|turn| shape.kind == ShapeKind::Head || !turn.members.is_empty());
        let deltas = shape.deltas.iter().filter(|entry| is_kept(entry.0)).map(|&(index, way)| (moved(index), way));
        // The deltas that stay are stored in the same steps.
        Shape { deltas: deltas.collect(), turns: turns.collect(), reach: shape.longest(), ..shape.clone() }
    };
    Blueprint {
        middles,
        pairs,
        points: kept.iter().map(|&index| face.points[index]).collect(),
        normals: kept.iter().map(|&index| face.normals[index]).collect(),
        triangles: face.triangles.iter().map(|corners| corners.map(moved)).collect(),
        fixed: face.fixed.iter().filter(|&&index| is_kept(index)).map(|&index| moved(index)).collect(),
        curves: face.curves.iter().map(|curve| Curve { points: all_moved(&curve.points), ..curve.clone() }).collect(),
        openings,
        shapes: face.shapes.iter().map(shape).collect(),
        ..face.clone()
    }
}

/// The highest, the lowest and the widest point: the camera makes room for these.
fn extremes(face: &Blueprint) -> impl Iterator<Item = usize> {
    let by =
        |key: fn(&[f64; 3]) -> f64| (0..face.points.len()).max_by(|&a, &b| key(&face.points[a]).total_cmp(&key(&face.points[b])));
    [by(|point| point[1]), by(|point| -point[1]), by(|point| point[0].abs())].into_iter().flatten()
}
