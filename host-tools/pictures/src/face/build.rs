//! Builds Pantin's own face from the head and its units.

use super::blueprint::{Blueprint, Curve, Opening};
use super::head::Head;
use super::{action_units, extra, faps, names};
use anyhow::Result;

/// A step is 2^-7 mm: coordinates of the head fit 16 bits.
pub const FRACTION_BITS: i8 = 7;

/// Returns the head without units.
pub fn neutral(head: &Head) -> Blueprint {
    let stored = head.middles + head.pairs;
    let curve = |curve: &super::head::Curve| Curve {
        detail: curve.detail,
        shade: curve.shade,
        paired: curve.paired,
        closed: curve.closed,
        straight: false,
        small: curve.small,
        filled: false,
        points: curve.points.clone(),
    };
    let opening = |opening: &super::head::Opening| Opening { opening: opening.clone(), release: None };
    // Below the jaw and in the eye sockets the surface turns away in many places at once. There the curves of jaw and lids are the
    // outline.
    let hollow =
        ["submental", "submental-side", "throat", "neck-front-side", "bag", "bag-out", "crease", "crease-out", "crease-end"];
    let hollow: Vec<usize> = hollow.iter().filter_map(|name| head.find(name).ok()).collect();
    let within = |corner: &usize| hollow.contains(corner) || head.openings.iter().any(|eye| eye.paired && eye.edges(*corner));
    let (inner, outer): (Vec<_>, Vec<_>) = head.triangles.iter().partition(|triangle| triangle.iter().any(within));
    let outline = outer.len();
    Blueprint {
        middles: head.middles,
        pairs: head.pairs,
        fraction_bits: FRACTION_BITS,
        points: head.points[..stored].to_vec(),
        normals: head.normals[..stored].to_vec(),
        outline,
        triangles: outer.into_iter().chain(inner).collect(),
        fixed: head.fixed.clone(),
        curves: head.curves.iter().map(curve).collect(),
        openings: head.openings.iter().map(opening).collect(),
        ..Blueprint::default()
    }
}

/// Distance in mm by which a tongue that sticks out passes the edge of the lower lip.
const TONGUE_DROP: f64 = 40.0;

/// Returns Pantin's own face.
pub fn face(head: &Head) -> Result<Blueprint> {
    let mut shapes = action_units::units(head);
    shapes.extend(extra::units(head));
    // Rotations apply after all deltas.
    shapes.sort_by_key(|shape| !shape.turns.is_empty());
    let names = names::drives(&shapes)?;
    let mut face = Blueprint { shapes, names, ..neutral(head) };
    let parameters = faps::drives(head, &face)?;
    face.names.extend(parameters);
    let tongue = face.shape("tongue_out").map(|shape| (shape, TONGUE_DROP));
    face.openings.iter_mut().filter(|entry| !entry.opening.paired).for_each(|entry| entry.release = tongue);
    Ok(face)
}
