//! Hidden shapes, and the units that open them.

use super::table::{Hidden, Prop, Table};
use crate::face::action_units::shape;
use crate::face::blueprint::{Curve, Drive, Shape};
use pantin_face::shape::Interpolation;

/// The model keeps 127ths of it: half a millimetre, so that places in whole ones are exact.
const REACH: f64 = 63.5;

/// The areas of the hidden shapes, whose first corners are these points.
pub(super) fn curves(hidden: &[Hidden], corners: &[usize]) -> impl Iterator<Item = Curve> {
    hidden.iter().zip(corners).map(|(shape, &first)| Curve {
        detail: 0,
        shade: shape.shade,
        paired: true,
        closed: true,
        straight: true,
        small: false,
        filled: true,
        points: (first..first + shape.corners).collect(),
    })
}

/// Adds the props as shapes, each with a channel of its name, or to a unit of the face that has this name. Props of one name become one shape. `corners` holds
/// the first corner of each hidden shape.
pub(super) fn add(table: &Table, corners: &[usize], shapes: &mut Vec<Shape>, names: &mut Vec<Drive>) {
    for Prop { name, hidden, places } in &table.props {
        let (from, first) = (table.hidden[*hidden].place, corners[*hidden]);
        let own = shapes.iter().position(|shape| shape.name == *name).unwrap_or_else(|| {
            names.push(Drive { name: name.clone(), shape: shapes.len(), sides: [true; 2], gain: 1.0 });
            shapes.push(Shape { reach: REACH, ..shape(name, Interpolation::Linear, false) });
            shapes.len() - 1
        });
        let deltas = places.iter().enumerate().map(|(corner, to)| (first + corner, [to[0] - from[0], to[1] - from[1], 0.0]));
        shapes[own].deltas.extend(deltas);
    }
}
