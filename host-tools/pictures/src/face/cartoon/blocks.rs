//! Shapes with corners of their own, and the units of the face that move them.

use super::points::Kept;
use super::table::{Block, Table};
use crate::face::blueprint::{Blueprint, Curve, Shape};
use anyhow::{Result, ensure};
use pantin_face::shape::Interpolation;
use std::collections::BTreeSet;

/// Whether a corner has no mirror image.
pub(super) fn is_middle(block: &Block, place: [f64; 2]) -> bool {
    !block.paired && place[0] == 0.0
}

/// The areas of the blocks, whose corners on the left and in the middle are these points.
pub(super) fn curves(table: &Table, kept: &Kept, corners: &[Vec<usize>]) -> Vec<Curve> {
    let curve = |(block, own): (&Block, &Vec<usize>)| {
        let mut points = own.clone();
        if !block.paired {
            points.extend(own.iter().rev().filter(|&&index| index >= kept.middles).map(|index| index + kept.pairs));
        }
        let Block { shade, paired, straight, .. } = *block;
        Curve { detail: 0, shade, paired, closed: true, straight, small: false, filled: true, points }
    };
    table.blocks.iter().zip(corners).map(curve).collect()
}

/// The points of the head on which the picture depends: those that are drawn, and the edges of openings that have some of these.
fn used(table: &Table, face: &Blueprint) -> BTreeSet<usize> {
    let stored = |&index: &usize| if index < face.middles + face.pairs { index } else { index - face.pairs };
    let drawn: BTreeSet<usize> = table.curves.iter().flat_map(|curve| &curve.points).map(stored).collect();
    let openings = face.openings.iter().map(|entry| &entry.opening);
    let shown = openings.filter(|opening| opening.members.iter().map(stored).any(|index| drawn.contains(&index)));
    let edges: Vec<usize> = shown.flat_map(|opening| opening.upper.iter().chain(&opening.lower)).map(stored).collect();
    drawn.into_iter().chain(edges).collect()
}

/// Adds the ways of the corners to the units of the face. Fails for a unit that rotates points of the head which are drawn.
pub(super) fn add(table: &Table, face: &Blueprint, kept: &Kept, corners: &[Vec<usize>], shapes: &mut [Shape]) -> Result<()> {
    let used = used(table, face);
    for entry in &table.moves {
        let (own, shape) = (&face.shapes[entry.unit], &mut shapes[entry.unit]);
        if shape.interpolation == Interpolation::Spherical {
            let mut members = own.turns.iter().flat_map(|turn| &turn.members);
            ensure!(
                members.all(|member| !used.contains(&member.0)),
                "{} rotates points that are drawn, and cannot move a block too",
                own.name
            );
            shape.turns.clear();
            shape.interpolation = Interpolation::Linear;
        }
        // Units that move the whole mouth one way store both sides.
        let whole = own.deltas.iter().any(|delta| delta.0 >= face.middles + face.pairs);
        for (&corner, &[aside, up]) in corners[entry.block].iter().zip(&entry.ways) {
            let half = if corner < kept.middles && !whole { 0.5 } else { 1.0 };
            shape.deltas.push((corner, [aside * half, up * half, 0.0]));
            if whole && corner >= kept.middles {
                shape.deltas.push((corner + kept.pairs, [aside, up, 0.0]));
            }
        }
        shape.deltas.retain(|delta| delta.1 != [0.0; 3]);
    }
    Ok(())
}
