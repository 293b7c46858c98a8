//! The face's own units and openings, on the points that stay.

use super::points::Kept;
use super::table::Table;
use super::zoom::{Enlarged, is_eyeball};
use crate::face::blueprint::{Blueprint, Opening, Shape, Turn};
use crate::face::head::{self, Vector, plus};
use pantin_face::shape::ShapeKind;

/// The shapes of the face, enlarged with the parts that they move and by the table's gains; the jaw turns by a part of its angle.
pub(super) fn shapes(face: &Blueprint, kept: &Kept, enlarged: &Enlarged, table: &Table) -> Vec<Shape> {
    let shape = |(unit, shape): (usize, &Shape)| {
        let gain = table.gains.iter().find(|gain| gain.0 == unit).map_or(1.0, |gain| gain.1);
        let deltas = shape.deltas.iter().filter(|entry| kept.has(entry.0));
        let moved = |&(index, way): &(usize, Vector)| {
            (kept.renumbered(index), way.map(|x| x * gain * enlarged.factor_and_offset(index).0))
        };
        let deltas = deltas.map(moved).collect();
        let turns = shape.turns.iter().map(|turn| rotation(turn, kept, enlarged, table.jaw));
        let turns = turns.filter(|turn| !turn.members.is_empty() || shape.kind == ShapeKind::Head).collect();
        Shape { deltas, turns, ..shape.clone() }
    };
    face.shapes.iter().enumerate().map(shape).collect()
}

fn rotation(turn: &Turn, kept: &Kept, enlarged: &Enlarged, jaw: f64) -> Turn {
    let mut turn = turn.clone();
    // A rotation about the middle of an enlarged part stays one.
    let (factor, offset) = turn.members.first().map_or((1.0, [0.0; 3]), |member| enlarged.factor_and_offset(member.0));
    if is_eyeball(turn.centre) {
        turn.centre = plus(turn.centre.map(|x| x * factor), offset, 1.0);
    } else if !turn.members.is_empty() {
        // The jaw keeps its axis as seen from the mouth.
        turn.centre = plus(turn.centre.map(|x| x * factor), enlarged.mouth_offset(), 1.0);
        turn.degrees *= jaw;
    }
    turn.members.retain(|member| kept.has(member.0));
    turn.members.iter_mut().for_each(|member| member.0 = kept.renumbered(member.0));
    turn
}

/// An opening of the face with the new numbers of its points.
pub(super) fn opening(entry: &Opening, kept: &Kept) -> Opening {
    let own = &entry.opening;
    let [upper, lower, members] = [&own.upper, &own.lower, &own.members].map(|points| kept.all_renumbered(points));
    Opening { opening: head::Opening { upper, lower, members, ..own.clone() }, release: entry.release }
}
