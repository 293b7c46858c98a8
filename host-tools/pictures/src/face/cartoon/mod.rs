//! Faces of filled shapes from a small text: parts of Pantin's head, enlarged and moved, with the same units; blocks that these units move; and props such
//! as glasses, which have units of their own.

mod blocks;
mod points;
mod props;
mod table;
mod units;
mod zoom;

use super::blueprint::{Blueprint, Curve};
use super::head::Head;
use super::small;
use anyhow::Result;
use points::Kept;
use table::Table;
use zoom::Enlarged;

/// Pantin's own cartoon face.
pub const TABLE: &str = include_str!("../cartoon.txt");

/// Two eyes alone.
pub const EYES: &str = include_str!("../eyes.txt");

/// A face of few strokes.
pub const MINIMAL: &str = include_str!("../minimal.txt");

/// The text of one of Pantin's own faces by its name.
pub fn named(name: &str) -> Option<&'static str> {
    [("cartoon", TABLE), ("eyes", EYES), ("minimal", MINIMAL)].into_iter().find(|own| own.0 == name).map(|own| own.1)
}

/// How far before the head the points are that belong to no part of it, in mm.
const FRONT: f64 = 70.0;

/// Builds a face from a table, given the head and its face. Fails with the line that cannot be read.
pub fn build(head: &Head, face: &Blueprint, table: &str) -> Result<Blueprint> {
    Ok(small::reduced(&whole(head, face, table)?))
}

/// Builds a face with all that is in the eyes and the mouth, whether it is drawn or not. Otherwise like [`build`].
pub fn whole(head: &Head, face: &Blueprint, table: &str) -> Result<Blueprint> {
    let table = Table::read(table, head, face)?;
    let kept = Kept::of(head, face, &table);
    let enlarged = Enlarged { head, zooms: &table.zooms };
    let places = kept.places(&enlarged, &table);
    let renumbered = table.curves.iter().map(|curve| Curve { points: kept.all_renumbered(&curve.points), ..curve.clone() });
    let own = blocks::curves(&table, &kept, &places.blocks);
    let curves = renumbered.chain(own).chain(props::curves(&table.hidden, &places.hidden)).collect();
    let mut shapes = units::shapes(face, &kept, &enlarged, &table);
    blocks::add(&table, face, &kept, &places.blocks, &mut shapes)?;
    let mut names = face.names.clone();
    props::add(&table, &places.hidden, &mut shapes, &mut names);
    Ok(Blueprint {
        middles: kept.middles,
        pairs: kept.pairs,
        fraction_bits: face.fraction_bits,
        normals: vec![[0.0, 0.0, 1.0]; kept.middles + kept.pairs],
        points: places.points,
        curves,
        openings: face.openings.iter().map(|opening| units::opening(opening, &kept)).collect(),
        shapes,
        names,
        ..Blueprint::default()
    })
}
