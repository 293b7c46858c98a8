//! The points of a cartoon face: those of the head that it uses, with new numbers, those that set the camera, and corners of hidden shapes.

use super::FRONT;
use super::table::Table;
use super::zoom::Enlarged;
use crate::face::blueprint::Blueprint;
use crate::face::head::{Head, Vector};

/// Points in the middle that set the top and the bottom of the picture; one on the left sets its width.
const CAMERA_MIDDLES: usize = 2;
const CAMERA_PAIRS: usize = 1;

/// The points of the head that stay.
pub(super) struct Kept<'h> {
    head: &'h Head,
    /// Their indices in the head: first those in the middle, then those on the left.
    indices: Vec<usize>,
    /// Points of the new face in the middle.
    pub middles: usize,
    /// Points of the new face on the left.
    pub pairs: usize,
}

impl<'h> Kept<'h> {
    /// Keeps the points of the table's curves and of the face's openings.
    pub fn of(head: &'h Head, face: &Blueprint, table: &Table) -> Kept<'h> {
        let drawn = table.curves.iter().flat_map(|curve| &curve.points);
        let openings = face.openings.iter().map(|entry| &entry.opening);
        let behind = openings.flat_map(|opening| [&opening.upper, &opening.lower, &opening.members]).flatten();
        let mut indices: Vec<usize> = drawn.chain(behind).map(|&point| head.stored(point)).collect();
        indices.sort_unstable();
        indices.dedup();
        let own_middles = indices.partition_point(|&index| index < head.middles);
        let own_pairs = indices.len() - own_middles;
        let corners: usize = table.hidden.iter().map(|shape| shape.corners).sum();
        let (middles, pairs) = (own_middles + CAMERA_MIDDLES, own_pairs + CAMERA_PAIRS + corners);
        Kept { head, indices, middles, pairs }
    }

    /// Whether a point or its mirror image stays.
    pub fn has(&self, index: usize) -> bool {
        self.indices.contains(&self.head.stored(index))
    }

    /// The new index of a point of the head.
    pub fn renumbered(&self, index: usize) -> usize {
        let stored = self.head.stored(index);
        let own = self.indices.iter().position(|&kept| kept == stored).unwrap_or(0);
        let own = if stored < self.head.middles { own } else { own + CAMERA_MIDDLES };
        if index == stored { own } else { own + self.pairs }
    }

    /// The new indices of points of the head.
    pub fn all_renumbered(&self, points: &[usize]) -> Vec<usize> {
        points.iter().map(|&index| self.renumbered(index)).collect()
    }

    /// The places of all points, in mm, and for each hidden shape the index of its first corner.
    pub fn places(&self, enlarged: &Enlarged, table: &Table) -> (Vec<Vector>, Vec<usize>) {
        let [width, top, bottom] = table.view;
        let (middle, left) = self.indices.split_at(self.middles - CAMERA_MIDDLES);
        let mut points: Vec<Vector> = middle.iter().map(|&index| enlarged.place(index)).collect();
        points.extend([[0.0, top, FRONT], [0.0, bottom, FRONT]]);
        points.extend(left.iter().map(|&index| enlarged.place(index)));
        points.push([width, 0.0, FRONT]);
        let mut corners = Vec::new();
        for shape in &table.hidden {
            corners.push(points.len());
            points.extend(std::iter::repeat_n([shape.place[0], shape.place[1], FRONT], shape.corners));
        }
        (points, corners)
    }
}
